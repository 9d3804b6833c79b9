#include "demo_logger/simulation/simulated_hand.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "test/simulation/guided_arm.h"

namespace demo_logger {
namespace {

/// What the hand does each millisecond with a tool that stays where it is, perhaps off by `shift` and `twist`.
std::vector<HandAction> actions(const SimulatedHandConfiguration& configuration, const SeenTool& tool = {}) {
  SimulatedHand hand(configuration);
  std::vector<HandAction> result;
  for (int k = 0; !hand.finished(); ++k) result.push_back(hand.act(k * kMillisecond, tool));
  return result;
}

SimulatedHandConfiguration steadyHand() {
  SimulatedHandConfiguration configuration;
  configuration.tremor = 0.0;
  return configuration;
}

/// A task of hardly any movement, so that the tool may stay while it is held.
SimulatedHandConfiguration restingHand() {
  SimulatedHandConfiguration configuration = steadyHand();
  configuration.task = {{{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 3.0}}, 0.0};
  return configuration;
}

TEST(SimulatedHandTest, TheSameSeedGivesTheSameWrenchesBitForBit) {
  SimulatedHandConfiguration configuration;
  const std::vector<HandAction> first = actions(configuration);
  const std::vector<HandAction> again = actions(configuration);
  configuration.seed = 2;
  const std::vector<HandAction> other = actions(configuration);
  ASSERT_EQ(first.size(), again.size());
  bool same_as_other = first.size() == other.size();
  for (std::size_t k = 0; k < first.size(); ++k) {
    ASSERT_EQ(first[k].wrench.force, again[k].wrench.force);
    ASSERT_EQ(first[k].wrench.torque, again[k].wrench.torque);
    same_as_other = same_as_other && first[k].wrench.force == other[k].wrench.force;
  }
  EXPECT_FALSE(same_as_other);
}

TEST(SimulatedHandTest, DependsOnTheTimeNotOnHowOftenItIsAsked) {
  SimulatedHand often((SimulatedHandConfiguration()));
  SimulatedHand seldom((SimulatedHandConfiguration()));
  for (int k = 0; k < 2000; ++k) {
    const HandAction action = often.act(k * kMillisecond, {});
    if (k % 10 != 0) continue;
    EXPECT_EQ(action.wrench.force, seldom.act(k * kMillisecond, {}).wrench.force);
  }
}

TEST(SimulatedHandTest, PressesStartGraspsLetsGoAndPressesStop) {
  const std::vector<HandAction> all = actions(steadyHand());
  enum Phase { before, started, held, released, stopped };
  Phase phase = before;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].start_pressed) {
      EXPECT_LE(phase, started);
      phase = started;
    }
    if (all[k].holds) {
      EXPECT_TRUE(phase == started || phase == held) << k;
      phase = held;
    } else {
      EXPECT_EQ(all[k].wrench.force.norm() + all[k].wrench.torque.norm(), 0.0) << "hands off at " << k << " ms";
      if (phase == held) phase = released;
    }
    if (all[k].stop_pressed) {
      EXPECT_GE(phase, released);
      phase = stopped;
    }
  }
  EXPECT_EQ(phase, stopped);
  EXPECT_NEAR(static_cast<double>(all.size()) / 1000.0, SimulatedHand(steadyHand()).duration(), 0.002);
}

TEST(SimulatedHandTest, HoldsTheToolWithASpringAndADamper) {
  // Pushed off by a centimetre and a tenth of a radian while the hand wants it to rest, way-points being scattered by
  // up to a centimetre: so only the difference that the push makes is known.
  SimulatedHand calm(restingHand());
  SimulatedHand pushed(restingHand());
  SeenTool there;
  there.X_base_tool.translation() << 0.5, 0.1, 0.4;
  SeenTool off = there;
  off.X_base_tool.translation().x() += 0.01;
  off.X_base_tool.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  off.twist << 0.0, 0.2, 0.0, 0.0, 0.0, 0.5;
  for (int k = 0; k < 1300; ++k) {
    calm.act(k * kMillisecond, there);
    pushed.act(k * kMillisecond, there);
  }
  const TipWrench before = calm.act(1300 * kMillisecond, there).wrench;
  const TipWrench after = pushed.act(1300 * kMillisecond, off).wrench;
  EXPECT_TRUE((after.force - before.force).isApprox(Eigen::Vector3d(-500.0 * 0.01, -40.0 * 0.2, 0.0), 1e-9));
  EXPECT_TRUE((after.torque - before.torque).isApprox(Eigen::Vector3d(0.0, 0.0, -12.0 * 0.1 - 0.15 * 0.5), 1e-9));
}

TEST(SimulatedHandTest, GraspsAndLetsGoGently) {
  // Against a tool that slides at 0.1 m/s the damper alone pulls with 4 N once the grip is closed, and half of it when
  // it is half closed.
  SeenTool sliding;
  sliding.twist[0] = 0.1;
  const std::vector<HandAction> all = actions(restingHand(), sliding);
  EXPECT_DOUBLE_EQ(all[1000].wrench.force.x(), 0.0);
  EXPECT_NEAR(all[1125].wrench.force.x(), -2.0, 1e-9);
  EXPECT_NEAR(all[1250].wrench.force.x(), -4.0, 1e-9);
  double largest_step = 0.0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    largest_step = std::max(largest_step, (all[k].wrench.force - all[k - 1].wrench.force).norm());
  }
  // 15/8 of the mean slope of the release, whose force is 4 N and what a centimetre of scatter on each axis adds.
  EXPECT_LT(largest_step, 15.0 / 8.0 * (4.0 + 500.0 * 0.01 * std::sqrt(3.0)) / 120.0);
}

/// Power of a signal of 1 kHz at `frequency` [Hz], seen through Hann's window, which does not smear it.
double power(const std::vector<double>& signal, double frequency) {
  double in_phase = 0.0;
  double quadrature = 0.0;
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const double angle = 2.0 * M_PI * frequency * static_cast<double>(k) / 1000.0;
    const double window = 1.0 - std::cos(2.0 * M_PI * static_cast<double>(k) / static_cast<double>(signal.size()));
    in_phase += window * signal[k] * std::cos(angle);
    quadrature += window * signal[k] * std::sin(angle);
  }
  return (in_phase * in_phase + quadrature * quadrature) / static_cast<double>(signal.size() * signal.size());
}

TEST(SimulatedHandTest, TremblesBetweenSevenAndElevenHertz) {
  SimulatedHandConfiguration configuration = restingHand();
  const std::vector<HandAction> steady = actions(configuration);
  configuration.tremor = 0.3;
  const std::vector<HandAction> trembling = actions(configuration);
  std::vector<double> difference;
  double largest = 0.0;
  for (std::size_t k = 1500; k < 3500; ++k) {
    difference.push_back(trembling[k].wrench.force.y() - steady[k].wrench.force.y());
    largest = std::max(largest, std::abs(difference.back()));
  }
  EXPECT_LE(largest, 0.3);
  EXPECT_GT(largest, 0.1);
  double inside = 0.0;
  double outside = 0.0;
  for (int half = 1; half < 60; ++half) {
    const double frequency = 0.5 * half;
    (frequency > 6.0 && frequency < 12.0 ? inside : outside) += power(difference, frequency);
  }
  EXPECT_LT(outside, 0.02 * inside);
}

struct Course {
  std::vector<Eigen::Vector3d> path;
  double largest_force = 0.0;
  double fastest = 0.0;  // [rad/s] of any joint
  bool interfered = false;
};

Course guideDemoArm(const std::string& task, ControlMode mode, int delay, bool friction = true) {
  RobotDescription robot = describeDemoArm();
  for (ArmJoint& joint : robot.joints) {
    if (!friction) joint.damping = joint.friction = 0.0;
  }
  SimulatedArm arm(robot, makeArmConfiguration(mode));
  SimulatedHandConfiguration configuration;
  configuration.task = handTask(task);
  SimulatedHand hand(configuration);
  Course course;
  guide(arm, hand, 2, delay, [&](const GuidedTick& tick) {
    course.path.push_back(tick.X_base_tool.translation());
    course.largest_force = std::max(course.largest_force, tick.hand.wrench.force.norm());
    course.fastest = std::max(course.fastest, tick.arm.truth.dq.cwiseAbs().maxCoeff());
    course.interfered = course.interfered || !tick.arm.applied.reason.empty();
  });
  EXPECT_FALSE(hand.slipped()) << task << " " << toString(mode) << " " << delay << " ms";
  return course;
}

TEST(SimulatedHandTest, GuidesTheCompliantArmThroughEachTask) {
  for (const std::string& task : handTaskNames()) {
    const Course course = guideDemoArm(task, ControlMode::gravity_compensation, /*delay=*/1);
    EXPECT_GT(course.largest_force, 5.0) << "[N] " << task;
    EXPECT_LT(course.largest_force, 40.0) << "[N]";
    EXPECT_FALSE(course.interfered) << "no limit is reached";
    if (task == "arc") continue;  // which passes its way-points by
    for (const Waypoint& waypoint : handTask(task).waypoints) {
      const Eigen::Vector3d goal = course.path.front() + waypoint.shift;
      double nearest = 1.0;
      for (const Eigen::Vector3d& position : course.path) nearest = std::min(nearest, (position - goal).norm());
      // A centimetre of scatter on each axis, and what the friction of the arm stretches the spring.
      EXPECT_LT(nearest, 0.0173 + course.largest_force / 500.0) << task << ", [m] to " << waypoint.shift.transpose();
    }
  }
}

TEST(SimulatedHandTest, StaysCalmWithTheDelayOfABusyMachine) {
  for (const std::string& task : handTaskNames()) {
    for (const ControlMode mode : {ControlMode::gravity_compensation, ControlMode::impedance}) {
      const Course prompt = guideDemoArm(task, mode, 1);
      const Course late = guideDemoArm(task, mode, 12);
      EXPECT_LT(late.largest_force, 1.2 * prompt.largest_force) << task << " " << toString(mode);
      EXPECT_LT(late.fastest, 1.3 * prompt.fastest) << task << " " << toString(mode);
      EXPECT_FALSE(late.interfered);
    }
    const Course frictionless = guideDemoArm(task, ControlMode::impedance, 1, /*friction=*/false);
    const Course late_frictionless = guideDemoArm(task, ControlMode::impedance, 6, /*friction=*/false);
    EXPECT_LT(late_frictionless.fastest, 1.3 * frictionless.fastest) << task;
  }
}

TEST(SimulatedHandTest, LetsGoOfAToolThatFlingsAbout) {
  SimulatedArm arm = makeDemoArm(ControlMode::gravity_compensation);
  SimulatedHand hand((SimulatedHandConfiguration()));
  ArmTick last;
  double strongest_late = 0.0;
  bool stop_pressed = false;
  guide(arm, hand, 2, /*delay=*/60, [&](const GuidedTick& tick) {
    last = tick.arm;
    stop_pressed = stop_pressed || tick.hand.stop_pressed;
    if (stop_pressed) strongest_late = std::max(strongest_late, tick.arm.external_torque.norm());
  });
  EXPECT_TRUE(hand.slipped());
  EXPECT_TRUE(stop_pressed) << "the recording is closed all the same";
  EXPECT_EQ(strongest_late, 0.0);
  EXPECT_LT(last.truth.dq.norm(), 0.5) << "[rad/s], friction has brought the arm to rest";
}

TEST(SimulatedHandTest, TheTrueTorqueOfATickIsTheJacobianTransposeOfItsWrench) {
  SimulatedArm arm = makeDemoArm(ControlMode::gravity_compensation);
  SimulatedHand hand((SimulatedHandConfiguration()));
  const RobotModel model(describeDemoArm());
  TipWrench sent;
  Eigen::Matrix3d R_base_tool_then = Eigen::Matrix3d::Identity();
  double largest = 0.0;
  guide(arm, hand, 1, /*delay=*/1, [&](const GuidedTick& tick) {
    // What was sent at the tick before acts now, and has turned with the tool since.
    const Eigen::Matrix3d turned = tick.X_base_tool.linear() * R_base_tool_then.transpose();
    Eigen::VectorXd wrench(6);
    wrench << turned * sent.force, turned * sent.torque;
    const Eigen::VectorXd expected = model.jacobian(tick.arm.truth.q).transpose() * wrench;
    ASSERT_LT((tick.arm.external_torque - expected).cwiseAbs().maxCoeff(), 1e-10);
    largest = std::max(largest, expected.cwiseAbs().maxCoeff());
    sent = tick.hand.wrench;
    R_base_tool_then = tick.X_base_tool.linear();
  });
  EXPECT_GT(largest, 2.0) << "[N m]";
}

std::string messageOf(const SimulatedHandConfiguration& configuration) {
  try {
    SimulatedHand hand(configuration);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "taken";
}

TEST(SimulatedHandTest, WhatNoHandIsIsRefused) {
  SimulatedHandConfiguration configuration;
  configuration.damping = 2.0;
  EXPECT_EQ(messageOf(configuration),
            "simulated hand: damping is 2 N s/m, expected from 5 to 1000 N s/m with a stiffness of 500, or a hand that "
            "sees the arm 10 ms late would swing up.");
  configuration = {};
  configuration.grasp_ramp = 0.0;
  EXPECT_EQ(messageOf(configuration), "simulated hand: grasp_ramp is 0 s, expected above 0, at most 10 s.");
  configuration = {};
  configuration.tremor = NAN;
  EXPECT_EQ(messageOf(configuration), "simulated hand: tremor is nan N, expected from 0 to 20 N.");
  try {
    handTask("juggle");
    FAIL() << "taken";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "simulated hand: task \"juggle\" is not known, expected one of reach, arc, peg.");
  }
}

}  // namespace
}  // namespace demo_logger
