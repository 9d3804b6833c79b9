// Position and trajectory modes of the simulated arm.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

constexpr double kTick = 0.001;         // [s]
constexpr double kAcceleration = 10.0;  // [rad/s²] default limit
constexpr double kAtRest = 1e-3;        // [rad] from the target when stiction holds the arm

Eigen::VectorXd bent() {
  const std::vector<double> start = bentPosition();
  return Eigen::Map<const Eigen::VectorXd>(start.data(), 7);
}

ArmCommand makePosition(const Eigen::VectorXd& q) {
  ArmCommand command;
  command.mode = ControlMode::position;
  command.values = q;
  return command;
}

PathPoint makePoint(double time, const Eigen::VectorXd& q) { return {time, q, {}, {}}; }

ArmCommand makePath(std::vector<PathPoint> points) {
  ArmCommand command;
  command.mode = ControlMode::trajectory;
  command.path = std::move(points);
  return command;
}

/// From rest to rest: velocities and accelerations of 0 at both ends.
PathPoint makeRest(double time, const Eigen::VectorXd& q) {
  return {time, q, Eigen::VectorXd::Zero(7), Eigen::VectorXd::Zero(7)};
}

class Bench {
 public:
  explicit Bench(ControlMode mode) : arm(makeDemoArm(mode)) {}

  ArmTick tick(const std::vector<ArmCommand>& commands = {}) {
    now += kMillisecond;
    const ArmTick tick = arm.tick(now, commands);
    if (tick.index > 0) {
      fastest = std::max(fastest, tick.truth.dq.cwiseAbs().maxCoeff());
      hardest = std::max(hardest, (tick.truth.dq - before).cwiseAbs().maxCoeff() / kTick);
    }
    before = tick.truth.dq;
    return tick;
  }

  ArmTick repeat(const ArmCommand& command, int ticks) {
    for (int k = 1; k < ticks; ++k) tick({command});
    return tick({command});
  }

  ArmTick wait(int ticks) {
    for (int k = 1; k < ticks; ++k) tick();
    return tick();
  }

  SimulatedArm arm;
  Nanoseconds now = 0;
  double fastest = 0.0;  // [rad/s] of any joint so far
  double hardest = 0.0;  // [rad/s²] acceleration of any joint so far
  Eigen::VectorXd before;
};

TEST(PositionControlTest, TheArmGoesToItsTargetAndRestsThere) {
  Bench bench(ControlMode::position);
  const Eigen::VectorXd target = bent() + Eigen::VectorXd::Constant(7, -0.3);
  double farthest = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const ArmTick tick = bench.tick({makePosition(target)});
    farthest = std::max(farthest, (target - tick.truth.q).maxCoeff());
  }
  const ArmTick tick = bench.tick({makePosition(target)});
  EXPECT_LT((tick.truth.q - target).cwiseAbs().maxCoeff(), kAtRest) << (tick.truth.q - target).transpose();
  EXPECT_LT(tick.truth.dq.cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT(farthest, kAtRest) << "it goes down to the target, never past it";
  EXPECT_EQ(tick.applied.command, target);
  EXPECT_EQ(tick.applied.reason, "");
  EXPECT_LT(bench.hardest, 2.5 * kAcceleration);
}

TEST(PositionControlTest, FarTargetsAreApproachedWithinTheVelocityLimits) {
  Bench bench(ControlMode::position);
  Eigen::VectorXd target = bent();
  target[0] = 2.0;
  target[6] = -2.0;
  const RobotDescription arm = describeDemoArm();
  for (int k = 0; k < 4000; ++k) {
    const ArmTick tick = bench.tick({makePosition(target)});
    for (std::size_t i = 0; i < 7; ++i) {
      ASSERT_LE(std::abs(tick.truth.dq[static_cast<Eigen::Index>(i)]), arm.joints[i].velocity_limit);
    }
  }
  EXPECT_LT((bench.tick({makePosition(target)}).truth.q - target).cwiseAbs().maxCoeff(), kAtRest);
}

TEST(PositionControlTest, ATargetThatSaysItsVelocityIsFollowedWithoutLag) {
  Bench bench(ControlMode::position);
  double worst = 0.0;
  ArmCommand command = makePosition(bent());
  command.rates = Eigen::VectorXd::Constant(7, 0.0);
  for (int k = 0; k < 3000; ++k) {
    const double t = k * kTick;
    const double ramp = std::min(t, 1.0);  // the sine sets in smoothly
    const double phase = 2.0 * t;
    std::vector<ArmCommand> commands;
    if (k % 10 == 0) {  // 100 Hz
      command.values = bent() + Eigen::VectorXd::Constant(7, 0.1 * ramp * std::sin(phase));
      command.rates =
          Eigen::VectorXd::Constant(7, 0.2 * ramp * std::cos(phase) + (t < 1.0 ? 0.1 * std::sin(phase) : 0.0));
      commands.push_back(command);
    }
    const ArmTick tick = bench.tick(commands);
    const Eigen::VectorXd meant = bent() + Eigen::VectorXd::Constant(7, 0.1 * ramp * std::sin(phase));
    worst = std::max(worst, (tick.truth.q - meant).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 5e-3);
}

TEST(PositionControlTest, ATargetBeyondALimitIsLimitedAndSaysSo) {
  Bench bench(ControlMode::position);
  Eigen::VectorXd target = bent();
  target[3] = 5.0;
  const ArmTick tick = bench.repeat(makePosition(target), 2500);
  EXPECT_EQ(tick.applied.reason, "position of joint_4 limited to 2.0944 rad");
  EXPECT_DOUBLE_EQ(tick.applied.command[3], describeDemoArm().joints[3].upper);
  EXPECT_NEAR(tick.truth.q[3], 2.0944 - 0.01, 2e-3) << "at rest a margin before the limit";
}

TEST(PositionControlTest, OneMessageIsEnoughForALongWay) {
  Bench bench(ControlMode::position);
  Eigen::VectorXd target = bent();
  target[0] = 2.5;
  bench.tick({makePosition(target)});
  const ArmTick there = bench.wait(4000);
  EXPECT_EQ(there.applied.reason, "");
  EXPECT_LT((there.truth.q - target).cwiseAbs().maxCoeff(), kAtRest);
  EXPECT_LT(there.truth.dq.cwiseAbs().maxCoeff(), 1e-3) << "and it stays there";
}

TEST(PositionControlTest, WhenTheCommandsOfAMovingTargetStopItBrakesAndStays) {
  Bench bench(ControlMode::position);
  ArmCommand command = makePosition(bent());
  command.rates = Eigen::VectorXd::Zero(7);
  command.rates[0] = 1.0;
  for (int k = 0; k < 600; ++k) {
    command.values[0] = bent()[0] + k * kTick;
    bench.tick({command});
  }
  const ArmTick running = bench.wait(500);
  EXPECT_GT(running.truth.dq[0], 0.5) << "the last command is in force for the timeout";
  const ArmTick braked = bench.wait(300);
  EXPECT_EQ(braked.applied.reason.rfind("no command for 0.5 s", 0), 0U) << braked.applied.reason;
  EXPECT_LT(braked.truth.dq.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT(braked.truth.q[0], 2.0);
  EXPECT_EQ(braked.applied.command, braked.truth.q);
}

TEST(TrajectoryTest, APathFromRestToRestIsFollowed) {
  Bench bench(ControlMode::trajectory);
  const Eigen::VectorXd end = bent() + Eigen::VectorXd::Constant(7, 0.4);
  ArmTick tick = bench.tick({makePath({makeRest(1.0, end)})});
  EXPECT_EQ(tick.applied.reason, "");
  double worst = 0.0;
  for (int k = 1; k <= 1000; ++k) {
    const double s = k * kTick;
    const double share = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));  // the quintic from rest to rest
    tick = bench.tick();
    const Eigen::VectorXd meant = bent() + share * (end - bent());
    ASSERT_LT((tick.applied.command - meant).cwiseAbs().maxCoeff(), 1e-9) << "tick " << k;
    worst = std::max(worst, (tick.truth.q - meant).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 2e-3);
  tick = bench.wait(2000);
  EXPECT_EQ(tick.applied.command, end) << "long after the last message it holds the end";
  EXPECT_LT((tick.truth.q - end).cwiseAbs().maxCoeff(), kAtRest);
  EXPECT_EQ(tick.applied.reason, "");
}

TEST(TrajectoryTest, VelocitiesAtThePointsMakeCubics) {
  Bench bench(ControlMode::trajectory);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(7);
  const Eigen::VectorXd middle = bent() + Eigen::VectorXd::Constant(7, 0.2);
  const Eigen::VectorXd end = bent() + Eigen::VectorXd::Constant(7, 0.4);
  bench.tick({makePath({{1.0, middle, Eigen::VectorXd::Constant(7, 0.3), {}}, {2.0, end, none, {}}})});
  // Hermite's cubic halfway: (q₀ + q₁)/2 + T (v₀ − v₁)/8
  const ArmTick first = bench.wait(500);
  EXPECT_NEAR(first.applied.command[0] - bent()[0], 0.1 + (0.0 - 0.3) / 8.0, 1e-9);
  const ArmTick second = bench.wait(1000);
  EXPECT_NEAR(second.applied.command[0] - bent()[0], 0.3 + (0.3 - 0.0) / 8.0, 1e-9);
}

TEST(TrajectoryTest, PositionsAloneMakeStraightSegments) {
  Bench bench(ControlMode::trajectory);
  bench.tick({makePath({makePoint(1.0, bent() + Eigen::VectorXd::Constant(7, 0.2))})});
  EXPECT_NEAR(bench.wait(250).applied.command[2] - bent()[2], 0.05, 1e-9);
  EXPECT_LT(bench.hardest, 3.0 * kAcceleration) << "corners are rounded";
}

TEST(TrajectoryTest, ANewPathReplacesTheOldOneFromItsStartOn) {
  Bench bench(ControlMode::trajectory);
  bench.tick({makePath({makeRest(2.0, bent() + Eigen::VectorXd::Constant(7, 0.5))})});
  bench.wait(700);
  ArmCommand later = makePath({makeRest(1.5, bent())});
  later.stamp = bench.now + 301 * kMillisecond;
  const ArmTick waiting = bench.tick({later});
  EXPECT_EQ(waiting.applied.reason, "");
  const double before = bench.wait(299).applied.command[0];
  const ArmTick at = bench.tick();
  EXPECT_NEAR(at.applied.command[0], before, 2e-3) << "no jump";
  EXPECT_LT((bench.wait(2500).truth.q - bent()).cwiseAbs().maxCoeff(), kAtRest);
}

TEST(TrajectoryTest, AnEmptyPathStopsTheArm) {
  Bench bench(ControlMode::trajectory);
  bench.tick({makePath({makeRest(1.0, bent() + Eigen::VectorXd::Constant(7, 0.4))})});
  bench.wait(500);
  bench.tick({makePath({})});
  const ArmTick tick = bench.wait(300);
  EXPECT_EQ(tick.applied.reason, "stopped by an empty path");
  EXPECT_LT(tick.truth.dq.cwiseAbs().maxCoeff(), 0.01);
}

TEST(TrajectoryTest, WhatTheArmCannotFollowIsRefusedAndTheOldPathGoesOn) {
  Bench bench(ControlMode::trajectory);
  const Eigen::VectorXd end = bent() + Eigen::VectorXd::Constant(7, 0.2);
  bench.tick({makePath({makeRest(1.0, end)})});
  const auto refusalOf = [&](const ArmCommand& command) { return bench.tick({command}).applied.reason; };
  Eigen::VectorXd far = bent();
  far[3] = 2.5;
  EXPECT_EQ(refusalOf(makePath({makePoint(9.0, far)})).rfind("refused: joint_4 would be at 2.", 0), 0U);
  EXPECT_NE(refusalOf(makePath({makePoint(9.0, far)})).find("expected from -2.0944 to 2.0944 rad"), std::string::npos);
  far[3] = bent()[3] - 2.0;
  EXPECT_NE(refusalOf(makePath({makePoint(0.1, far)})).find("joint_4 would move at -"), std::string::npos);
  EXPECT_NE(refusalOf(makePath({makePoint(0.1, far)})).find("give it more time"), std::string::npos);
  EXPECT_NE(refusalOf(makePath({makeRest(0.3, bent() + Eigen::VectorXd::Constant(7, 0.3))})).find("would accelerate"),
            std::string::npos);
  EXPECT_NE(refusalOf(makePath({makePoint(0.0, far)})).find("the path starts with joint_4 at"), std::string::npos);
  EXPECT_EQ(refusalOf(makePath({makePoint(1.0, end), makePoint(1.0, end)})),
            "refused: point 2 of the path is at 1 s, expected later than the 1 s of the one before");
  EXPECT_EQ(refusalOf(makePath({makePoint(-1.0, end)})),
            "refused: point 1 of the path is at -1 s, expected from 0 to 3600 s");
  EXPECT_EQ(refusalOf(makePath({makePoint(1.0, Eigen::Vector2d(0.0, 0.0))})),
            "refused: point 1 of a path has 2 values, expected 7, one for each joint");
  Eigen::VectorXd not_a_number = end;
  not_a_number[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusalOf(makePath({makePoint(1.0, not_a_number)})),
            "refused: joint_2 in point 1 of a path is nan rad, expected at most 1e+06 rad either way");
  ArmCommand past = makePath({makePoint(1.0, end)});
  bench.wait(2000);
  past.stamp = kMillisecond;
  EXPECT_EQ(refusalOf(past).rfind("refused: the path ended 1.", 0), 0U);
  ArmCommand future = makePath({makePoint(1.0, end)});
  future.stamp = bench.now + 100 * kNanosecondsPerSecond + kMillisecond;
  EXPECT_EQ(refusalOf(future), "refused: a path would start in 100 s, expected within 60 s; do the clocks differ?");
  ArmCommand partly = makePath({makePoint(1.0, end)});
  partly.names = {"joint_1"};
  EXPECT_EQ(refusalOf(partly), "refused: the command names 1 joints, expected all 7");

  EXPECT_EQ(bench.arm.controller().refusedCommands(), 13U);
  EXPECT_LT((bench.wait(1500).truth.q - end).cwiseAbs().maxCoeff(), kAtRest);
}

TEST(TrajectoryTest, AfterAChangeOfModeItBrakesAndForgetsThePath) {
  Bench bench(ControlMode::trajectory);
  bench.tick({makePath({makeRest(1.0, bent() + Eigen::VectorXd::Constant(7, 0.4))})});
  bench.wait(500);
  bench.arm.setMode(ControlMode::velocity);
  bench.wait(300);
  bench.arm.setMode(ControlMode::trajectory);
  const ArmTick tick = bench.tick();
  EXPECT_EQ(tick.applied.reason, "no command yet since mode trajectory was chosen");
  EXPECT_LT(tick.truth.dq.cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace demo_logger
