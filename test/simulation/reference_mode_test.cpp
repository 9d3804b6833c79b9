// The fourth-order integrator: energy, order of convergence, and its agreement with the default.

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "test/robot/own_arms.h"
#include "test/simulation/energy.h"
#include "test/simulation/simple_arms.h"

namespace demo_logger {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr int kSubsteps = 4;

RobotDescription undampedArm() {
  RobotDescription arm = describeOwnArm("demo_arm");
  for (ArmJoint& joint : arm.joints) {
    joint.damping = joint.friction = 0.0;
    joint.lower = -1e9;
    joint.upper = 1e9;
  }
  return arm;
}

struct Fall {
  double drift = 0.0;    // [J] largest |E − E₀|
  double fastest = 0.0;  // [rad/s] of any joint
};

/// 5 s at 1 kHz, from rest with the arm stretched out and leaning by `shoulder` [rad].
Fall fall(const RobotDescription& description, Integrator integrator, double shoulder = M_PI / 2.0) {
  BulletArm arm(description, {}, integrator);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
  q[1] = shoulder;
  arm.reset({q, Eigen::VectorXd::Zero(7)});
  const Energy energy(description);
  const double start = energy(arm.state());
  Fall fall;
  for (int tick = 0; tick < 5000; ++tick) {
    arm.step(Eigen::VectorXd::Zero(7), kPeriod, kSubsteps);
    fall.drift = std::max(fall.drift, std::abs(energy(arm.state()) - start));
    fall.fastest = std::max(fall.fastest, arm.state().dq.cwiseAbs().maxCoeff());
  }
  return fall;
}

TEST(ReferenceModeTest, AnUndampedFallKeepsItsEnergy) {
  for (const double shoulder : {0.3, 1.0, M_PI / 2.0, 2.0}) {
    const Fall fallen = fall(undampedArm(), Integrator::runge_kutta_4, shoulder);
    EXPECT_LE(fallen.drift, 1e-4) << "[J], from " << shoulder << " rad";
    EXPECT_GT(fallen.fastest, 5.0) << "[rad/s], it does fall";
  }
}

TEST(ReferenceModeTest, AlsoWithTheInertiaOfMotors) {
  RobotDescription arm = undampedArm();
  for (ArmJoint& joint : arm.joints) joint.motor_inertia = 0.02;
  EXPECT_LE(fall(arm, Integrator::runge_kutta_4).drift, 1e-4);
}

TEST(ReferenceModeTest, TheDefaultDriftsByFarMore) {
  EXPECT_GT(fall(undampedArm(), Integrator::semi_implicit_euler).drift, 0.1) << "or this could not tell them apart";
}

ArmState afterSwing(const RobotDescription& description, Integrator integrator, int substeps) {
  BulletArm arm(description, {}, integrator);
  const RobotModel model(description);
  arm.reset({Eigen::VectorXd::Constant(7, 0.3), Eigen::VectorXd::Zero(7)});
  const Eigen::VectorXd torque = model.gravity(arm.state().q);
  for (int tick = 0; tick < 25; ++tick) {
    Eigen::VectorXd push = torque;
    push[tick % 7] += 5.0;
    arm.step(push, 0.02, substeps);
  }
  return arm.state();
}

TEST(ReferenceModeTest, HalvingTheStepDividesTheErrorBySixteen) {
  RobotDescription arm = undampedArm();
  for (ArmJoint& joint : arm.joints) joint.damping = 0.3;
  const ArmState exact = afterSwing(arm, Integrator::runge_kutta_4, 64);
  const double coarse = (afterSwing(arm, Integrator::runge_kutta_4, 2).q - exact.q).norm();
  const double fine = (afterSwing(arm, Integrator::runge_kutta_4, 4).q - exact.q).norm();
  EXPECT_GT(coarse / fine, 10.0) << coarse << " and " << fine;
  const double euler = (afterSwing(arm, Integrator::semi_implicit_euler, 800).q - exact.q).norm();
  const double halved = (afterSwing(arm, Integrator::semi_implicit_euler, 1600).q - exact.q).norm();
  EXPECT_NEAR(euler / halved, 2.0, 0.2) << "the default tends to the same, with first order";
}

TEST(ReferenceModeTest, AMotorsInertiaIsFeltByItsJoint) {
  for (const Integrator integrator : {Integrator::semi_implicit_euler, Integrator::runge_kutta_4}) {
    RobotDescription pendulum = makePendulum();  // 1 kg m²
    pendulum.joints[0].motor_inertia = 3.0;
    BulletArm arm(pendulum, {}, integrator);
    for (int tick = 0; tick < 1000; ++tick) arm.step(vector1(2.0), kPeriod, 4);
    EXPECT_NEAR(arm.state().dq[0], 2.0 / 4.0, 1e-9) << "2 N m for 1 s on 1 + 3 kg m²";
    EXPECT_NEAR(arm.acceleration(vector1(2.0))[0], 0.5, 1e-12);
    EXPECT_NEAR(arm.linkTorque()[0], 2.0 - 3.0 * 0.5, 1e-9) << "what of the torque reaches the link";
  }
}

TEST(ReferenceModeTest, FrictionBrakesInEitherMode) {
  for (const Integrator integrator : {Integrator::semi_implicit_euler, Integrator::runge_kutta_4}) {
    RobotDescription pendulum = makePendulum();
    pendulum.joints[0].friction = 0.5;
    BulletArm arm(pendulum, {}, integrator);
    arm.reset({vector1(0.0), vector1(1.0)});
    for (int tick = 0; tick < 1000; ++tick) arm.step(vector1(0.0), kPeriod, 4);
    EXPECT_NEAR(arm.state().dq[0], 0.5, 1e-9);
    EXPECT_NEAR(arm.frictionTorque()[0], -0.5, 1e-9);
    EXPECT_NEAR(arm.linkTorque()[0], -0.5, 1e-9);
  }
}

}  // namespace
}  // namespace demo_logger
