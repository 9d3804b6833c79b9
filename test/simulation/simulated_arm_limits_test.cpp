#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/simulation/simulated_arm.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

/// A publisher that sends whatever can be sent: sensible, huge, and broken commands, for all modes, stamped and not.
class HostilePublisher {
 public:
  explicit HostilePublisher(unsigned seed) : random_(seed) {}

  std::vector<ArmCommand> commands(ControlMode favourite, Nanoseconds now) {
    std::vector<ArmCommand> commands;
    if (draw(0, 20) == 0) target_ = drawTarget();
    const int count = draw(0, 3) == 0 ? draw(1, 3) : 0;
    for (int i = 0; i < count; ++i) commands.push_back(command(favourite, now));
    return commands;
  }

 private:
  int draw(int lowest, int highest) { return std::uniform_int_distribution<int>(lowest, highest)(random_); }

  /// A direction kept for a while, so that the arm gets somewhere: into limits and singularities.
  std::vector<double> drawTarget() {
    const double scale = std::pow(10.0, draw(-2, 5));
    std::vector<double> target(7);
    for (double& value : target) value = scale * std::normal_distribution<double>()(random_);
    return target;
  }

  ArmCommand command(ControlMode favourite, Nanoseconds now) {
    ArmCommand command;
    command.mode = draw(0, 9) == 0 ? static_cast<ControlMode>(draw(0, 2)) : favourite;
    const int size = command.mode == ControlMode::cartesian_velocity ? 6 : 7;
    command.values = Eigen::Map<const Eigen::VectorXd>(target_.data(), size);
    if (draw(0, 9) == 0) command.values[draw(0, 5)] = poison();
    if (draw(0, 19) == 0) command.values.conservativeResize(draw(0, 5));
    if (draw(0, 19) == 0) command.names = {"nonsense"};
    if (draw(0, 9) == 0) command.frame = draw(0, 1) == 0 ? "tool_tip" : "nowhere";
    if (draw(0, 3) == 0) command.stamp = now + draw(-1000, 1000) * kMillisecond;
    return command;
  }

  double poison() {
    const double values[] = {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::max(),
                             1e6,
                             -1e6};
    return values[draw(0, 5)];
  }

  std::mt19937 random_;
  std::vector<double> target_ = std::vector<double>(7, 0.1);
};

class SimulatedArmLimitsTest : public testing::TestWithParam<ControlMode> {};

TEST_P(SimulatedArmLimitsTest, LimitsOnPositionVelocityAndEffortHoldWhateverIsSent) {
  const RobotDescription description = describeDemoArm();
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SimulatedArm arm(description, makeArmConfiguration(GetParam()));
    HostilePublisher publisher(seed);
    Nanoseconds now = kNanosecondsPerSecond;
    double travelled = 0.0;
    for (int k = 0; k < 6000; ++k) {
      now += kMillisecond;
      const ArmTick tick = arm.tick(now, publisher.commands(GetParam(), now));
      travelled += tick.truth.dq.norm() * 0.001;
      ASSERT_TRUE(tick.applied.command.allFinite()) << tick.applied.reason;
      for (int i = 0; i < 7; ++i) {
        const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
        const std::string where = joint.name + ", seed " + std::to_string(seed) + ", tick " + std::to_string(k) +
                                  ", reason: " + tick.applied.reason;
        ASSERT_LE(std::abs(tick.applied.torque[i]), joint.effort_limit) << where;
        ASSERT_LE(std::abs(tick.truth.dq[i]), joint.velocity_limit) << where;
        ASSERT_LE(tick.truth.q[i], joint.upper) << where;
        ASSERT_GE(tick.truth.q[i], joint.lower) << where;
      }
    }
    EXPECT_GT(travelled, 1.0) << "[rad], or the test would be about an arm at rest";
    EXPECT_GT(arm.controller().refusedCommands(), 100U);
  }
}

TEST_P(SimulatedArmLimitsTest, ACommandThatDiffersFromWhatWasAskedComesWithAReason) {
  SimulatedArm arm(describeDemoArm(), makeArmConfiguration(GetParam()));
  std::mt19937 random(9);
  std::normal_distribution<double> value;
  Nanoseconds now = kNanosecondsPerSecond;
  ArmCommand command;
  command.mode = GetParam();
  int explained = 0;
  for (int k = 0; k < 4000; ++k) {
    now += kMillisecond;
    std::vector<ArmCommand> commands;
    if (k % 100 == 0) {
      const double scale = std::pow(10.0, static_cast<double>(k / 100 % 5) - 2.0);
      command.values.resize(GetParam() == ControlMode::cartesian_velocity ? 6 : 7);
      for (double& component : command.values) component = scale * value(random);
      commands.push_back(command);
    }
    const ArmTick tick = arm.tick(now, commands);
    if (tick.applied.reason.empty()) {
      ASSERT_EQ(tick.applied.command, command.values) << "tick " << k;
    } else {
      ++explained;
    }
  }
  EXPECT_GT(explained, 0);
  EXPECT_LT(explained, 4000);
}

INSTANTIATE_TEST_SUITE_P(Modes, SimulatedArmLimitsTest,
                         testing::Values(ControlMode::effort, ControlMode::velocity, ControlMode::position,
                                         ControlMode::cartesian_velocity),
                         [](const auto& test) { return toString(test.param); });

}  // namespace
}  // namespace demo_logger
