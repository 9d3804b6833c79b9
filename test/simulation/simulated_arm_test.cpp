#include "demo_logger/simulation/simulated_arm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

constexpr double kTick = 0.001;         // [s]
constexpr double kAcceleration = 10.0;  // [rad/s²] default limit
constexpr double kTracking = 5e-3;      // [rad/s] of the slow, frictional arm behind its reference

ArmCommand makeVelocities(const Eigen::VectorXd& values) {
  ArmCommand command;
  command.mode = ControlMode::velocity;
  command.values = values;
  return command;
}

ArmCommand makeVelocity(double value) { return makeVelocities(Eigen::VectorXd::Constant(7, value)); }

ArmCommand makeTwist(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular, const std::string& frame = "") {
  ArmCommand command;
  command.mode = ControlMode::cartesian_velocity;
  command.values.resize(6);
  command.values << linear, angular;
  command.frame = frame;
  return command;
}

ArmCommand makeEffort(const Eigen::VectorXd& torque) {
  ArmCommand command;
  command.mode = ControlMode::effort;
  command.values = torque;
  return command;
}

/// An arm and the clock its ticks go by.
class Bench {
 public:
  explicit Bench(ControlMode mode) : arm(makeDemoArm(mode)), model(describeDemoArm()) {}

  ArmTick tick(const std::vector<ArmCommand>& commands = {}) {
    now += kMillisecond;
    return arm.tick(now, commands);
  }

  ArmTick repeat(const ArmCommand& command, int ticks) {
    for (int k = 1; k < ticks; ++k) tick({command});
    return tick({command});
  }

  SimulatedArm arm;
  RobotModel model;
  Nanoseconds now = 0;
};

TEST(SimulatedArmTest, WithoutACommandItStaysWhereItIsAndSaysWhy) {
  Bench bench(ControlMode::velocity);
  ArmTick tick;
  for (int k = 0; k < 1000; ++k) tick = bench.tick();
  const std::vector<double> start = bentPosition();
  EXPECT_LT((tick.truth.q - Eigen::Map<const Eigen::VectorXd>(start.data(), 7)).norm(), 1e-6);
  EXPECT_EQ(tick.applied.reason, "no command yet");
  EXPECT_TRUE(tick.applied.command.isZero(0.0));
  EXPECT_EQ(tick.index, 999U);
  EXPECT_EQ(tick.stamp, 1000 * kMillisecond);
}

TEST(SimulatedArmTest, TheTorqueAtRestIsGravity) {
  Bench bench(ControlMode::velocity);
  const ArmTick tick = bench.tick();
  EXPECT_TRUE(tick.applied.torque.isApprox(bench.model.gravity(tick.truth.q), 1e-9));
  EXPECT_EQ(tick.reading.effort, tick.applied.torque);
}

TEST(SimulatedArmTest, InSteadyStateEveryJointHasItsCommandedVelocity) {
  Bench bench(ControlMode::velocity);
  Eigen::VectorXd command(7);
  command << 0.1, -0.2, 0.3, -0.1, 0.2, -0.3, 0.15;
  const ArmTick tick = bench.repeat(makeVelocities(command), 500);
  EXPECT_LT((tick.truth.dq - command).cwiseAbs().maxCoeff(), kTracking) << tick.truth.dq.transpose();
}

TEST(SimulatedArmTest, WithoutAReasonTheAppliedCommandIsTheOneAskedFor) {
  Bench bench(ControlMode::cartesian_velocity);
  const ArmCommand twist = makeTwist({0.05, -0.02, 0.01}, {0.0, 0.1, 0.05});
  const ArmTick tick = bench.repeat(twist, 300);
  EXPECT_EQ(tick.applied.reason, "");
  EXPECT_EQ(tick.applied.command, twist.values) << "bit for bit";
  EXPECT_EQ(tick.applied.names, (std::vector<std::string>{"vx", "vy", "vz", "wx", "wy", "wz"}));
}

TEST(SimulatedArmTest, TheTipMovesWithTheTwistInBaseAxes) {
  Bench bench(ControlMode::cartesian_velocity);
  const ArmCommand twist = makeTwist({0.05, -0.1, 0.02}, {0.0, 0.2, 0.1}, "base_link");
  const ArmTick tick = bench.repeat(twist, 400);
  const Eigen::VectorXd tip = bench.model.jacobian(tick.truth.q) * tick.truth.dq;
  EXPECT_LT((tip - twist.values).cwiseAbs().maxCoeff(), kTracking) << tip.transpose();
}

TEST(SimulatedArmTest, ATwistInTheTipsAxesIsTurnedIntoTheBases) {
  Bench bench(ControlMode::cartesian_velocity);
  const ArmTick start = bench.tick();
  const Eigen::Matrix3d R_base_tip = bench.model.forwardKinematics(start.truth.q).linear();
  const ArmTick tick = bench.repeat(makeTwist({0.0, 0.0, 0.05}, {0.0, 0.0, 0.0}, "tool_tip"), 300);
  const Eigen::Vector3d expected = R_base_tip * Eigen::Vector3d(0.0, 0.0, 0.05);  // the tip does not turn meanwhile
  EXPECT_LT((tick.applied.command.head<3>() - expected).norm(), 1e-3) << tick.applied.command.transpose();
}

TEST(SimulatedArmTest, ACommandActsFromTheTickItIsGivenToAndNotBefore) {
  Bench bench(ControlMode::velocity);
  const ArmTick before = bench.tick();
  const ArmTick at = bench.tick({makeVelocity(0.005)});  // within one tick of the acceleration limit
  EXPECT_EQ(before.applied.reason, "no command yet");
  EXPECT_EQ(at.applied.reason, "");
  EXPECT_TRUE(at.truth.dq.isZero(1e-9)) << "the state of this tick was there before it acted";
  EXPECT_GT(bench.tick().truth.dq[0], 1e-3);
}

TEST(SimulatedArmTest, TheAppliedTorqueIsWhatThePhysicsSaw) {
  Bench bench(ControlMode::cartesian_velocity);
  BulletArm physics(describeDemoArm());
  ArmTick tick = bench.tick();
  physics.reset(tick.truth);
  for (int k = 0; k < 300; ++k) {
    physics.step(tick.applied.torque, kTick, 4);
    tick = bench.tick({makeTwist({0.2 * std::sin(0.02 * k), 0.1, 0.0}, {0.0, 0.0, 0.3})});
    ASSERT_EQ(physics.state().q, tick.truth.q) << "tick " << k;
    ASSERT_EQ(physics.state().dq, tick.truth.dq) << "tick " << k;
  }
}

TEST(SimulatedArmTest, TheSameInputsGiveTheSameBits) {
  Bench first(ControlMode::velocity);
  Bench second(ControlMode::velocity);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> velocity(-1.0, 1.0);
  for (int k = 0; k < 500; ++k) {
    const ArmCommand command = makeVelocity(velocity(random));
    const ArmTick a = first.tick({command});
    const ArmTick b = second.tick({command});
    ASSERT_EQ(a.truth.q, b.truth.q);
    ASSERT_EQ(a.applied.torque, b.applied.torque);
    ASSERT_EQ(a.applied.reason, b.applied.reason);
  }
}

TEST(SimulatedArmTest, WhenCommandsStopItBrakesToRestWithinTheAccelerationLimit) {
  Bench bench(ControlMode::velocity);
  const double speed = 0.5;
  const ArmTick last = bench.repeat(makeVelocity(speed), 300);
  ArmTick tick = last;
  double largest_deceleration = 0.0;
  int ticks_after_timeout = 0;
  while (tick.truth.dq.cwiseAbs().maxCoeff() > 0.01 && ticks_after_timeout < 1000) {
    const Eigen::VectorXd before = tick.truth.dq;
    tick = bench.tick();
    if (tick.stamp <= last.stamp + 500 * kMillisecond) {
      ASSERT_EQ(tick.applied.command, last.applied.command) << "until the timeout the command stays in force";
      continue;
    }
    ++ticks_after_timeout;
    EXPECT_EQ(tick.applied.reason.rfind("no command for 0.5 s", 0), 0U) << tick.applied.reason;
    if (tick.truth.dq.minCoeff() > 0.05) {  // slower, friction alone brakes a light wrist harder
      largest_deceleration = std::max(largest_deceleration, (before - tick.truth.dq).maxCoeff() / kTick);
    }
  }
  EXPECT_LE(ticks_after_timeout, static_cast<int>(speed / kAcceleration / kTick) + 10) << "v/a, and the tracking's lag";
  EXPECT_GT(ticks_after_timeout, static_cast<int>(speed / kAcceleration / kTick) - 10);
  EXPECT_LE(largest_deceleration, 1.2 * kAcceleration);
}

TEST(SimulatedArmTest, ATwistTooFastForTheJointsKeepsItsDirection) {
  Bench bench(ControlMode::cartesian_velocity);
  const ArmCommand twist = makeTwist({0.0, 3.0, 0.0}, {0.0, 0.0, 0.0});
  ArmTick tick;
  for (int k = 0; k < 200; ++k) {
    tick = bench.tick({twist});
    const Eigen::VectorXd command = tick.applied.command;
    ASSERT_GT(command[1], 0.0);
    ASSERT_LT(command[1], 3.0);
    EXPECT_LT(std::abs(command[0]) + std::abs(command[2]) + command.tail<3>().norm(), 0.05 * command[1])
        << "tick " << k << ": " << command.transpose();
  }
  EXPECT_NE(tick.applied.reason.find("velocity of joint_"), std::string::npos) << tick.applied.reason;
}

TEST(SimulatedArmTest, BeforeAPositionLimitItSlowsToRestAndTheWayBackStaysOpen) {
  Bench bench(ControlMode::velocity);
  const ArmJoint elbow = describeDemoArm().joints[3];
  Eigen::VectorXd command = Eigen::VectorXd::Zero(7);
  command[3] = 1.0;
  const ArmTick at_limit = bench.repeat(makeVelocities(command), 2000);
  EXPECT_NEAR(at_limit.truth.q[3], elbow.upper - 0.01, 2e-3) << "a margin of 0.01 rad before the limit";
  EXPECT_LT(std::abs(at_limit.truth.dq[3]), kTracking);
  EXPECT_EQ(at_limit.applied.reason, "joint_4 slowed before its upper limit 2.0944 rad");

  const ArmTick back = bench.repeat(makeVelocities(-command), 300);
  EXPECT_NEAR(back.truth.dq[3], -1.0, kTracking);
  EXPECT_EQ(back.applied.reason, "");
}

TEST(SimulatedArmTest, ACommandForAnotherModeIsRefusedAndTheFirstGoesOn) {
  Bench bench(ControlMode::velocity);
  bench.repeat(makeVelocity(0.1), 100);
  const ArmTick tick = bench.tick({makeTwist({1.0, 0.0, 0.0}, {0.0, 0.0, 0.0})});
  EXPECT_EQ(tick.applied.mode, ControlMode::velocity);
  EXPECT_EQ(tick.applied.command, Eigen::VectorXd::Constant(7, 0.1));
  EXPECT_EQ(tick.applied.reason, "refused: a command for mode cartesian_velocity came while mode velocity is in force");
  EXPECT_EQ(bench.arm.controller().refusedCommands(), 1U);
  EXPECT_EQ(bench.tick().applied.reason, "") << "said in the tick in which it happened";
}

TEST(SimulatedArmTest, OnAChangeOfModeItBrakesUntilThereIsACommandOfTheNewMode) {
  Bench bench(ControlMode::velocity);
  bench.repeat(makeVelocity(0.3), 200);
  bench.arm.setMode(ControlMode::cartesian_velocity);
  ArmTick tick = bench.tick();
  EXPECT_EQ(tick.applied.mode, ControlMode::cartesian_velocity);
  EXPECT_EQ(tick.applied.reason.rfind("no command yet since mode cartesian_velocity was chosen", 0), 0U);
  EXPECT_LT((tick.truth.dq.array() - 0.3).abs().maxCoeff(), kTracking) << "nothing jumps";
  for (int k = 0; k < 100; ++k) tick = bench.tick();
  EXPECT_LT(tick.truth.dq.cwiseAbs().maxCoeff(), 0.01);
}

TEST(SimulatedArmTest, AfterAResetItIsWhereItStartedAndTicksGoOn) {
  Bench bench(ControlMode::velocity);
  const ArmTick first = bench.tick();
  bench.repeat(makeVelocity(0.3), 300);
  bench.arm.reset();
  const ArmTick tick = bench.tick();
  EXPECT_EQ(tick.truth.q, first.truth.q);
  EXPECT_TRUE(tick.truth.dq.isZero(0.0));
  EXPECT_EQ(tick.applied.reason, "no command yet");
  EXPECT_EQ(tick.applied.torque, first.applied.torque) << "nothing of the motion before is left";
  EXPECT_EQ(tick.index, 301U);
}

TEST(SimulatedArmTest, InModeEffortCommandsComeOnTopOfGravity) {
  Bench bench(ControlMode::effort);
  const ArmCommand nothing = makeEffort(Eigen::VectorXd::Zero(7));
  const ArmTick tick = bench.repeat(nothing, 500);
  EXPECT_TRUE(tick.applied.torque.isApprox(bench.model.gravity(tick.truth.q), 1e-12));
  EXPECT_EQ(tick.applied.command, nothing.values) << "bit for bit";
  EXPECT_EQ(tick.applied.reason, "");
  EXPECT_LT(tick.truth.dq.norm(), 1e-6) << "gravity is balanced, and stiction holds the rest";
}

TEST(SimulatedArmTest, InModeEffortWithoutCompensationTheTorqueIsTheOneAskedFor) {
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::effort);
  configuration.controller.effort_gravity_compensation = false;
  SimulatedArm arm(describeDemoArm(), configuration);
  const RobotModel model(describeDemoArm());
  Nanoseconds now = kMillisecond;
  const Eigen::VectorXd gravity = model.gravity(arm.tick(now, {}).truth.q);
  ArmTick tick;
  for (int k = 0; k < 500; ++k) tick = arm.tick(now += kMillisecond, {makeEffort(gravity)});
  EXPECT_EQ(tick.applied.torque, gravity);
  EXPECT_EQ(tick.applied.command, gravity);
  EXPECT_EQ(tick.applied.reason, "");
  EXPECT_LT(tick.truth.dq.norm(), 1e-6);
}

TEST(SimulatedArmTest, InModeEffortAPushAcceleratesAsTheEquationOfMotionSays) {
  DescriptionOptions options;
  const RobotDescription description =
      describeRobotFile(std::string(DEMO_LOGGER_SOURCE_DIR) + "/urdf/two_link.urdf", options);
  const RobotModel model(description);
  SimulatedArmConfiguration configuration;
  configuration.mode = ControlMode::effort;
  configuration.controller.effort_gravity_compensation = false;
  SimulatedArm arm(description, configuration);
  Nanoseconds now = kMillisecond;
  const ArmTick start = arm.tick(now, {});
  const Eigen::Vector2d acceleration(1.0, -2.0);
  const Eigen::VectorXd torque = model.gravity(start.truth.q) + model.massMatrix(start.truth.q) * acceleration;
  constexpr int kTicks = 20;
  for (int k = 0; k < kTicks; ++k) arm.tick(now += kMillisecond, {makeEffort(torque)});
  const Eigen::Vector2d expected = acceleration * kTicks * kTick;  // gravity changes little meanwhile
  const Eigen::Vector2d reached = arm.tick(now += kMillisecond, {}).truth.dq;
  EXPECT_LT((reached - expected).norm(), 0.05 * expected.norm()) << reached.transpose();
}

TEST(SimulatedArmTest, WhatCannotBeAnArmIsRefusedInASentence) {
  const auto messageOf = [](const SimulatedArmConfiguration& configuration) -> std::string {
    try {
      SimulatedArm arm(describeDemoArm(), configuration);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  SimulatedArmConfiguration configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.initial_position[1] = 3.0;
  EXPECT_EQ(messageOf(configuration),
            "simulated arm: initial_position of joint_2 is 3 rad, expected from -2.0944 to 2.0944 rad.");
  configuration.initial_position = {0.0};
  EXPECT_EQ(messageOf(configuration), "simulated arm: initial_position has 1 numbers, expected 7, one for each joint.");
  configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.controller.velocity_gain = 600.0;
  EXPECT_EQ(messageOf(configuration),
            "arm controller: velocity_gain is 600 1/s, expected above 0, at most half the control rate, beyond which "
            "the loop would ring.");
  configuration = makeArmConfiguration(ControlMode::velocity);
  configuration.controller.max_acceleration = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(messageOf(configuration),
            "arm controller: max_acceleration is nan rad/s2 or m/s2, expected above 0, at most 1000.");
}

}  // namespace
}  // namespace demo_logger
