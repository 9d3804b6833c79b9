#include "demo_logger/pipelines/human_torque_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "demo_logger/pipelines/human_torque_columns.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/counted_allocations.h"

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kControlPeriod = 0.001;

RobotDescription arm() {
  return describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf", {"base_link", "tool_tip", {}, 9.81});
}

Eigen::VectorXd both(double first, double second) { return Eigen::Vector2d(first, second); }

/// A motion in closed form, of about 0.4 Hz and 1 rad/s.
struct Motion {
  Eigen::VectorXd q, dq, ddq;
};
Motion motionAt(double t) {
  const double w = 2.0 * kPi * 0.4;
  const double v = 2.0 * kPi * 0.3;
  return {both(0.4 * std::sin(w * t), 0.5 * std::cos(v * t)),
          both(0.4 * w * std::cos(w * t), -0.5 * v * std::sin(v * t)),
          both(-0.4 * w * w * std::sin(w * t), -0.5 * v * v * std::cos(v * t))};
}

/// Slow enough for the observer to be late by its delay and nothing else: (2 π 0.3 s⁻¹ · 27 ms)² / 2 is 0.13 %.
Eigen::VectorXd handAt(double t) {
  return both(5.0 * std::sin(2.0 * kPi * 0.3 * t), 2.0 + std::cos(2.0 * kPi * 0.2 * t));
}

struct Case {
  RobotDescription robot = arm();
  ModelCalibration calibration;
  HumanTorqueObserverConfiguration configuration;
  double rate = 1000.0;
};

CalibratedArm calibrated(const Case& one) { return calibrate(one.robot, one.calibration); }

/// The torque that the motors gave, or a sensor at the links saw, at `t`.
Eigen::VectorXd effortAt(const RobotModel& model, const EffortMetadata& effort, double t) {
  const double instant = effort.timing == "held" ? t + 0.5 * effort.control_period : t;
  const Motion motion = motionAt(instant);
  Eigen::VectorXd torque = (effort.side == "link" ? model.inverseDynamics(motion.q, motion.dq, motion.ddq)
                                                  : model.motorTorque(motion.q, motion.dq, motion.ddq)) -
                           handAt(instant);
  if (!effort.includes_gravity) torque -= model.gravity(motion.q);
  return torque;
}

/// The largest difference over 4 s, in percent of 5 N m, between what is observed and the hand's torque `delay` before.
double errorOf(const Case& one, double delay) {
  const RobotModel model(one.robot);
  HumanTorqueObserver observer(calibrated(one), one.configuration);
  Eigen::VectorXd torque(2);
  double largest = 0.0;
  int known = 0;
  for (int k = 0; k < 4 * static_cast<int>(one.rate); ++k) {
    const double t = 1.0 + k / one.rate;
    if (!observer.update(fromSeconds(t), motionAt(t).q, effortAt(model, one.configuration.effort, t), torque)) continue;
    if (++known * 1.0 / one.rate < 0.3) continue;  // what is left of the beginning: e^(−0.4 s · 50 / s)
    largest = std::max(largest, (torque - handAt(t - delay)).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(known, 0.9 * 4 * one.rate);
  return 100.0 * largest / 5.0;
}

EffortMetadata effort(const std::string& side, const std::string& timing, bool includes_gravity = true) {
  EffortMetadata meaning;
  meaning.side = side;
  meaning.timing = timing;
  meaning.includes_gravity = includes_gravity;
  meaning.control_period = kControlPeriod;
  return meaning;
}

TEST(HumanTorqueObserverTest, IsLateByTheDelayItStatesAndElseRight) {
  Case one;
  one.configuration.effort = effort("motor", "held");
  const HumanTorqueObserver observer(calibrated(one), one.configuration);
  EXPECT_NEAR(observer.delay(), 1.0 / 50.0 + std::sqrt(2.0) / (2.0 * kPi * 30.0), 1e-12);
  EXPECT_LT(errorOf(one, observer.delay()), 0.5);
  EXPECT_GT(errorOf(one, 0.0), 4.0) << "5 N m at 0.3 Hz, 27 ms late";
}

TEST(HumanTorqueObserverTest, WhatTheEffortsMeanIsHeeded) {
  for (const char* side : {"motor", "link"}) {
    for (const char* timing : {"held", "instant"}) {
      for (const bool includes_gravity : {true, false}) {
        Case one;
        one.robot = withDrives(arm(), {{"joint_1", {0.8, 0.7, 0.0, {}}}, {"joint_2", {0.3, 0.4, 0.0, {}}}});
        one.configuration.effort = effort(side, timing, includes_gravity);
        const HumanTorqueObserver observer(calibrated(one), one.configuration);
        EXPECT_LT(errorOf(one, observer.delay()), 0.6) << side << " " << timing << " " << includes_gravity;
      }
    }
  }
}

TEST(HumanTorqueObserverTest, WhatACalibrationFoundOfTheArmIsNotTheHands) {
  // The real arm has a tool of 0.3 kg more, friction and a torque reading that is off; the observer is told by a file.
  for (const char* side : {"motor", "link"}) {
    Case one;
    one.configuration.effort = effort(side, "held");
    one.calibration.side = side;
    one.calibration.payload.emplace();
    one.calibration.payload->mass = {0.3, 0.01};
    one.calibration.payload->center[2] = {0.05, 0.01};
    one.calibration.joints["joint_2"].damping = CalibratedValue{0.8, 0.0};
    one.calibration.joints["joint_1"].torque_bias = CalibratedValue{0.5, 0.0};
    const CalibratedArm real = calibrated(one);
    const RobotModel model(real.seenAt(side));
    HumanTorqueObserver observer(real, one.configuration);
    Eigen::VectorXd torque(2);
    double largest = 0.0;
    for (int k = 0; k < 2000; ++k) {
      const double t = k / 1000.0;
      const Motion motion = motionAt(t + 0.5 * kControlPeriod);
      const Eigen::VectorXd reading =
          model.motorTorque(motion.q, motion.dq, motion.ddq) - handAt(t + 0.5 * kControlPeriod) + both(0.5, 0.0);
      if (!observer.update(fromSeconds(t), motionAt(t).q, reading, torque) || k < 400) continue;
      largest = std::max(largest, (torque - handAt(t - observer.delay())).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(largest, 0.03) << side;
  }
}

TEST(HumanTorqueObserverTest, AHeldTorqueThatIsTakenForAnInstantOneCostsHalfAPeriod) {
  // Ten times the period, so that the difference shows: 5 ms of a torque that moves by some 10 N m/s.
  Case right;
  right.configuration.effort = effort("motor", "held");
  right.configuration.effort.control_period = 0.01;
  right.configuration.cutoff = 20.0;
  right.rate = 100.0;
  Case wrong = right;
  const double delay = HumanTorqueObserver(calibrated(right), right.configuration).delay();
  const RobotModel model(right.robot);
  EXPECT_LT(errorOf(right, delay), 0.8);
  // The same recording, read with the wrong rule.
  HumanTorqueObserverConfiguration misread = right.configuration;
  misread.effort.timing = "instant";
  HumanTorqueObserver observer(calibrated(right), misread);
  Eigen::VectorXd torque(2);
  double largest = 0.0;
  for (int k = 0; k < 400; ++k) {
    const double t = 1.0 + k / 100.0;
    const bool known =
        observer.update(fromSeconds(t), motionAt(t).q, effortAt(model, right.configuration.effort, t), torque);
    if (known && k > 80) largest = std::max(largest, (torque - handAt(t - delay)).cwiseAbs().maxCoeff());
  }
  EXPECT_GT(100.0 * largest / 5.0, 1.5);
}

TEST(HumanTorqueObserverTest, ASlowLogOfAFastControllerReadsTheTorqueBetweenItsStamps) {
  Case one;
  one.configuration.effort = effort("motor", "held");
  one.configuration.cutoff = 20.0;
  one.rate = 100.0;
  EXPECT_LT(errorOf(one, HumanTorqueObserver(calibrated(one), one.configuration).delay()), 0.8);
}

TEST(HumanTorqueObserverTest, UnderGravityCompensationNoEffortIsNeeded) {
  Case one;
  one.configuration.effort = effort("motor", "held");
  one.configuration.gravity_compensated = true;
  one.robot = withDrives(arm(), {{"joint_1", {0.0, 0.0, 0.0, {}}}, {"joint_2", {0.0, 0.0, 0.0, {}}}});
  const RobotModel model(one.robot);
  HumanTorqueObserver observer(calibrated(one), one.configuration);
  Eigen::VectorXd torque(2);
  double largest = 0.0;
  for (int k = 0; k < 4000; ++k) {  // the hand alone moves the arm: τ_h = M q̈ + C q̇
    const double t = k / 1000.0;
    if (!observer.update(fromSeconds(t), motionAt(t).q, both(kNaN, kNaN), torque) || k < 400) continue;
    const Motion before = motionAt(t - observer.delay());
    const Eigen::VectorXd hand = model.inverseDynamics(before.q, before.dq, before.ddq) - model.gravity(before.q);
    largest = std::max(largest, (torque - hand).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(largest, 0.02) << "of about 3 N m";
}

TEST(HumanTorqueObserverTest, AnArmThatIsAlreadyMovingWhenItBeginsIsNotMistakenForAHand) {
  Case one;
  one.configuration.effort = effort("motor", "held");
  const RobotModel model(one.robot);
  HumanTorqueObserver observer(calibrated(one), one.configuration);
  Eigen::VectorXd torque(2);
  int k = 0;
  while (!observer.update(fromSeconds(k / 1000.0), motionAt(k / 1000.0).q,
                          effortAt(model, one.configuration.effort, k / 1000.0), torque)) {
    ASSERT_LT(++k, 200);
  }
  EXPECT_NEAR(k, 101, 1) << "5 / K_o after the first velocity";
  const double t = k / 1000.0;
  // The momentum of 1 rad/s would show as 50/s · 2 kg m²/s · e⁻⁵ = 0.7 N m.
  EXPECT_LT((torque - handAt(t - observer.delay())).cwiseAbs().maxCoeff(), 0.1);
}

TEST(HumanTorqueObserverTest, AGapAMissingValueOrAClockThatGoesBackBeginItAnew) {
  Case one;
  one.configuration.effort = effort("motor", "held");
  HumanTorqueObserver observer(calibrated(one), one.configuration);
  const RobotModel model(one.robot);
  const Eigen::VectorXd rest = both(0.1, 0.2);
  const Eigen::VectorXd holding = model.gravity(rest);
  Eigen::VectorXd torque(2);
  Nanoseconds stamp = 1'000'000'000;
  const auto run = [&](int samples) {
    bool known = false;
    for (int k = 0; k < samples; ++k) known = observer.update(stamp += 1'000'000, rest, holding, torque);
    return known;
  };
  EXPECT_FALSE(run(101));
  EXPECT_TRUE(run(2));
  const std::vector<std::function<bool()>> faults = {
      [&] { return observer.update(stamp += 1'000'000, both(kNaN, 0.2), holding, torque); },
      [&] { return observer.update(stamp += 1'000'000, rest, both(0.0, kNaN), torque); },
      [&] { return observer.update(stamp += 9'000'000, rest, holding, torque); },
      [&] { return observer.update(stamp -= 5'000'000'000, rest, holding, torque); },
      [&] { return observer.update(stamp, rest, holding, torque); },
      [&] { return observer.update(stamp += 1'000'000, rest, both(1e308, 0.0), torque); },
  };
  for (const auto& fault : faults) {
    EXPECT_FALSE(fault());
    EXPECT_TRUE(std::isnan(torque[0]));
    EXPECT_FALSE(run(99));
    EXPECT_TRUE(run(4)) << "5 / K_o, and two samples for a velocity";
    EXPECT_NEAR(torque[0], 0.0, 1e-9);
  }
}

TEST(HumanTorqueObserverTest, APositionThatJumpsAndReturnsIsNoMotion) {
  Case one;
  one.configuration.effort = effort("motor", "held");
  const RobotModel model(one.robot);
  for (const double jump : {0.3, 1e6, 1e300}) {
    HumanTorqueObserver observer(calibrated(one), one.configuration);
    const Eigen::VectorXd rest = both(0.1, 0.2);
    const Eigen::VectorXd holding = model.gravity(rest);
    Eigen::VectorXd torque(2);
    int known = 0;
    for (int k = 0; k < 400; ++k) {
      const Eigen::VectorXd q = k == 200 ? both(0.1 + jump, 0.2) : rest;
      if (!observer.update(1'000'000 * k, q, holding, torque)) continue;
      ++known;
      EXPECT_NEAR(torque.cwiseAbs().maxCoeff(), 0.0, 1e-9) << k << " " << jump;
    }
    EXPECT_NEAR(known, 400 - 2 * 102, 3);
  }
}

TEST(HumanTorqueObserverTest, ASampleAllocatesNothing) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "a sanitizer's malloc is not counted";
  Case one;
  one.configuration.effort = effort("motor", "held");
  HumanTorqueObserver observer(calibrated(one), one.configuration);
  Eigen::VectorXd torque(2);
  Eigen::VectorXd q = both(0.0, 0.0);
  const Eigen::VectorXd motors = both(1.0, 2.0);
  const std::size_t before = allocation_count;
  for (int k = 0; k < 500; ++k) {
    q[0] = 0.001 * k;
    observer.update(1'000'000 * k, q, motors, torque);
  }
  EXPECT_EQ(allocation_count, before);
}

TEST(HumanTorqueObserverTest, SettingsThatMakeNoSenseAreNamed) {
  const auto refusal = [](double gain, double cutoff, const EffortMetadata& meaning) {
    HumanTorqueObserverConfiguration configuration;
    configuration.gain = gain;
    configuration.cutoff = cutoff;
    configuration.effort = meaning;
    try {
      validate(configuration);
    } catch (const ConfigurationError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was thrown");
  };
  EXPECT_EQ(refusal(-1.0, 30.0, effort("motor", "held")), "gain is -1 1/s, expected a positive number.");
  EXPECT_EQ(refusal(50.0, kNaN, effort("motor", "held")), "cutoff is nan Hz, expected a positive number.");
  EXPECT_EQ(refusal(50.0, 30.0, effort("gear", "held")), "effort: side is \"gear\", expected motor or link.");
}

// ---- as columns

Column column(const std::string& quantity, const std::string& prefix, const std::string& joint) {
  return {prefix + joint, "", Role::state, Interpolation::linear, "joint_states/" + quantity + "/" + joint};
}

std::vector<Column> recordedColumns() {
  return {column("position", "q_", "joint_1"), column("position", "q_", "joint_2"), column("effort", "tau_", "joint_1"),
          column("effort", "tau_", "joint_2")};
}

Row rowAt(Nanoseconds stamp, const std::vector<double>& values) {
  Row row;
  row.stamp = stamp;
  row.values = values;
  return row;
}

TEST(HumanTorqueColumnsTest, AreTheObserversTorqueForTheRowsPositionsAndEfforts) {
  HumanTorqueObserverConfiguration configuration;
  configuration.effort = effort("motor", "held");
  HumanTorqueColumns columns(calibrated({}), configuration);
  const std::vector<Column> added = columns.open(recordedColumns());
  ASSERT_EQ(added.size(), 2U);
  EXPECT_EQ(added[1].name, "tau_h_joint_2");
  EXPECT_EQ(added[1].unit, "N m");
  EXPECT_EQ(added[1].source, "human torque by momentum observer, 0.0275026 s late");
  HumanTorqueObserver observer(calibrated({}), configuration);
  const RobotModel model(arm());
  Eigen::VectorXd torque(2);
  for (int k = 0; k < 300; ++k) {
    const double t = k / 1000.0;
    const Eigen::VectorXd q = motionAt(t).q;
    const Eigen::VectorXd motors = effortAt(model, configuration.effort, t);
    Row row = rowAt(fromSeconds(t), {q[0], q[1], motors[0], motors[1]});
    columns.append(row);
    ASSERT_EQ(row.values.size(), 6U);
    if (observer.update(fromSeconds(t), q, motors, torque)) {
      EXPECT_EQ(row.values[4], torque[0]);
      EXPECT_EQ(row.values[5], torque[1]);
    } else {
      EXPECT_TRUE(std::isnan(row.values[4]));
    }
  }
  EXPECT_TRUE(columns.faults().empty());
}

TEST(HumanTorqueColumnsTest, SayWhyNothingIsKnown) {
  HumanTorqueObserverConfiguration configuration;
  configuration.effort = effort("motor", "held");
  HumanTorqueColumns columns(calibrated({}), configuration);

  columns.open(recordedColumns());
  for (int k = 0; k < 5; ++k) {
    Row row = rowAt(10'000'000 * k, {0.0, 0.0, 0.0, 0.0});
    columns.append(row);
  }
  ASSERT_EQ(columns.faults().size(), 1U);
  EXPECT_EQ(columns.faults()[0].what,
            "human torque: joint states 0.01 s apart are too rare for the velocity filter, which needs one every "
            "0.00833333 s; tau_h_… begins anew after each. If they always come so, set human_torque/cutoff to "
            "22.7 Hz or less.");
  EXPECT_EQ(columns.faults()[0].count, 4U);
  EXPECT_EQ(columns.faults()[0].stamp, 10'000'000);

  columns.open(recordedColumns());
  Row without_effort = rowAt(5, {0.0, 0.0, 0.0, kNaN});
  columns.append(without_effort);
  ASSERT_EQ(columns.faults().size(), 1U);
  EXPECT_EQ(columns.faults()[0].what,
            "human torque: joint 'joint_2' comes without an effort, so that tau_h_… is not known; if the arm is "
            "compensated for gravity alone, set human_torque/gravity_compensated");

  EXPECT_TRUE(columns.open({column("position", "q_", "joint_1")}).empty());
  Row alone = rowAt(7, {0.0});
  columns.append(alone);
  EXPECT_EQ(alone.values.size(), 1U);
  ASSERT_EQ(columns.faults().size(), 1U);
  EXPECT_EQ(columns.faults()[0].what,
            "human torque: joint 'joint_1' of the arm is not recorded, so there are no columns tau_h_…");
}

std::vector<Column> withWrench(std::vector<Column> columns) {
  for (const char* component : {"fx", "fy", "fz", "tx", "ty", "tz"}) {
    columns.push_back({std::string("ft_") + component, "", Role::auxiliary, Interpolation::hold, ""});
  }
  return columns;
}

TEST(WrenchTorqueColumnsTest, AForceAcrossThePlanarArmTurnsItsJointsByItsLeverArms) {
  WrenchTorqueColumns columns(arm(), "ft");
  const std::vector<Column> added = columns.open(withWrench(recordedColumns()));
  ASSERT_EQ(added.size(), 2U);
  EXPECT_EQ(added[0].name, "ft_tau_joint_1");
  EXPECT_EQ(added[0].source, "torque of ft upon link tool_tip");
  // Links of 0.5 m and 0.4 m along z, joints about y. Upright, 10 N along x at the tip.
  Row upright = rowAt(0, {0.0, 0.0, 0.0, 0.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  columns.append(upright);
  EXPECT_NEAR(upright.values[10], 9.0, 1e-12);
  EXPECT_NEAR(upright.values[11], 4.0, 1e-12);
  // The elbow bent by a right angle: along the tool's own z, that is the base's x, with 0.5 m of lever at the shoulder.
  Row bent = rowAt(1, {0.0, kPi / 2.0, 0.0, 0.0, 0.0, 0.0, 10.0, 0.0, 3.0, 0.0});
  columns.append(bent);
  EXPECT_NEAR(bent.values[10], 5.0 + 3.0, 1e-12);
  EXPECT_NEAR(bent.values[11], 0.0 + 3.0, 1e-12);
  Row silent = rowAt(2, {0.0, 0.0, 0.0, 0.0, kNaN, 0.0, 0.0, 0.0, 0.0, 0.0});
  columns.append(silent);
  EXPECT_TRUE(std::isnan(silent.values[11]));
  EXPECT_TRUE(columns.faults().empty());
}

TEST(WrenchTorqueColumnsTest, AStreamThatIsNoWrenchIsAFault) {
  WrenchTorqueColumns columns(arm(), "ft");
  EXPECT_TRUE(columns.open(recordedColumns()).empty());
  Row row = rowAt(9, {0.0, 0.0, 0.0, 0.0});
  columns.append(row);
  columns.append(row);
  EXPECT_EQ(row.values.size(), 4U);
  ASSERT_EQ(columns.faults().size(), 1U);
  EXPECT_EQ(columns.faults()[0].count, 2U);
  EXPECT_EQ(columns.faults()[0].what,
            "stream ft is not recorded as a wrench, so the torque of ft at the joints is not known; is it a "
            "geometry_msgs/WrenchStamped, and was it published when the episode began?");
}

}  // namespace
}  // namespace demo_logger
