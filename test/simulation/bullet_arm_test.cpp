#include "demo_logger/simulation/bullet_arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"
#include "test/simulation/simple_arms.h"

namespace demo_logger {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr int kSubsteps = 4;

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

/// Gravity compensation, and sines that swing every joint far enough to reverse against friction and to meet limits.
Eigen::VectorXd swingingTorque(const RobotModel& model, const Eigen::VectorXd& q, int tick) {
  Eigen::VectorXd torque = model.gravity(q);
  for (int i = 0; i < model.size(); ++i) {
    const double strength = 0.05 * model.description().joints[static_cast<std::size_t>(i)].effort_limit;
    torque[i] += strength * std::sin(0.004 * tick * (i + 1));
  }
  return torque;
}

std::vector<double> swing(BulletArm& arm, const RobotModel& model, int ticks) {
  std::vector<double> trajectory;
  for (int tick = 0; tick < ticks; ++tick) {
    arm.step(swingingTorque(model, arm.state().q, tick), kPeriod, kSubsteps);
    trajectory.insert(trajectory.end(), arm.state().q.begin(), arm.state().q.end());
    trajectory.insert(trajectory.end(), arm.state().dq.begin(), arm.state().dq.end());
    trajectory.insert(trajectory.end(), arm.frictionTorque().begin(), arm.frictionTorque().end());
  }
  return trajectory;
}

TEST(BulletArmTest, TheSameCallsGiveTheSameBits) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel model(description);
  BulletArm first(description), second(description);
  const std::vector<double> trajectory = swing(first, model, 3000);
  EXPECT_EQ(swing(second, model, 3000), trajectory);

  const double reach = *std::max_element(trajectory.begin(), trajectory.end());
  EXPECT_GT(reach, 1.0) << "the arm did move";
}

TEST(BulletArmTest, AResetArmGoesOnLikeANewOne) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel model(description);
  const ArmState start{Eigen::VectorXd::Constant(7, 0.3), Eigen::VectorXd::Constant(7, 0.1)};
  BulletArm fresh(description), used(description);
  swing(used, model, 500);
  fresh.reset(start);
  used.reset(start);
  EXPECT_EQ(used.state().q, start.q);
  EXPECT_EQ(used.state().dq, start.dq);
  EXPECT_TRUE(used.frictionTorque().isZero(0.0));
  EXPECT_EQ(swing(used, model, 500), swing(fresh, model, 500));
}

TEST(BulletArmTest, LookingChangesNothing) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel model(description);
  BulletArm watched(description), alone(description);
  for (int tick = 0; tick < 200; ++tick) {
    const Eigen::VectorXd torque = swingingTorque(model, alone.state().q, tick);
    watched.acceleration(torque);
    watched.tipPose();
    watched.step(torque, kPeriod, kSubsteps);
    alone.step(torque, kPeriod, kSubsteps);
    ASSERT_EQ(watched.state().q, alone.state().q);
    ASSERT_EQ(watched.state().dq, alone.state().dq);
  }
}

TEST(BulletArmTest, TheTipPoseIsThatOfTheStateAlsoRightAfterAStep) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel model(description);
  BulletArm arm(description);
  arm.reset({Eigen::VectorXd::Constant(7, 0.3), Eigen::VectorXd::Constant(7, 1.0)});
  arm.step(model.gravity(arm.state().q), 1e-2, 1);
  // Bullet's own poses are those of one step before: at 1 rad/s and 10 ms, centimetres away.
  EXPECT_TRUE(arm.tipPose().isApprox(model.forwardKinematics(arm.state().q), 1e-12));
}

TEST(BulletArmTest, StartsAtRestAtZeroOrTheNearestLimit) {
  RobotDescription description = makePendulum();
  EXPECT_EQ(BulletArm(description).state().q, vector1(0.0));
  description.joints[0].lower = 0.4;
  description.joints[0].upper = 2.0;
  EXPECT_EQ(BulletArm(description).state().q, vector1(0.4));
  EXPECT_EQ(BulletArm(description).state().dq, vector1(0.0));
}

TEST(BulletArmTest, AFreeJointKeepsItsSpeedHoweverSlowOrFast) {
  BulletArm arm(makePendulum());
  for (const double speed : {1e-4, 1.0, 500.0}) {
    arm.reset({vector1(0.0), vector1(speed)});
    for (int tick = 0; tick < 5000; ++tick) arm.step(vector1(0.0), kPeriod, kSubsteps);
    EXPECT_NEAR(arm.state().dq[0], speed, 1e-9 * speed) << "neither put to sleep, nor damped, nor clamped";
    EXPECT_NEAR(arm.state().q[0], 5.0 * speed, 1e-9 * speed) << "5000 steps of 1 ms";
  }
}

TEST(BulletArmTest, TheTorqueIsHeldOverTheWholePeriodAndNoLonger) {
  BulletArm arm(makePendulum());  // 1 kg m²
  arm.step(vector1(2.0), 0.5, 100);
  EXPECT_NEAR(arm.state().dq[0], 1.0, 1e-12) << "2 N m for 0.5 s";
  arm.step(vector1(0.0), 0.5, 100);
  EXPECT_NEAR(arm.state().dq[0], 1.0, 1e-12);
}

TEST(BulletArmTest, JointLimitsStopTheArmDead) {
  for (const double torque : {5.0, -5.0, 300.0}) {
    RobotDescription description = makePendulum();
    description.joints[0].lower = -0.5;
    description.joints[0].upper = 1.0;
    BulletArm arm(description);
    const double stop = torque > 0.0 ? 1.0 : -0.5;
    for (int tick = 0; tick < 3000; ++tick) {
      arm.step(vector1(torque), kPeriod, kSubsteps);
      ASSERT_GE(arm.state().q[0], -0.5 - 1e-9);
      ASSERT_LE(arm.state().q[0], 1.0 + 1e-9);
    }
    EXPECT_NEAR(arm.state().q[0], stop, 1e-9) << torque << " N m";
    EXPECT_NEAR(arm.state().dq[0], 0.0, 1e-9);
    arm.step(vector1(-torque), kPeriod, kSubsteps);
    EXPECT_NEAR(arm.state().dq[0], -torque * kPeriod, 1e-9) << "a stop does not stick";
  }
}

TEST(BulletArmTest, AFastJointNeitherPassesItsStopNorBouncesOff) {
  constexpr double kSoftness = 1e-6;  // of the stop under a blow of 90 N m s
  RobotDescription description = makePendulum();
  description.joints[0].upper = 1.0;
  BulletArm arm(description);
  arm.reset({vector1(0.0), vector1(90.0)});
  for (int tick = 0; tick < 100; ++tick) {
    arm.step(vector1(0.0), kPeriod, kSubsteps);
    ASSERT_LT(arm.state().q[0], 1.0 + kSoftness);
  }
  EXPECT_NEAR(arm.state().q[0], 1.0, kSoftness);
  EXPECT_NEAR(arm.state().dq[0], 0.0, kSoftness);
}

TEST(BulletArmTest, AJointALittleOutsideComesBackGently) {
  RobotDescription description = makePendulum();
  description.joints[0].upper = 1.0;
  BulletArm arm(description);
  arm.reset({vector1(1.02), vector1(0.0)});
  for (int tick = 0; tick < 1000; ++tick) {
    arm.step(vector1(1.0), kPeriod, kSubsteps);
    ASSERT_LE(std::abs(arm.state().dq[0]), 0.1 + 1e-9);
  }
  EXPECT_NEAR(arm.state().q[0], 1.0, 1e-9) << "0.02 rad at 0.1 rad/s, then pushed against the stop by 1 N m";
}

TEST(BulletArmTest, ALimpArmFallsIntoItsLimitsAndStaysThere) {
  const RobotDescription description = describeOwnArm("demo_arm");
  BulletArm arm(description);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(7);
  q[1] = 0.3;
  arm.reset({q, Eigen::VectorXd::Zero(7)});
  for (int tick = 0; tick < 10000; ++tick) {
    arm.step(Eigen::VectorXd::Zero(7), kPeriod, kSubsteps);
    for (int i = 0; i < 7; ++i) {
      const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
      ASSERT_GT(arm.state().q[i], joint.lower - 1e-9) << joint.name;
      ASSERT_LT(arm.state().q[i], joint.upper + 1e-9) << joint.name;
    }
  }
  EXPECT_NEAR(arm.state().q[1], description.joints[1].upper, 1e-9) << "the shoulder hangs in its limit";
  EXPECT_LT(arm.state().dq.norm(), 1e-9) << "at rest, though friction and the stop both hold the shoulder";
}

TEST(BulletArmTest, RefusesAnArmWithoutInertia) {
  RobotDescription description = makePendulum();
  description.has_inertia = false;
  description.inertia_fault = "link 'rod' has none";
  EXPECT_EQ(errorOf([&] { BulletArm arm(description); }), "robot 'pendulum' cannot be simulated: link 'rod' has none");
}

TEST(BulletArmTest, RefusesAJointThatMovesNothing) {
  RobotDescription on_axis = makePendulum();
  on_axis.joints[0].body.center.setZero();
  EXPECT_EQ(errorOf([&] { BulletArm arm(on_axis); }),
            "robot 'pendulum': joint 'hinge' moves (nearly) nothing: 0 kg m² about its axis, expected above 1e-09; "
            "give link 'rod' realistic inertia to simulate it");

  RobotDescription two_on_one_axis = makePendulum();
  two_on_one_axis.joints.insert(two_on_one_axis.joints.begin(), on_axis.joints[0]);
  two_on_one_axis.joints[0].name = "first";
  two_on_one_axis.joints[0].link = "hub";
  EXPECT_EQ(errorOf([&] { BulletArm arm(two_on_one_axis); }),
            "robot 'pendulum': joint 'first' moves (nearly) nothing: 0 kg m² about its axis, expected above 1e-09; "
            "give link 'hub' realistic inertia to simulate it")
      << "the second joint, loose, leaves nothing for the first to accelerate";
}

TEST(BulletArmTest, BadTorquesAreRefusedBeforeAnythingMoves) {
  BulletArm arm(makePendulum());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(errorOf([&] { arm.step(vector1(nan), kPeriod, kSubsteps); }),
            "simulated robot 'pendulum': torque of joint 'hinge' is nan, expected a finite number");
  EXPECT_EQ(errorOf([&] { arm.step(Eigen::VectorXd::Zero(2), kPeriod, kSubsteps); }),
            "simulated robot 'pendulum': torque has 2 values, expected one for each of its 1 joints");
  EXPECT_EQ(errorOf([&] { arm.step(vector1(0.0), 0.0, kSubsteps); }),
            "simulated robot 'pendulum': a step of 0 s in 4 parts, expected a positive time and at least one "
            "part");
  EXPECT_EQ(errorOf([&] { arm.step(vector1(0.0), kPeriod, 0); }),
            "simulated robot 'pendulum': a step of 0.001 s in 0 parts, expected a positive time and at least one "
            "part");
  EXPECT_EQ(arm.state().q, vector1(0.0));
}

TEST(BulletArmTest, AStartOutsideTheLimitsIsRefused) {
  RobotDescription description = makePendulum();
  description.joints[0].lower = -0.5;
  description.joints[0].upper = 1.0;
  BulletArm arm(description);
  EXPECT_EQ(errorOf([&] {
              arm.reset({vector1(1.3), vector1(0.0)});
            }),
            "simulated robot 'pendulum': joint 'hinge' cannot start at 1.3 rad, expected a position from -0.5 to 1");
  EXPECT_NO_THROW(arm.reset({vector1(1.001), vector1(0.0)})) << "where a stopped arm may be";
}

}  // namespace
}  // namespace demo_logger
