#include "demo_logger/pipelines/human_torque.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kPi = 3.14159265358979323846;
constexpr double kPeriod = 0.001;  // [s] of the arm's controller

RobotDescription demoArm() {
  return describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/demo_arm.urdf", {"base_link", "tool_tip", {}, 9.81});
}

/// The same arm without what its drives lose.
RobotDescription frictionless() {
  RobotDescription arm = demoArm();
  for (ArmJoint& joint : arm.joints) joint.damping = joint.friction = 0.0;
  return arm;
}

/// A taught motion in closed form: each joint swings with two frequencies of its own.
struct Motion {
  Eigen::VectorXd q, dq, ddq;
};
Motion motionAt(double t) {
  Motion motion{Eigen::VectorXd(7), Eigen::VectorXd(7), Eigen::VectorXd(7)};
  for (Index i = 0; i < 7; ++i) {
    const double w1 = 2.0 * kPi * (0.2 + 0.03 * static_cast<double>(i));
    const double w2 = 2.0 * kPi * (0.7 + 0.05 * static_cast<double>(i));
    motion.q[i] = 0.2 * static_cast<double>(i % 3) + 0.4 * std::sin(w1 * t) + 0.08 * std::cos(w2 * t);
    motion.dq[i] = 0.4 * w1 * std::cos(w1 * t) - 0.08 * w2 * std::sin(w2 * t);
    motion.ddq[i] = -0.4 * w1 * w1 * std::sin(w1 * t) - 0.08 * w2 * w2 * std::cos(w2 * t);
  }
  return motion;
}

/// The hand's torque: up to 10 N m at the shoulder, 0.2 N m at the wrist.
Eigen::VectorXd handTorqueAt(double t) {
  Eigen::VectorXd torque(7);
  for (Index i = 0; i < 7; ++i) {
    torque[i] =
        10.0 / (1.0 + static_cast<double>(i * i)) * std::sin(2.0 * kPi * (0.3 + 0.1 * static_cast<double>(i)) * t);
  }
  return torque;
}

struct Teaching {
  double rate = 1000.0;  // [Hz] of the log
  double duration = 4.0;
  double position_noise = 0.0;  // [rad]
  double torque_noise = 0.0;    // [N m]
  bool held = true;
  std::string side = "motor";
  bool with_friction = false;
  double stamp_jitter = 0.0;  // [s]
};

/// What such a recording holds: true positions with noise, and the torques that the arm needs beside the hand's.
Demonstration record(const Teaching& teaching) {
  const RobotDescription arm = teaching.with_friction ? demoArm() : frictionless();
  const RobotModel model(arm);
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  Demonstration demonstration;
  for (const char* prefix : {"q_", "tau_"}) {
    for (const std::string& joint : arm.jointNames()) {
      demonstration.columns.push_back({prefix + joint, "", Role::state, Interpolation::linear, ""});
    }
  }
  const auto motorTorqueAt = [&](double t) {
    const Motion motion = motionAt(t);
    Eigen::VectorXd torque = model.inverseDynamics(motion.q, motion.dq, motion.ddq) - handTorqueAt(t);
    if (teaching.side == "motor") torque += model.friction(motion.dq);
    return torque;
  };
  const auto rows = static_cast<Index>(teaching.duration * teaching.rate);
  demonstration.values.resize(rows, 14);
  for (Index k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) / teaching.rate + teaching.stamp_jitter * normal(random);
    demonstration.time.push_back(t);
    // A torque held over [t, t + h) does what the continuous one does at the middle of that.
    const Eigen::VectorXd torque = motorTorqueAt(teaching.held ? t + 0.5 * kPeriod : t);
    const Eigen::VectorXd q = motionAt(t).q;
    for (Index i = 0; i < 7; ++i) {
      demonstration.values(k, i) = q[i] + teaching.position_noise * normal(random);
      demonstration.values(k, 7 + i) = torque[i] + teaching.torque_noise * normal(random);
    }
  }
  EffortMetadata& effort = demonstration.metadata.effort;
  effort.side = teaching.side;
  effort.timing = teaching.held ? "held" : "instant";
  effort.control_period = kPeriod;
  return demonstration;
}

double value(const Demonstration& demonstration, Index row, const std::string& column) {
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    if (demonstration.columns[i].name == column) return demonstration.values(row, static_cast<Index>(i));
  }
  ADD_FAILURE() << "no column " << column;
  return 0.0;
}

std::string joint(Index i) { return "joint_" + std::to_string(i + 1); }

/// Root mean square over all joints and rows but 0.25 s at either end, in percent of the largest torque.
double errorOf(const Demonstration& demonstration) {
  double squares = 0.0;
  double count = 0.0;
  for (Index k = 0; k < demonstration.values.rows(); ++k) {
    const double t = demonstration.time[static_cast<std::size_t>(k)];
    if (t < 0.25 || t > demonstration.time.back() - 0.25) continue;
    const Eigen::VectorXd truth = handTorqueAt(t);
    for (Index i = 0; i < 7; ++i) {
      squares += std::pow(value(demonstration, k, "tau_h_" + joint(i)) - truth[i], 2);
      count += 1.0;
    }
  }
  return 100.0 * std::sqrt(squares / count) / 10.0;
}

std::string messageOf(const RobotDescription& arm, Demonstration demonstration,
                      const HumanTorqueOptions& options = {}) {
  try {
    addHumanTorque(arm, demonstration, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(HumanTorqueTest, IsRecoveredFromPositionsAndHeldTorquesWithoutNoise) {
  Demonstration demonstration = record({});
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  EXPECT_LT(errorOf(demonstration), 1e-3) << "percent";
  EXPECT_EQ(summary.rows, 4000U);
  EXPECT_TRUE(summary.notes.empty());
  EXPECT_NEAR(value(demonstration, 2000, "dq_joint_3"), motionAt(2.0).dq[2], 1e-6);
  EXPECT_NEAR(value(demonstration, 2000, "ddq_joint_3"), motionAt(2.0).ddq[2], 1e-3);
}

TEST(HumanTorqueTest, TheInstantOfAHeldTorqueFollowsFromTheControlPeriodNotFromTheLogsInterval) {
  Teaching slow;
  slow.rate = 100.0;
  Demonstration demonstration = record(slow);
  addHumanTorque(frictionless(), demonstration);
  const double error = errorOf(demonstration);
  EXPECT_LT(error, 0.02);

  Demonstration naive = record(slow);
  naive.metadata.effort.control_period = 1.0 / slow.rate;
  addHumanTorque(frictionless(), naive);
  EXPECT_GT(errorOf(naive), 9.0 * error) << "half a sample of the log instead";
}

TEST(HumanTorqueTest, AnArmsFrictionIsMotorTorqueThatMovesNothing) {
  Teaching teaching;
  teaching.with_friction = true;
  Demonstration demonstration = record(teaching);
  Demonstration blind = demonstration;
  addHumanTorque(demoArm(), demonstration);
  addHumanTorque(frictionless(), blind);
  EXPECT_LT(errorOf(demonstration), 0.2);
  EXPECT_GT(errorOf(blind), 3.0) << "without a model of it";

  teaching.side = "link";
  teaching.held = false;
  Demonstration at_the_links = record(teaching);
  addHumanTorque(demoArm(), at_the_links);
  EXPECT_LT(errorOf(at_the_links), 0.01) << "a sensor behind the gears sees no friction";
}

TEST(HumanTorqueTest, IsAsSureAsItSays) {
  Teaching noisy;
  noisy.rate = 500.0;
  noisy.position_noise = 1e-4;
  noisy.held = false;
  noisy.torque_noise = 0.03;
  Demonstration demonstration = record(noisy);
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  for (const double noise : summary.encoder_noise) EXPECT_NEAR(noise, 1e-4, 1e-5);
  int within = 0;
  int all = 0;
  double squares = 0.0;
  for (Index k = 0; k < demonstration.values.rows(); ++k) {
    const Eigen::VectorXd truth = handTorqueAt(demonstration.time[static_cast<std::size_t>(k)]);
    for (Index i = 0; i < 7; ++i) {
      const double error =
          (value(demonstration, k, "tau_h_" + joint(i)) - truth[i]) / value(demonstration, k, "tau_h_std_" + joint(i));
      within += std::abs(error) < 2.0 ? 1 : 0;
      ++all;
      squares += error * error;
    }
  }
  EXPECT_GT(within, 0.93 * all);
  EXPECT_GT(std::sqrt(squares / all), 0.6);
  EXPECT_LT(std::sqrt(squares / all), 1.2);
}

TEST(HumanTorqueTest, TrueStampsMakeJitterHarmless) {
  Teaching teaching;
  teaching.position_noise = 2.0 * kPi / 262144.0 / std::sqrt(12.0);
  teaching.held = false;
  Demonstration even = record(teaching);
  teaching.stamp_jitter = 100e-6;
  Demonstration uneven = record(teaching);
  addHumanTorque(frictionless(), even);
  addHumanTorque(frictionless(), uneven);
  EXPECT_LT(errorOf(uneven), 1.1 * errorOf(even));
}

TEST(HumanTorqueTest, TheForceAtTheToolExplainsTheTorquesOfAForceThere) {
  Teaching teaching;
  teaching.duration = 1.0;
  teaching.held = false;
  Demonstration demonstration = record(teaching);
  const RobotModel model(frictionless());
  Eigen::VectorXd wrench(6);
  wrench << 20.0, -5.0, 8.0, 0.5, -0.3, 0.2;
  for (Index k = 0; k < demonstration.values.rows(); ++k) {
    const double t = demonstration.time[static_cast<std::size_t>(k)];
    const Eigen::VectorXd torque = model.jacobian(motionAt(t).q).transpose() * wrench;
    for (Index i = 0; i < 7; ++i) demonstration.values(k, 7 + i) += handTorqueAt(t)[i] - torque[i];
  }
  addHumanTorque(frictionless(), demonstration);
  EXPECT_NEAR(value(demonstration, 500, "tool_fx"), 20.0, 1e-2);
  EXPECT_NEAR(value(demonstration, 500, "tool_fz"), 8.0, 1e-2);
  EXPECT_NEAR(value(demonstration, 500, "tool_ty"), -0.3, 1e-3);
  EXPECT_GT(value(demonstration, 500, "tool_condition"), 1.0);
}

TEST(HumanTorqueTest, WithoutEffortsGravityCompensationMustBeDeclared) {
  Demonstration demonstration = record({});
  demonstration.values.middleCols(7, 7).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(messageOf(frictionless(), demonstration),
            "column `tau_joint_1` holds no efforts of joint 'joint_1', without which the human's torque cannot be told "
            "from the motor's; if the arm was compensated for gravity alone, say so (--gravity-compensated)");
  HumanTorqueOptions options;
  options.gravity_compensated = true;
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration, options);
  EXPECT_EQ(summary.notes.front(),
            "no efforts were recorded: the motors count as compensating gravity, and nothing else");
  const Motion motion = motionAt(2.0);
  const RobotModel model(frictionless());
  const Eigen::VectorXd expected = model.inverseDynamics(motion.q, motion.dq, motion.ddq) - model.gravity(motion.q);
  EXPECT_NEAR(value(demonstration, 2000, "tau_h_joint_2"), expected[1], 1e-3) << "M q̈ + C q̇";
}

TEST(HumanTorqueTest, NothingIsSaidAcrossASilence) {
  Demonstration demonstration = record({});
  for (Index k = 1000; k < 1300; ++k) demonstration.values.row(k).setConstant(std::numeric_limits<double>::quiet_NaN());
  demonstration.values.row(500).head(7).setConstant(std::numeric_limits<double>::quiet_NaN());
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  EXPECT_EQ(summary.notes.front(), "the joints were silent for more than 0.1 s, once; nothing is said across that");
  EXPECT_TRUE(std::isnan(value(demonstration, 1100, "tau_h_joint_1")));
  EXPECT_NEAR(value(demonstration, 500, "tau_h_joint_1"), handTorqueAt(0.5)[0], 0.01) << "a single row is bridged";
}

TEST(HumanTorqueTest, WhereAnEffortIsMissingThatJointsTorqueIsNotKnownAndNoOther) {
  Demonstration demonstration = record({});
  demonstration.values.col(7 + 2).segment(1000, 20).setConstant(std::numeric_limits<double>::quiet_NaN());
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  EXPECT_EQ(summary.rows, 3980U);
  EXPECT_TRUE(std::isnan(value(demonstration, 1010, "tau_h_joint_3")));
  EXPECT_NEAR(value(demonstration, 1010, "tau_h_joint_2"), handTorqueAt(1.01)[1], 1e-3);
  EXPECT_TRUE(std::isnan(value(demonstration, 1010, "tool_fx"))) << "the force at the tool needs all joints";
  EXPECT_NEAR(value(demonstration, 1021, "tau_h_joint_3"), handTorqueAt(1.021)[2], 1e-3);
}

TEST(HumanTorqueTest, AJointWithoutEffortsCostsNoOtherItsTorque) {
  Demonstration demonstration = record({});
  demonstration.values.col(7 + 2).setConstant(std::numeric_limits<double>::quiet_NaN());
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  EXPECT_EQ(summary.notes.front(),
            "joint 'joint_3' has no efforts: its torque is NaN, and so is the force at the tool");
  EXPECT_EQ(summary.rows, 0U) << "with all joints";
  EXPECT_TRUE(std::isnan(summary.largest_torque[2]));
  EXPECT_NEAR(summary.largest_torque[0], 10.0, 0.1);
  EXPECT_TRUE(std::isnan(value(demonstration, 2000, "tau_h_joint_3")));
  EXPECT_NEAR(value(demonstration, 2000, "tau_h_joint_2"), handTorqueAt(2.0)[1], 1e-3);
}

TEST(HumanTorqueTest, APositionThatTheArmCannotHaveIsNamed) {
  RobotDescription arm = frictionless();
  arm.joints[1].lower = -3.0;
  arm.joints[1].upper = 3.0;
  Demonstration demonstration = record({});
  demonstration.values(1500, 1) = 3.5;  // past its limits by less than a tenth of its range, as software limits are
  EXPECT_TRUE(addHumanTorque(arm, demonstration).notes.empty());
  demonstration.values(1000, 1) = 60.0;
  EXPECT_EQ(addHumanTorque(arm, demonstration).notes,
            std::vector<std::string>{
                "joint 'joint_2' is at 60 rad at 1 s, far beyond its limits of -3 to 3 rad: what is said around there "
                "is worth as much; `demo_tool check` may say more"});
  demonstration.values(2000, 1) = -60.0;
  EXPECT_NE(addHumanTorque(arm, demonstration).notes.front().find("at 1 s, the first of 2 such rows, far"),
            std::string::npos);
}

TEST(HumanTorqueTest, ValuesThatNoArmHasCountAsMissing) {
  Demonstration demonstration = record({});
  demonstration.values(1000, 7 + 1) = 1e300;
  demonstration.values(2000, 0) = 1e12;
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  const std::vector<std::string> expected = {
      "joint 'joint_1' has the position 1e+12, which no arm has: it counts as missing",
      "joint 'joint_2' has the effort 1e+300, which no arm has: it counts as missing"};
  EXPECT_EQ(std::vector<std::string>(summary.notes.begin(), summary.notes.begin() + 2), expected);
  EXPECT_NEAR(value(demonstration, 1003, "tau_h_joint_2"), handTorqueAt(1.003)[1], 2e-3) << "its neighbours stay";
  EXPECT_NEAR(value(demonstration, 2000, "tau_h_joint_1"), handTorqueAt(2.0)[0], 2e-3) << "bridged";
  EXPECT_EQ(demonstration.values(2000, 0), 1e12) << "what was recorded stays";
}

TEST(HumanTorqueTest, JointsThatHaveNoPositionAtTheSameTimeAreNamed) {
  Demonstration demonstration = record({});
  const double missing = std::numeric_limits<double>::quiet_NaN();
  for (Index k = 0; k < demonstration.values.rows(); ++k) demonstration.values(k, k % 3 == 0 ? 1 : 3) = missing;
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  EXPECT_EQ(summary.rows, 0U);
  EXPECT_EQ(summary.notes, std::vector<std::string>{
                               "in no row do all joints have a position (joint 'joint_4' has none in 2666 of 4000): "
                               "nothing can be told"});
}

TEST(HumanTorqueTest, AColumnInAnotherUnitIsRefused) {
  const auto refusal = [](std::size_t column, const std::string& unit) -> std::string {
    Demonstration demonstration = record({});
    demonstration.columns[column].unit = unit;
    try {
      addHumanTorque(frictionless(), demonstration);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal(0, "deg"),
            "column `q_joint_1` is in \"deg\", expected rad for the position of joint 'joint_1'; convert it, or mend "
            "the sidecar");
  EXPECT_EQ(refusal(8, "mN m"),
            "column `tau_joint_2` is in \"mN m\", expected N m for the effort of joint 'joint_2'; convert it, or mend "
            "the sidecar");
  EXPECT_NE(refusal(0, "m"), "") << "a joint that turns";
  EXPECT_EQ(refusal(0, "rad"), "");
}

TEST(HumanTorqueTest, AModelOfOneSideLeavesTheOtherSidesDrivesAlone) {
  const auto torqueOfHand = [](const ModelCalibration& model) {
    Teaching with_losses;
    with_losses.with_friction = true;
    Demonstration demonstration = record(with_losses);
    addHumanTorque(calibrate(demoArm(), model), demonstration);
    return value(demonstration, 2000, "tau_h_joint_2");
  };
  ModelCalibration of_links;
  of_links.side = "link";
  of_links.joints["joint_2"].friction = CalibratedValue{5.0, 0.0};
  EXPECT_NEAR(torqueOfHand(of_links), torqueOfHand(ModelCalibration()), 1e-9)
      << "the URDF's friction is still that of the motors";
}

TEST(HumanTorqueTest, AMovingJointBesideTheChainIsNamed) {
  Demonstration demonstration = record({});
  for (const char* name : {"q_finger", "q_locked"}) {
    demonstration.columns.push_back({name, "", Role::state, Interpolation::linear, ""});
  }
  demonstration.values.conservativeResize(Eigen::NoChange, 16);
  demonstration.values.rightCols(2).setConstant(0.5);
  demonstration.values(100, 14) = 0.75;
  demonstration.values(100, 15) = 0.5001;
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  ASSERT_EQ(summary.notes.size(), 1U) << "an encoder's noise is no motion";
  EXPECT_EQ(summary.notes.front(),
            "joint 'finger' moves by 0.250 rad or m, but is not between base_link and tool_tip: the model holds it "
            "still (--at says where)");
}

TEST(HumanTorqueTest, RecordedVelocitiesAreNotAskedFor) {
  Demonstration without = record({});
  Demonstration with = without;
  for (Index i = 0; i < 7; ++i) {
    with.columns.push_back({"dq_" + joint(i), "", Role::state, Interpolation::linear, ""});
  }
  with.values.conservativeResize(Eigen::NoChange, 21);
  with.values.rightCols(7).setConstant(99.0);
  addHumanTorque(frictionless(), without);
  addHumanTorque(frictionless(), with);
  EXPECT_EQ(value(with, 2000, "tau_h_joint_2"), value(without, 2000, "tau_h_joint_2"));
  EXPECT_NEAR(value(with, 2000, "dq_joint_3"), motionAt(2.0).dq[2], 1e-6) << "replaced by the smoothed one";
}

TEST(HumanTorqueTest, ARecordingOfOneRowHasNoTorqueAndSaysWhy) {
  Demonstration demonstration = record({});
  demonstration.time.resize(1);
  demonstration.values.conservativeResize(1, Eigen::NoChange);
  const HumanTorqueSummary summary = addHumanTorque(frictionless(), demonstration);
  EXPECT_EQ(summary.rows, 0U);
  EXPECT_EQ(summary.notes.front(),
            "1 part between silences has fewer than 8 rows, too few to tell an acceleration: it stays NaN");
  EXPECT_TRUE(std::isnan(value(demonstration, 0, "tau_h_joint_1")));
}

TEST(HumanTorqueTest, HeldEffortsAreNotExtrapolated) {
  Teaching noisy;
  noisy.torque_noise = 0.1;
  Demonstration demonstration = record(noisy);
  demonstration.values.col(7).segment(1000, 900).setConstant(std::numeric_limits<double>::quiet_NaN());
  demonstration.metadata.effort.control_period = 1.0;  // far too long: half a second before each stamp
  addHumanTorque(frictionless(), demonstration);
  double largest = 0.0;
  for (Index k = 0; k < demonstration.values.rows(); ++k) {
    const double torque = value(demonstration, k, "tau_h_joint_1");
    if (!std::isnan(torque)) largest = std::max(largest, std::abs(torque));
  }
  EXPECT_LT(largest, 50.0) << "wrong, but no larger than the torques that there are";
}

TEST(HumanTorqueTest, SaysWhatItCannotUse) {
  Demonstration demonstration = record({});
  demonstration.metadata.effort.control_period = 0.0;
  EXPECT_EQ(messageOf(frictionless(), demonstration),
            "effort: control_period is 0 s, expected that of the arm's controller, since its efforts are held: a held "
            "effort acts half of it late.");
  demonstration.metadata.effort.control_period = 7.0;
  EXPECT_EQ(messageOf(frictionless(), demonstration),
            "effort: control_period is 7 s, expected that of the arm's controller, above 0 and at most 1 s.");
  demonstration.metadata.effort.timing = "sometimes";
  EXPECT_EQ(messageOf(frictionless(), demonstration), "effort: timing is \"sometimes\", expected instant or held.");
  demonstration.metadata.effort.side = "both";
  EXPECT_EQ(messageOf(frictionless(), demonstration), "effort: side is \"both\", expected motor or link.");
  Demonstration incomplete = record({});
  incomplete.columns[2].name = "q_elbow";
  EXPECT_EQ(messageOf(frictionless(), incomplete),
            "no column `q_joint_3` with the position of joint 'joint_3', which the torques depend on");
}

}  // namespace
}  // namespace demo_logger
