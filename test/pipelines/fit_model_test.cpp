#include "demo_logger/pipelines/fit_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "demo_logger/pipelines/human_torque.h"
#include "demo_logger/robot/identified_arm.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kPi = 3.14159265358979323846;
constexpr double kPayload = 0.3;  // [kg]
const Eigen::Vector3d kPayloadCenter(0.02, -0.01, 0.06);
constexpr double kFrictionVelocity = 0.01;  // [rad/s]
const std::string kElbow = "joint_4";

RobotDescription demoArm() {
  return describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/demo_arm.urdf", {"base_link", "tool_tip", {}, 9.81});
}

/// As its URDF claims: without friction.
RobotDescription claimedArm() {
  RobotDescription arm = demoArm();
  for (ArmJoint& joint : arm.joints) joint.damping = joint.friction = 0.0;
  return arm;
}

/// As it is: with the friction of the URDF, and a payload in its hand.
RobotDescription trueArm() {
  RobotDescription arm = demoArm();
  for (ArmJoint& joint : arm.joints) joint.friction_velocity = kFrictionVelocity;
  return withPayload(arm, {kPayload, kPayloadCenter, Eigen::Matrix3d::Zero()});
}

const Eigen::VectorXd& trueBias() {
  static const Eigen::VectorXd bias = (Eigen::VectorXd(7) << -0.15, -0.4, 0.1, 0.2, 0.05, 0.0, -0.02).finished();
  return bias;
}

struct Scene {
  double duration = 20.0;
  RobotDescription arm = trueArm();
  Eigen::VectorXd bias = trueBias();
  std::string side = "motor";
  int still_joint = -1;  // does not move
  bool moves = true;
  std::function<double(double)> hand = [](double) { return 0.0; };  // how firmly it holds the tool
};

/// Torques that a hand of up to 15 N exerts, with a tremor.
Eigen::VectorXd handTorqueAt(const RobotModel& model, const Eigen::VectorXd& q, double t) {
  Eigen::VectorXd wrench(6);
  wrench << 10.0 * std::sin(2.1 * t), 8.0 * std::cos(1.3 * t), 6.0 * std::sin(0.9 * t + 1.0), 0.3 * std::sin(1.7 * t),
      0.2 * std::cos(2.3 * t), 0.1;
  wrench *= 1.0 + 0.1 * std::sin(2.0 * kPi * 9.0 * t);
  return model.jacobian(q).transpose() * wrench;
}

Demonstration record(const Scene& scene, std::uint32_t seed = 3) {
  const RobotModel model(scene.arm);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Demonstration demonstration;
  for (const char* prefix : {"q_", "tau_"}) {
    for (const std::string& joint : scene.arm.jointNames()) {
      demonstration.columns.push_back({prefix + joint, "", Role::state, Interpolation::linear, ""});
    }
  }
  constexpr double kRate = 200.0;  // [Hz]
  const auto rows = static_cast<Index>(scene.duration * kRate);
  demonstration.values.resize(rows, 14);
  for (Index k = 0; k < rows; ++k) {
    const double t = static_cast<double>(k) / kRate;
    demonstration.time.push_back(t);
    Eigen::VectorXd q(7), dq(7), ddq(7);
    for (Index i = 0; i < 7; ++i) {
      const bool still = !scene.moves || i == scene.still_joint;
      const double w = 2.0 * kPi * (0.13 + 0.04 * static_cast<double>(i));
      const double amplitude = still ? 0.0 : 0.6;
      q[i] = 0.3 * static_cast<double>(i % 3) - 0.2 + amplitude * std::sin(w * t + static_cast<double>(i));
      dq[i] = amplitude * w * std::cos(w * t + static_cast<double>(i));
      ddq[i] = -amplitude * w * w * std::sin(w * t + static_cast<double>(i));
    }
    Eigen::VectorXd torque = model.inverseDynamics(q, dq, ddq) + scene.bias - scene.hand(t) * handTorqueAt(model, q, t);
    if (scene.side == "motor") torque += model.friction(dq);
    for (Index i = 0; i < 7; ++i) {
      demonstration.values(k, i) = q[i] + 2e-5 * normal(random);
      demonstration.values(k, 7 + i) = torque[i] + 0.02 * normal(random);
    }
  }
  demonstration.metadata.effort.side = scene.side;
  demonstration.metadata.effort.timing = "instant";
  return demonstration;
}

/// The hand comes at `from` and goes at `to`, within 0.2 s each.
std::function<double(double)> handWithin(double from, double to) {
  return [=](double t) { return std::clamp(5.0 * (t - from), 0.0, 1.0) * std::clamp(5.0 * (to - t), 0.0, 1.0); };
}

void expectWithin(double sigmas, const CalibratedValue& value, double truth, const std::string& what) {
  EXPECT_GT(value.deviation, 0.0) << what;
  EXPECT_LT(std::abs(value.value - truth), sigmas * value.deviation)
      << what << ": " << value.value << " ± " << value.deviation << ", truly " << truth;
}

void expectTruth(const FitResult& fit, double sigmas, bool with_friction = true) {
  ASSERT_EQ(fit.undetermined, "");
  ASSERT_TRUE(fit.calibration.payload);
  expectWithin(sigmas, fit.calibration.payload->mass, kPayload, "mass");
  for (std::size_t i = 0; i < 3; ++i) {
    expectWithin(sigmas, fit.calibration.payload->center[i], kPayloadCenter[static_cast<Index>(i)], "center");
  }
  const RobotDescription truth = trueArm();
  for (std::size_t i = 0; i < 7; ++i) {
    const ArmJoint& joint = truth.joints[i];
    const JointCalibration& found = fit.calibration.joints.at(joint.name);
    expectWithin(sigmas, *found.torque_bias, trueBias()[static_cast<Index>(i)], joint.name + " bias");
    if (!with_friction) continue;
    expectWithin(sigmas, *found.damping, joint.damping, joint.name + " damping");
    expectWithin(sigmas, *found.friction, joint.friction, joint.name + " friction");
  }
}

TEST(FitModelTest, PayloadBiasAndFrictionComeBackWithinTheirDeviations) {
  const Demonstration recording = record({});
  const FitResult fit = fitModel(claimedArm(), {&recording});
  expectTruth(fit, 4.0);
  EXPECT_NEAR(fit.calibration.payload->mass.value, kPayload, 0.01);
  EXPECT_NEAR(fit.duration, 20.0, 0.5);
  EXPECT_EQ(fit.calibration.joints.at("joint_1").friction_velocity, kFrictionVelocity);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_LT(fit.residual[i], 0.2 * fit.residual_start[i]);
    EXPECT_LT(fit.residual[i], 0.022) << "the sensor's noise, 0.02 N m";
  }
}

TEST(FitModelTest, DeviationsAreHonestOverManyRecordings) {
  double squares = 0.0;
  double count = 0.0;
  const RobotDescription truth = trueArm();
  Scene scene;
  scene.duration = 8.0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    const Demonstration recording = record(scene, seed);
    const FitResult fit = fitModel(claimedArm(), {&recording});
    ASSERT_EQ(fit.undetermined, "");
    const auto add = [&](const CalibratedValue& value, double expected) {
      squares += std::pow((value.value - expected) / value.deviation, 2);
      count += 1.0;
    };
    add(fit.calibration.payload->mass, kPayload);
    for (std::size_t i = 0; i < 7; ++i) {
      const JointCalibration& joint = fit.calibration.joints.at(truth.joints[i].name);
      add(*joint.torque_bias, trueBias()[static_cast<Index>(i)]);
      add(*joint.friction, truth.joints[i].friction);
    }
  }
  EXPECT_GT(std::sqrt(squares / count), 0.4) << "not needlessly timid";
  EXPECT_LT(std::sqrt(squares / count), 2.0) << "not bold";
}

TEST(FitModelTest, FindsWhereTheHandIsAndLeavesThatOut) {
  Scene scene;
  scene.hand = handWithin(8.0, 16.0);
  const Demonstration recording = record(scene);
  const FitResult fit = fitModel(claimedArm(), {&recording});
  expectTruth(fit, 5.0);
  for (const FitResult::Part& part : fit.hand_free) {
    EXPECT_TRUE(part.span.to < 8.3 || part.span.from > 15.7) << part.span.from << " to " << part.span.to;
  }
  EXPECT_GT(fit.duration, 9.0);
  EXPECT_LT(fit.duration, 12.5);
}

TEST(FitModelTest, AHandThatNeverLetsGoLeavesNothingToFit) {
  Scene scene;
  scene.hand = [](double) { return 1.0; };
  const Demonstration recording = record(scene);
  const FitResult fit = fitModel(claimedArm(), {&recording});
  EXPECT_NE(fit.undetermined.find("s can be taken as free of a hand's touch, expected at least 2 s"), std::string::npos)
      << fit.undetermined;
  EXPECT_TRUE(fit.calibration.joints.empty());
}

TEST(FitModelTest, ShortPartsWithoutAHandAddUpWhereNoneLastsTwoSeconds) {
  Scene scene;
  scene.side = "link";
  scene.arm = claimedArm();
  scene.duration = 7.0;
  scene.hand = handWithin(1.4, 5.4);
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const Demonstration recording = record(scene, seed);
    const FitResult fit = fitModel(claimedArm(), {&recording});
    ASSERT_EQ(fit.undetermined, "") << seed;
    EXPECT_GT(fit.duration, 2.2) << seed;
    for (const FitResult::Part& part : fit.hand_free) {
      EXPECT_TRUE(part.span.to < 1.7 || part.span.from > 5.1) << part.span.from << " to " << part.span.to;
    }
  }
}

TEST(FitModelTest, ShortPartsAreNotFoundUnderAHandThatNeverLetsGo) {
  Scene scene;
  scene.hand = [](double) { return 1.0; };
  for (const std::string side : {"motor", "link"}) {
    scene.side = side;
    for (const double duration : {6.0, 20.0}) {
      scene.duration = duration;
      for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        const Demonstration recording = record(scene, seed);
        const FitResult fit = fitModel(claimedArm(), {&recording});
        EXPECT_NE(fit.undetermined.find("expected at least 2 s, a second of it in one piece, that one payload"),
                  std::string::npos)
            << side << ", " << duration << " s: " << fit.undetermined << fit.duration;
      }
    }
  }
}

TEST(FitModelTest, TakesTheGivenPartsAndNoOthers) {
  Scene scene;
  scene.hand = handWithin(8.0, 16.0);
  const Demonstration recording = record(scene);
  FitOptions options;
  options.hand_free = {{0.5, 4.0}, {5.0, 7.5}, {16.5, 19.5}};
  const FitResult fit = fitModel(claimedArm(), {&recording}, options);
  expectTruth(fit, 5.0);
  ASSERT_EQ(fit.hand_free.size(), 3U);
  EXPECT_NEAR(fit.hand_free[1].span.from, 5.0, 0.011);
  EXPECT_NEAR(fit.duration, 9.0, 0.1);

  options.hand_free = {{1.0, 1.5}};
  EXPECT_NE(fitModel(claimedArm(), {&recording}, options)
                .undetermined.find("the parts without a hand that were given hold 0.5 s"),
            std::string::npos);
}

TEST(FitModelTest, AJointThatStandsStillHasNoFrictionToTell) {
  Scene scene;
  scene.still_joint = 3;
  const Demonstration recording = record(scene);
  const FitResult fit = fitModel(claimedArm(), {&recording});
  ASSERT_EQ(fit.undetermined, "");
  const JointCalibration& joint = fit.calibration.joints.at(kElbow);
  EXPECT_FALSE(joint.friction);
  EXPECT_FALSE(joint.damping);
  EXPECT_NE(std::find(fit.findings.begin(), fit.findings.end(),
                      "joint_4 moves too little, or not alone enough, to tell torque bias, damping, friction: left as "
                      "they were"),
            fit.findings.end());
  expectWithin(4.0, fit.calibration.payload->mass, kPayload, "mass");
}

TEST(FitModelTest, AnArmThatStandsStillUnderFrictionTellsNothing) {
  Scene scene;
  scene.moves = false;
  const Demonstration recording = record(scene);
  EXPECT_NE(fitModel(claimedArm(), {&recording}).undetermined, "");
}

TEST(FitModelTest, EffortsAtTheLinksGetNoFrictionUnlessAsked) {
  Scene scene;
  scene.side = "link";
  const Demonstration recording = record(scene);
  const FitResult fit = fitModel(claimedArm(), {&recording});
  expectTruth(fit, 4.0, /*with_friction=*/false);
  EXPECT_EQ(fit.calibration.side, "link");
  EXPECT_FALSE(fit.calibration.joints.at("joint_1").friction) << "which an absent value says as well";
  EXPECT_EQ(fit.findings.back(),
            "friction is not fitted: efforts measured at the links have that of the motors and gears behind them "
            "(--fit-friction fits what is left)");
  FitOptions options;
  options.friction = true;
  const FitResult asked = fitModel(claimedArm(), {&recording}, options);
  EXPECT_NEAR(asked.calibration.joints.at("joint_1").friction->value, 0.0, 0.01) << "there is none";
}

TEST(FitModelTest, NothingIsSeenWhereTheDescriptionIsRight) {
  Scene scene;
  scene.arm = demoArm();
  for (ArmJoint& joint : scene.arm.joints) joint.friction_velocity = kFrictionVelocity;
  const Demonstration recording = record(scene);
  const FitResult fit = fitModel(scene.arm, {&recording});
  ASSERT_EQ(fit.undetermined, "");
  EXPECT_FALSE(fit.calibration.payload);
  EXPECT_EQ(fit.findings.front().rfind("payload: none to be seen beyond what the description has, ", 0), 0U);
}

TEST(FitModelTest, WhatIsStatedInTheStartStaysAndWhatWasFittedIsRefined) {
  const Demonstration recording = record({});
  FitOptions options;
  options.start.joints["joint_2"].torque_bias = CalibratedValue{-0.3, 0.0};
  options.start.joints["joint_3"].torque_bias = CalibratedValue{0.9, 0.001};  // wrong, and sure of it
  options.hand_free = {{0.0, 20.0}};                                          // such a start explains no part by itself
  const FitResult fit = fitModel(claimedArm(), {&recording}, options);
  ASSERT_EQ(fit.undetermined, "");
  EXPECT_EQ(fit.calibration.joints.at("joint_2").torque_bias->value, -0.3);
  EXPECT_GT(fit.calibration.joints.at("joint_3").torque_bias->value, 0.5) << "held by its small deviation";
}

/// Root mean square of what is taken for the hand's torque and is not, over all joints.
double errorOf(const CalibratedArm& arm, const Demonstration& recording, const Scene& scene) {
  Demonstration result = recording;
  addHumanTorque(arm, result);
  const RobotModel model(trueArm());
  double squares = 0.0;
  double count = 0.0;
  for (Index k = 100; k < result.values.rows() - 100; ++k) {
    const double t = result.time[static_cast<std::size_t>(k)];
    const Eigen::VectorXd q = result.values.row(k).head(7);
    const Eigen::VectorXd truth = scene.hand(t) * handTorqueAt(model, q, t);
    for (Index i = 0; i < 7; ++i) {
      squares += std::pow(result.values(k, 14 + 14 + i) - truth[i], 2);
      count += 1.0;
    }
  }
  return std::sqrt(squares / count);
}

TEST(FitModelTest, TheTorqueWithTheFittedModelIsTheHands) {
  Scene scene;
  scene.hand = handWithin(8.0, 16.0);
  const Demonstration recording = record(scene);
  const FitResult fit = fitModel(claimedArm(), {&recording});
  const double before = errorOf(calibrate(claimedArm(), ModelCalibration()), recording, scene);
  const double after = errorOf(calibrate(claimedArm(), fit.calibration), recording, scene);
  EXPECT_LT(after, 0.1 * before) << before << " N m before";
}

TEST(FitModelTest, ADescriptionThatIsRightIsLeftSoEvenByShortParts) {
  Scene scene;
  scene.bias = Eigen::VectorXd::Zero(7);
  scene.duration = 7.5;
  scene.hand = handWithin(1.2, 5.5);
  for (const std::string side : {"motor", "link"}) {
    scene.side = side;
    scene.arm = demoArm();
    for (ArmJoint& joint : scene.arm.joints) joint.friction_velocity = kFrictionVelocity;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
      const Demonstration recording = record(scene, seed);
      FitOptions options;
      options.hand_free = {{0.0, 1.2}, {5.5, 7.5}};
      const FitResult fit = fitModel(scene.arm, {&recording}, options);
      ASSERT_EQ(fit.undetermined, "");
      const double before = errorOf(calibrate(scene.arm, ModelCalibration()), recording, scene);
      const double after = errorOf(calibrate(scene.arm, fit.calibration), recording, scene);
      // Bias, damping and friction of each joint are known to the noise of 0.02 N m over √(320 rows); what they are
      // applied to is faster than what they were found in.
      EXPECT_LT(after * after, before * before + 4.0 * 3.0 * std::pow(0.02, 2) / 320.0)
          << side << ", seed " << seed << ": " << after << " N m after " << before;
    }
  }
}

TEST(FitModelTest, BodiesThatTheDescriptionHasWrongAreFoundSoFarAsTorquesTell) {
  // Every mass is wrong by up to a fifth, every centre by a centimetre or two.
  Scene scene;
  scene.arm = claimedArm();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> spread(-1.0, 1.0);
  for (ArmJoint& joint : scene.arm.joints) {
    joint.body.mass *= 1.0 + 0.2 * spread(random);
    joint.body.center += 0.02 * Eigen::Vector3d(spread(random), spread(random), spread(random));
    joint.body.inertia *= 1.0 + 0.2 * spread(random);
  }
  scene.side = "link";
  scene.duration = 30.0;
  const Demonstration recording = record(scene);
  FitOptions options;
  options.bodies = true;
  options.hand_free = {{0.0, 20.0}};
  const FitResult fit = fitModel(claimedArm(), {&recording}, options);
  ASSERT_EQ(fit.undetermined, "");
  EXPECT_EQ(fit.calibration.bodies.size(), 7U);
  EXPECT_FALSE(fit.calibration.payload);
  // On what the fit has not seen.
  Demonstration before = recording;
  Demonstration after = recording;
  addHumanTorque(calibrate(claimedArm(), ModelCalibration()), before);
  addHumanTorque(calibrate(claimedArm(), fit.calibration), after);
  const Eigen::Index unseen = before.values.rows() - 4000;
  for (Index i = 0; i < 7; ++i) {
    const double left = after.values.col(28 + i).segment(4000, unseen - 50).norm();
    EXPECT_LT(left, 0.2 * before.values.col(28 + i).segment(4000, unseen - 50).norm()) << "joint " << i + 1;
  }
}

TEST(FitModelTest, WithoutEffortsThereIsNothingToExplain) {
  Demonstration recording = record({});
  recording.columns.resize(7);
  recording.values.conservativeResize(Eigen::NoChange, 7);
  try {
    fitModel(claimedArm(), {&recording});
    ADD_FAILURE() << "expected an error";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(),
                 "no column `tau_joint_1` with efforts of joint 'joint_1', which a model would have to explain");
  }
}

}  // namespace
}  // namespace demo_logger
