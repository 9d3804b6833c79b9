// What is done to a simulated arm besides commanding it: loads, wrenches, another side of the torque sensor.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/trajectory/error.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

const BodyInertia kLoad{1.5, {0.0, 0.0, 0.08}, Eigen::Matrix3d::Identity() * 2e-3};

class LoadedArmTest : public testing::Test {
 protected:
  static SimulatedArm makeArm(const SimulatedArmConfiguration& configuration) {
    return {describeDemoArm(), configuration};
  }

  ArmTick run(SimulatedArm& arm, int ticks, const std::vector<ArmCommand>& commands = {}) {
    ArmTick tick;
    for (int k = 0; k < ticks; ++k) tick = arm.tick(now += kMillisecond, commands);
    return tick;
  }

  static LinkWrench makeForce(int joint, const Eigen::Vector3d& force) {
    LinkWrench wrench;
    wrench.joint = joint;
    wrench.force = force;
    return wrench;
  }

  Nanoseconds now = kNanosecondsPerSecond;
};

TEST_F(LoadedArmTest, ADeclaredLoadIsHeldAgainstGravity) {
  SimulatedArm arm = makeArm(makeArmConfiguration(ControlMode::velocity));
  const Eigen::VectorXd start = run(arm, 1).truth.q;
  arm.setLoad(kLoad);
  const ArmTick tick = run(arm, 1000);
  const RobotModel loaded(withLoad(describeDemoArm(), kLoad));
  EXPECT_TRUE(tick.applied.torque.isApprox(loaded.gravity(tick.truth.q), 1e-9));
  EXPECT_LT((tick.truth.q - start).norm(), 1e-6);

  arm.setLoad(std::nullopt);
  EXPECT_TRUE(run(arm, 1).applied.torque.isApprox(RobotModel(describeDemoArm()).gravity(start), 1e-6));
}

TEST_F(LoadedArmTest, AnUndeclaredLoadPullsTheArmDown) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.load_declared = false;
  SimulatedArm arm = makeArm(configuration);
  const RobotModel model(describeDemoArm());
  const double height = model.forwardKinematics(run(arm, 1).truth.q).translation().z();
  arm.setLoad(kLoad);
  EXPECT_LT(model.forwardKinematics(run(arm, 500).truth.q).translation().z(), height - 1e-3);
}

TEST_F(LoadedArmTest, AnImpossibleLoadIsRefusedAndNothingChanges) {
  SimulatedArm arm = makeArm(makeArmConfiguration(ControlMode::velocity));
  EXPECT_THROW(arm.setLoad(BodyInertia{-1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()}), ModelError);
  EXPECT_TRUE(run(arm, 1).applied.torque.isApprox(RobotModel(describeDemoArm()).gravity(run(arm, 1).truth.q), 1e-9));
}

TEST_F(LoadedArmTest, AWrenchActsUntilItsEndAndIsInTheTruth) {
  SimulatedArm arm = makeArm(makeArmConfiguration(ControlMode::effort));
  const RobotDescription description = describeDemoArm();
  const RobotModel model(description);
  run(arm, 1);
  LinkWrench push = makeForce(6, {0.0, 20.0, 0.0});
  push.point = description.X_lastlink_tip.translation();
  ArmCommand nothing;  // gravity compensation alone: a compliant arm
  nothing.mode = ControlMode::effort;
  nothing.values = Eigen::VectorXd::Zero(7);
  EXPECT_EQ(arm.applyWrench(push, now + 101 * kMillisecond), "");
  ArmTick tick = run(arm, 1, {nothing});
  Eigen::VectorXd wrench(6);
  wrench << push.force, push.torque;
  EXPECT_LT((tick.external_torque - model.jacobian(tick.truth.q).transpose() * wrench).norm(), 1e-11);
  tick = run(arm, 99, {nothing});
  EXPECT_GT(tick.external_torque.norm(), 1.0);
  EXPECT_GT((model.jacobian(tick.truth.q) * tick.truth.dq)[1], 0.01) << "[m/s], pushed aside";
  EXPECT_TRUE(run(arm, 1).external_torque.isZero(0.0)) << "100 ms are over";
}

TEST_F(LoadedArmTest, AWrenchOfTheSameSourceReplacesTheOneBeforeOthersAddUp) {
  SimulatedArm arm = makeArm(makeArmConfiguration(ControlMode::velocity));
  LinkWrench push = makeForce(0, {0.0, 1.0, 0.0});
  push.point = {1.0, 0.0, 0.0};  // 1 N m about joint 1
  const Nanoseconds late = 100 * kNanosecondsPerSecond;
  for (int i = 0; i < 3; ++i) arm.applyWrench(push, late, "/hand");
  EXPECT_NEAR(run(arm, 1).external_torque[0], 1.0, 1e-12);
  arm.applyWrench(push, late);
  arm.applyWrench(push, late);
  EXPECT_NEAR(run(arm, 1).external_torque[0], 3.0, 1e-12);
  arm.reset();
  EXPECT_EQ(run(arm, 1).external_torque[0], 0.0);
}

TEST_F(LoadedArmTest, ImpossibleWrenchesAreRefusedInWords) {
  SimulatedArm arm = makeArm(makeArmConfiguration(ControlMode::velocity));
  const Nanoseconds late = 100 * kNanosecondsPerSecond;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(arm.applyWrench(makeForce(0, {nan, 0.0, 0.0}), late), "the wrench has a component that is not a number");
  EXPECT_EQ(arm.applyWrench(makeForce(0, {0.0, -2e4, 0.0}), late),
            "the wrench has a component of 20000 N or N m, expected at most 10000");
  EXPECT_EQ(arm.applyWrench(makeForce(7, {0.0, 0.0, 1.0}), late),
            "the wrench acts upon a link that this arm does not have");
  for (int i = 0; i < 32; ++i) EXPECT_EQ(arm.applyWrench({}, late), "");
  EXPECT_EQ(arm.applyWrench({}, late), "more than 32 wrenches would act at once; wait until some have ended");

  arm.refuse("/hand", "a reason");
  EXPECT_EQ(run(arm, 1).applied.reason, "no command yet; refused from /hand: a reason");
  EXPECT_EQ(run(arm, 1).applied.reason, "no command yet");
  EXPECT_EQ(arm.refused(), 1U);
}

TEST_F(LoadedArmTest, ASensorAtTheLinksReadsWhatFrictionLeavesOfTheMotorsTorque) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.sensors.effort_side = EffortSide::link;
  SimulatedArm arm = makeArm(configuration);
  ArmCommand command;
  command.mode = ControlMode::velocity;
  command.values = Eigen::VectorXd::Constant(7, 0.3);
  ArmTick tick;
  Eigen::VectorXd motor;
  for (int k = 0; k < 500; ++k) {
    motor = tick.applied.torque;
    tick = arm.tick(now += kMillisecond, {command});
  }
  const RobotDescription description = describeDemoArm();
  for (int i = 0; i < 7; ++i) {  // in steady motion friction is all the difference
    const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
    EXPECT_NEAR(motor[i] - tick.reading.effort[i], joint.friction + joint.damping * 0.3, 2e-3) << joint.name;
  }
}

TEST_F(LoadedArmTest, TheReferenceModeRefusesObstacles) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.integrator = Integrator::runge_kutta_4;
  configuration.surroundings.floor = -0.5;
  try {
    makeArm(configuration);
    FAIL() << "taken";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(),
                 "simulated arm: the reference mode knows no contact, expected neither a floor nor obstacles with it.");
  }
}

TEST_F(LoadedArmTest, ABiasForEachJointOrNone) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.sensors.position_bias = {0.1};
  EXPECT_THROW(makeArm(configuration), ConfigurationError);
}

}  // namespace
}  // namespace demo_logger
