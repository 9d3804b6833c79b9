// Viscous damping and Coulomb friction of the simulated joints, against their closed forms on one joint of 1 kg m².

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "test/robot/own_arms.h"
#include "test/simulation/simple_arms.h"

namespace demo_logger {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr int kSubsteps = 4;
constexpr double kStep = kPeriod / kSubsteps;

TEST(JointFrictionTest, DampingDividesTheSpeedInEveryStep) {
  for (const double damping : {0.5, 20.0, 1e5}) {
    RobotDescription description = makePendulum();
    description.joints[0].damping = damping;
    BulletArm arm(description);
    arm.reset({vector1(0.0), vector1(2.0)});
    double expected = 2.0;
    for (int tick = 0; tick < 100; ++tick) {
      arm.step(vector1(0.0), kPeriod, kSubsteps);
      expected /= std::pow(1.0 + kStep * damping, kSubsteps);
      EXPECT_NEAR(arm.state().dq[0], expected, 1e-12) << damping << " N m s/rad: the end of the step decides";
    }
    // (1 + h d)^(-t/h) tends to exp(-d t) with a relative error of d² h t / 2.
    if (damping == 0.5) {
      EXPECT_NEAR(arm.state().dq[0], 2.0 * std::exp(-0.5 * 0.1), 2.0 * 0.25 * kStep * 0.1);
    }
  }
}

TEST(JointFrictionTest, StiffDampersOnAWholeArmOnlyEverBrake) {
  RobotDescription description = describeOwnArm("demo_arm");
  description.gravity.setZero();
  for (ArmJoint& joint : description.joints) {
    joint.damping = 200.0;  // explicit steps of 0.25 ms bear 13 on joint 7
    joint.friction = 0.0;
    joint.lower = -100.0;
    joint.upper = 100.0;
  }
  const RobotModel model(description);
  BulletArm arm(description);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(7, 0.4), dq = Eigen::VectorXd::Constant(7, 1.0);
  arm.reset({q, dq});
  double energy = 0.5 * dq.dot(model.massMatrix(q) * dq);
  for (int tick = 0; tick < 1000; ++tick) {
    arm.step(Eigen::VectorXd::Zero(7), kPeriod, kSubsteps);
    const ArmState& state = arm.state();
    const double after = 0.5 * state.dq.dot(model.massMatrix(state.q) * state.dq);
    ASSERT_LE(after, energy) << "tick " << tick;
    energy = after;
  }
  EXPECT_LT(energy, 1e-12);
}

TEST(JointFrictionTest, CoulombFrictionStopsAMovingJointAfterItsWayAndKeepsItThere) {
  RobotDescription description = makePendulum();
  description.joints[0].friction = 0.5;
  BulletArm arm(description);
  arm.reset({vector1(0.0), vector1(1.0)});
  // dq/dt = −0.5 rad/s²: at rest after 2 s and 1 rad; the steps may miss that by the way of one.
  for (int tick = 0; tick < 1500; ++tick) arm.step(vector1(0.0), kPeriod, kSubsteps);
  EXPECT_NEAR(arm.state().dq[0], 1.0 - 0.5 * 1.5, 1e-9);
  EXPECT_NEAR(arm.frictionTorque()[0], -0.5, 1e-9);
  for (int tick = 0; tick < 1500; ++tick) arm.step(vector1(0.0), kPeriod, kSubsteps);
  EXPECT_NEAR(arm.state().q[0], 1.0, 1.0 * kStep);
  EXPECT_NEAR(arm.state().dq[0], 0.0, 1e-12);
  EXPECT_NEAR(arm.frictionTorque()[0], 0.0, 1e-9) << "nothing pushes, nothing holds";
}

TEST(JointFrictionTest, StictionHoldsWhatIsWeakerAndYieldsToWhatIsStronger) {
  RobotDescription description = makePendulum();
  description.joints[0].friction = 0.5;
  BulletArm arm(description);
  for (int tick = 0; tick < 2000; ++tick) arm.step(vector1(0.49), kPeriod, kSubsteps);
  EXPECT_NEAR(arm.state().q[0], 0.0, 1e-9);
  EXPECT_NEAR(arm.frictionTorque()[0], -0.49, 1e-9) << "as much as is needed";

  for (int tick = 0; tick < 1000; ++tick) arm.step(vector1(0.7), kPeriod, kSubsteps);
  EXPECT_NEAR(arm.state().dq[0], 0.2, 1e-9) << "0.7 − 0.5 N m for 1 s";
  EXPECT_NEAR(arm.frictionTorque()[0], -0.5, 1e-9);
}

TEST(JointFrictionTest, StictionHoldsAWholeArmAgainstHalfItsFriction) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel model(description);
  BulletArm arm(description);
  Eigen::VectorXd home(7), push(7);
  home << 0.0, 0.5, 0.0, 1.5, 0.0, 1.1416, 0.0;
  for (int i = 0; i < 7; ++i)
    push[i] = (i % 2 == 0 ? 0.5 : -0.5) * description.joints[static_cast<std::size_t>(i)].friction;
  arm.reset({home, Eigen::VectorXd::Zero(7)});
  const Eigen::VectorXd torque = model.gravity(home) + push;
  for (int tick = 0; tick < 2000; ++tick) arm.step(torque, kPeriod, kSubsteps);
  EXPECT_LT((arm.state().q - home).cwiseAbs().maxCoeff(), 1e-12) << "no creep in 2 s";
  EXPECT_LT((arm.frictionTorque() + push).cwiseAbs().maxCoeff(), 1e-9) << "as much as is needed, at each joint";
}

/// M q̈ + C q̇ + g = τ + friction, so friction and damping can be told from the motion.
TEST(JointFrictionTest, TheFrictionTorqueIsWhatTheMotionMisses) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel model(description);
  BulletArm arm(description);
  Eigen::VectorXd q = Eigen::VectorXd::Constant(7, 0.3), dq = Eigen::VectorXd::Constant(7, 0.5);
  arm.reset({q, dq});
  const Eigen::VectorXd torque = model.gravity(q);
  const Eigen::VectorXd bias = model.inverseDynamics(q, dq, Eigen::VectorXd::Zero(7));
  arm.step(torque, kStep, 1);
  const Eigen::VectorXd ddq = (arm.state().dq - dq) / kStep;
  const Eigen::VectorXd missing = model.massMatrix(q) * ddq + bias - torque;
  EXPECT_LT((arm.frictionTorque() - missing).cwiseAbs().maxCoeff(), 1e-9);
  for (int i = 0; i < 7; ++i) {
    const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
    EXPECT_NEAR(arm.frictionTorque()[i], -joint.friction - joint.damping * 0.5, 0.02) << joint.name;
  }
}

}  // namespace
}  // namespace demo_logger
