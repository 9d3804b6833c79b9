#include "demo_logger/simulation/command_gate.h"

#include <gtest/gtest.h>

#include <limits>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;
constexpr Nanoseconds kNow = 1000 * kNanosecondsPerSecond;

CommandGate makeGate() { return CommandGate({{"shoulder", "elbow"}, "base", "tool", /*timeout=*/0.5, /*slides=*/{}}); }

ArmCommand makeVelocity(double shoulder, double elbow) {
  ArmCommand command;
  command.mode = ControlMode::velocity;
  command.values = Eigen::Vector2d(shoulder, elbow);
  command.source = "/teleop";
  return command;
}

ArmCommand makeTwist(const std::string& frame) {
  ArmCommand command;
  command.mode = ControlMode::cartesian_velocity;
  command.values = Eigen::VectorXd::Ones(6);
  command.frame = frame;
  return command;
}

std::string admit(CommandGate& gate, const ArmCommand& command, Nanoseconds now = kNow) {
  return gate.admit(command, command.mode, now);
}

TEST(CommandGateTest, ASoundCommandIsInForceFromItsReceiptOn) {
  CommandGate gate = makeGate();
  EXPECT_EQ(gate.inForce(kNow), nullptr);
  EXPECT_EQ(gate.whyNone(), "no command yet");

  EXPECT_EQ(admit(gate, makeVelocity(0.1, 0.2)), "");

  ASSERT_NE(gate.inForce(kNow), nullptr);
  EXPECT_EQ(gate.inForce(kNow)->values, Eigen::Vector2d(0.1, 0.2));
}

TEST(CommandGateTest, NamedValuesAreSortedIntoTheOrderOfTheArm) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  command.names = {"elbow", "shoulder"};
  EXPECT_EQ(admit(gate, command), "");
  EXPECT_EQ(gate.inForce(kNow)->values, Eigen::Vector2d(0.2, 0.1));
}

TEST(CommandGateTest, WhatIsMalformedIsRefusedInWords) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(admit(gate, command), "elbow in a velocity command is nan rad/s, expected at most 1e+06 rad/s either way");

  command = makeVelocity(1e300, 0.0);
  EXPECT_EQ(admit(gate, command),
            "shoulder in a velocity command is 1e+300 rad/s, expected at most 1e+06 rad/s either way");
  command.names = {"elbow", "shoulder"};
  EXPECT_EQ(admit(gate, command),
            "elbow in a velocity command is 1e+300 rad/s, expected at most 1e+06 rad/s either way")
      << "the joint is the one that was named";
  command.names.clear();

  command.values = Eigen::Vector3d::Zero();
  EXPECT_EQ(admit(gate, command), "a velocity command has 3 values, expected 2, one for each joint");

  command = makeVelocity(0.0, 0.0);
  command.names = {"shoulder"};
  EXPECT_EQ(admit(gate, command), "a velocity command has 2 values for 1 names, expected 2, one for each joint");

  command.names = {"shoulder", "ellbow"};
  EXPECT_EQ(admit(gate, command), "the command names \"ellbow\", no joint of this arm");

  command.names = {"elbow", "elbow"};
  EXPECT_EQ(admit(gate, command), "the command names \"elbow\" twice");

  command = makeTwist("camera");
  EXPECT_EQ(admit(gate, command), "a twist is given in the frame \"camera\", expected \"base\" or \"tool\"");

  command = makeTwist("base");
  command.values = Eigen::Vector3d::Zero();
  EXPECT_EQ(admit(gate, command), "a cartesian_velocity command has 3 values, expected vx vy vz wx wy wz");

  command = makeTwist("base");
  command.values[4] = -2e6;
  EXPECT_EQ(admit(gate, command),
            "wy in a cartesian_velocity command is -2e+06 rad/s, expected at most 1e+06 rad/s either way");

  EXPECT_EQ(gate.inForce(kNow), nullptr);
}

TEST(CommandGateTest, ARefusalIsShortHoweverLongWhatItNames) {
  CommandGate gate = makeGate();
  const std::string endless(100000, 'x');
  const std::string shown = "\"" + std::string(80, 'x') + "…\"";
  EXPECT_EQ(admit(gate, makeTwist(endless)),
            "a twist is given in the frame " + shown + ", expected \"base\" or \"tool\"");
  ArmCommand command = makeVelocity(0.0, 0.0);
  command.names = {"shoulder", endless};
  EXPECT_EQ(admit(gate, command), "the command names " + shown + ", no joint of this arm");
}

TEST(CommandGateTest, ARefusalHasTheUnitOfItsJointAndMode) {
  CommandGate gate({{"rail", "elbow"}, "base", "tool", /*timeout=*/0.5, /*slides=*/{true, false}});
  ArmCommand command = makeVelocity(1e7, 0.0);
  const std::vector<std::pair<ControlMode, std::string>> units = {
      {ControlMode::effort, "N"}, {ControlMode::velocity, "m/s"}, {ControlMode::position, "m"}};
  for (const auto& [mode, unit] : units) {
    command.mode = mode;
    EXPECT_EQ(admit(gate, command), std::string("rail in ") + (mode == ControlMode::effort ? "an " : "a ") +
                                        toString(mode) + " command is 1e+07 " + unit + ", expected at most 1e+06 " +
                                        unit + " either way");
  }
  command = {};
  command.mode = ControlMode::trajectory;
  command.path = {{1.0, Eigen::Vector2d(0.1, 0.2), Eigen::Vector2d(0.0, 1e9), {}}};
  EXPECT_EQ(admit(gate, command),
            "elbow in the velocity at point 1 of a path is 1e+09 rad/s, expected at most 1e+06 rad/s either way");
}

TEST(CommandGateTest, APositionToGoToIsInForceUntilItIsReplacedUnlessItMovesItself) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  command.mode = ControlMode::position;
  admit(gate, command);
  EXPECT_NE(gate.inForce(kNow + 3600 * kNanosecondsPerSecond), nullptr) << "the arm comes to rest there";
  command.rates = Eigen::Vector2d::Zero();
  admit(gate, command);
  EXPECT_NE(gate.inForce(kNow + 3600 * kNanosecondsPerSecond), nullptr) << "no velocity is none";
  command.rates = Eigen::Vector2d(0.0, 0.1);
  admit(gate, command);
  EXPECT_NE(gate.inForce(kNow + 500 * kMillisecond), nullptr);
  EXPECT_EQ(gate.inForce(kNow + 501 * kMillisecond), nullptr) << "it would run away";
  EXPECT_EQ(gate.whyNone(), "no command for 0.5 s");
}

TEST(CommandGateTest, ACommandForAnotherModeThanTheOneInForceIsRefused) {
  CommandGate gate = makeGate();
  EXPECT_EQ(gate.admit(makeTwist(""), ControlMode::velocity, kNow),
            "a command for mode cartesian_velocity came while mode velocity is in force");
}

TEST(CommandGateTest, ARefusedCommandLeavesTheOneBeforeInForce) {
  CommandGate gate = makeGate();
  admit(gate, makeVelocity(0.1, 0.2));
  admit(gate, makeVelocity(std::numeric_limits<double>::infinity(), 0.0), kNow + kMillisecond);
  ASSERT_NE(gate.inForce(kNow + kMillisecond), nullptr);
  EXPECT_EQ(gate.inForce(kNow + kMillisecond)->values, Eigen::Vector2d(0.1, 0.2));
}

TEST(CommandGateTest, TheTimeoutCountsFromTheReceiptOfTheLastSoundCommand) {
  CommandGate gate = makeGate();
  admit(gate, makeVelocity(0.1, 0.2));
  admit(gate, makeVelocity(0.1, std::numeric_limits<double>::quiet_NaN()), kNow + 400 * kMillisecond);

  EXPECT_NE(gate.inForce(kNow + 500 * kMillisecond), nullptr);
  EXPECT_EQ(gate.inForce(kNow + 501 * kMillisecond), nullptr) << "what was refused does not prolong anything";
  EXPECT_EQ(gate.whyNone(), "no command for 0.5 s");
}

TEST(CommandGateTest, TheTimeoutAlsoCountsFromTheStamp) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  command.stamp = kNow - 300 * kMillisecond;
  EXPECT_EQ(admit(gate, command), "");

  EXPECT_NE(gate.inForce(kNow + 200 * kMillisecond), nullptr);
  EXPECT_EQ(gate.inForce(kNow + 201 * kMillisecond), nullptr);
  EXPECT_EQ(gate.whyNone(), "the last command is older than 0.5 s by its stamp");
}

TEST(CommandGateTest, AStaleCommandIsRefusedAndSoIsOneFromTheFuture) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  command.stamp = kNow - 2 * kNanosecondsPerSecond;
  EXPECT_EQ(admit(gate, command),
            "the stamp of a command is 2 s old; stale, or the clocks differ: judged after a second of commands");
  command.stamp = kNow + 2 * kNanosecondsPerSecond;
  EXPECT_EQ(admit(gate, command),
            "the stamp of a command is 2 s in the future; stale, or the clocks differ: judged after a second of "
            "commands");
  EXPECT_EQ(gate.inForce(kNow), nullptr);
}

TEST(CommandGateTest, ACommandOlderThanTheOneInForceIsRefused) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  command.stamp = kNow;
  admit(gate, command);
  command.stamp = kNow - 10 * kMillisecond;
  EXPECT_EQ(admit(gate, command, kNow + kMillisecond), "a command is 0.01 s older than the one in force");
  command.source = "/other";
  EXPECT_EQ(admit(gate, command, kNow + kMillisecond), "") << "stamps of two publishers are not compared";
}

TEST(CommandGateTest, APublisherWhoseClockIsBehindIsCorrectedNamedAndStillGuarded) {
  CommandGate gate = makeGate();
  const Nanoseconds skew = 5 * kNanosecondsPerSecond;
  ArmCommand command = makeVelocity(0.1, 0.2);
  int admitted = 0;
  Nanoseconds now = kNow;
  for (int i = 0; i <= 150; ++i, now += 10 * kMillisecond) {
    command.stamp = now - skew;
    if (admit(gate, command, now).empty()) ++admitted;
  }
  EXPECT_EQ(admitted, 51) << "judged with the message one second after the first, 101st of 151";
  ASSERT_EQ(gate.clockMismatches().size(), 1U);
  EXPECT_EQ(gate.clockMismatches()[0],
            "/teleop: stamps are 5 s behind this clock (transport or skew); ages are corrected");

  command.stamp = now - skew - 2 * kNanosecondsPerSecond;
  EXPECT_EQ(admit(gate, command, now), "the stamp of a command is 2 s old") << "stuck on the way, by its own clock";
}

TEST(CommandGateTest, ClearingForgetsTheCommandAndSaysWhy) {
  CommandGate gate = makeGate();
  admit(gate, makeVelocity(0.1, 0.2));
  gate.clear("paused");
  EXPECT_EQ(gate.inForce(kNow), nullptr);
  EXPECT_EQ(gate.whyNone(), "paused");
}

TEST(CommandGateTest, AResetForgetsTheCommandAndTheClocks) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  for (Nanoseconds now = kNow; now <= kNow + kNanosecondsPerSecond; now += 100 * kMillisecond) {
    command.stamp = now - 5 * kNanosecondsPerSecond;
    admit(gate, command, now);
  }
  ASSERT_EQ(gate.clockMismatches().size(), 1U);
  gate.reset();
  EXPECT_TRUE(gate.clockMismatches().empty());
  EXPECT_EQ(gate.inForce(kNow + kNanosecondsPerSecond), nullptr);
  EXPECT_EQ(gate.whyNone(), "no command yet");
}

TEST(CommandGateTest, MemoryForClocksIsBounded) {
  CommandGate gate = makeGate();
  ArmCommand command = makeVelocity(0.1, 0.2);
  command.stamp = kNow;
  std::string refusal;
  for (int i = 0; i < 17; ++i) {
    command.source = "/publisher" + std::to_string(i);
    refusal = admit(gate, command);
  }
  EXPECT_EQ(refusal, "more than 16 publishers have commanded this arm; /publisher16 is one too many");
}

TEST(ControlModeTest, NamesAndModesAreTheSameBothWays) {
  for (const ControlMode mode : {ControlMode::effort, ControlMode::velocity, ControlMode::position,
                                 ControlMode::trajectory, ControlMode::cartesian_velocity}) {
    EXPECT_EQ(toControlMode(toString(mode)), mode);
  }
  try {
    toControlMode("speed");
    FAIL() << "an unknown mode was taken";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(),
                 "control mode \"speed\" is not one of this arm, expected one of effort, velocity, position, "
                 "trajectory, cartesian_velocity, gravity_compensation, impedance.");
  }
}

}  // namespace
}  // namespace demo_logger
