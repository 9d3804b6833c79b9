// What a fit writes is what it fitted, and no worse than what was there before.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "demo_logger/pipelines/fit_model.h"
#include "demo_logger/pipelines/human_torque.h"
#include "pan_tilt.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kAll = 1e3;  // [s]

/// Root mean square of each joint's τ_h, where the truth is zero; 0.1 s are cut at both ends.
std::vector<double> humanTorque(const CalibratedArm& arm, const Demonstration& recording) {
  Demonstration result = recording;
  addHumanTorque(arm, result);
  std::vector<double> squares(2, 0.0);
  const Index cut = 20;
  const Index rows = result.values.rows() - 2 * cut;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& columns = result.columns;
    const std::string name = i == 0 ? "tau_h_pan" : "tau_h_tilt";
    const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
    const auto column = static_cast<Index>(found - columns.begin());
    squares[i] = result.values.col(column).segment(cut, rows).norm() / std::sqrt(static_cast<double>(rows));
  }
  return squares;
}

bool says(const FitResult& fit, const std::string& part) {
  return std::any_of(fit.findings.begin(), fit.findings.end(),
                     [&](const std::string& finding) { return finding.find(part) != std::string::npos; });
}

std::string joined(const FitResult& fit) {
  std::string all = fit.undetermined;
  for (const std::string& finding : fit.findings) all += "\n" + finding;
  return all;
}

TEST(FitWrittenModelTest, ARightDescriptionIsNotMadeWorseOnThePartThatWasFittedHoweverShort) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  for (const double duration : {2.5, 3.0, 4.0, 10.0}) {
    run.duration = duration;
    for (const bool friction : {false, true}) {
      for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const Demonstration recording = record(run, seed);
        FitOptions options;
        options.hand_free = {{0.0, kAll}};
        options.friction = friction;
        const FitResult fit = fitModel(arm, {&recording}, options);
        ASSERT_EQ(fit.undetermined, "");
        const std::vector<double> before = humanTorque(calibrate(arm, ModelCalibration()), recording);
        const std::vector<double> after = humanTorque(calibrate(arm, fit.calibration), recording);
        for (std::size_t i = 0; i < 2; ++i) {
          // A parameter fitted to white noise moves a mean by its share of the noise: 0.01 N m / √(rows).
          EXPECT_LT(after[i], before[i] + 3.0 * run.noise / std::sqrt(200.0 * duration))
              << duration << " s, seed " << seed << ", joint " << i << (friction ? " with friction" : "")
              << joined(fit);
        }
      }
    }
  }
}

TEST(FitWrittenModelTest, WhatIsSaidToBeLeftIsWhatTheWrittenModelLeaves) {
  // Too short and too little for all of it: some is dropped, some replaced.
  const RobotDescription arm = PanTilt{}.describe();
  for (const double amplitude : {1.0, 0.1}) {
    for (const double payload : {0.0, 0.1, 0.6}) {
      for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        PanTiltRun run;
        run.duration = 3.0;
        run.payload = payload;
        run.pan_amplitude = amplitude;
        run.bias = {0.2, -0.3};
        run.noise = 0.003;
        const Demonstration recording = record(run, seed);
        FitOptions options;
        options.hand_free = {{0.0, kAll}};
        options.friction = false;
        const FitResult fit = fitModel(arm, {&recording}, options);
        ASSERT_EQ(fit.undetermined, "");
        FitOptions again = options;
        again.start = fit.calibration;
        const FitResult next = fitModel(arm, {&recording}, again);
        for (std::size_t i = 0; i < 2; ++i) {
          EXPECT_NEAR(next.residual_start[i], fit.residual[i], 1e-9) << "what is written is where the next one starts";
          // And it is what addHumanTorque leaves, but for the sensor's noise, which a smoother takes away.
          const double left = humanTorque(calibrate(arm, fit.calibration), recording)[i];
          EXPECT_LT(left, fit.residual[i] + 0.003) << payload << " kg, joint " << i << joined(fit);
          EXPECT_LT(fit.residual[i], left + 0.006) << payload << " kg, joint " << i << joined(fit);
        }
        EXPECT_LT(fit.residual[1], 0.1 * fit.residual_start[1]) << "most of it is explained" << joined(fit);
      }
    }
  }
}

TEST(FitWrittenModelTest, WhereNoPayloadIsNoneIsFoundButOnceInAHundredTimes) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.encoder_step = 0.0;
  constexpr int kSeeds = 200;
  for (const double duration : {10.0, 4.0}) {
    run.duration = duration;
    int found = 0;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      const Demonstration recording = record(run, seed);
      FitOptions options;
      options.hand_free = {{0.0, kAll}};
      const FitResult fit = fitModel(arm, {&recording}, options);
      ASSERT_EQ(fit.undetermined, "");
      found += says(fit, "payload: none to be seen") ? 0 : 1;
    }
    // Of 200 that are each wrong with 1 %, more than 7 are wrong once in a thousand times.
    EXPECT_LE(found, 7) << duration << " s";
  }
}

TEST(FitWrittenModelTest, ThePayloadThatIsThereIsFound) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.payload = 0.3;
  const Demonstration recording = record(run, 1);
  const FitResult fit = fitModel(arm, {&recording});
  ASSERT_TRUE(fit.calibration.payload) << joined(fit);
  EXPECT_NEAR(fit.calibration.payload->mass.value, 0.3, 4.0 * fit.calibration.payload->mass.deviation);
  EXPECT_LT(fit.calibration.payload->mass.deviation, 0.01);
}

TEST(FitWrittenModelTest, AJointWithoutAnyTorqueHasATorqueOfNothing) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.pan_amplitude = 0.0;
  run.payload = 0.3;
  Demonstration recording = record(run, 1);
  recording.values.col(2).setZero();
  recording.values.col(0).setZero();
  FitOptions options;
  options.friction = false;
  const FitResult fit = fitModel(arm, {&recording}, options);
  ASSERT_EQ(fit.undetermined, "");
  ASSERT_TRUE(fit.calibration.payload) << joined(fit);
  EXPECT_NEAR(fit.calibration.payload->mass.value, 0.3, 0.1) << joined(fit);
  EXPECT_NEAR(fit.calibration.joints.at("pan").torque_bias->value, 0.0, 1e-3);
  EXPECT_NEAR(fit.residual[0], 0.0, 1e-3);
  EXPECT_LT(fit.residual[1], 0.05);
}

TEST(FitWrittenModelTest, AnEffortBeyondAllMeasureSpoilsNoFit) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.payload = 0.3;
  Demonstration recording = record(run, 1);
  recording.values(400, 3) = 1e200;
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  const FitResult fit = fitModel(arm, {&recording}, options);
  ASSERT_TRUE(fit.calibration.payload) << joined(fit);
  EXPECT_NEAR(fit.calibration.payload->mass.value, 0.3, 0.01);
}

TEST(FitWrittenModelTest, FrictionIsFittedUnaskedWhereEffortsAreTheMotorsAndOnlyThere) {
  const RobotDescription arm = PanTilt{}.describe();
  for (const std::string side : {"motor", "link"}) {
    PanTiltRun run;
    run.side = side;
    run.damping = 0.3;
    run.friction = 0.2;
    const Demonstration recording = record(run, 1);
    FitOptions options;
    options.hand_free = {{0.0, kAll}};
    const FitResult unasked = fitModel(arm, {&recording}, options);
    options.friction = true;
    const FitResult asked = fitModel(arm, {&recording}, options);
    options.friction = false;
    const FitResult forbidden = fitModel(arm, {&recording}, options);
    EXPECT_NEAR(asked.calibration.joints.at("tilt").friction->value, 0.2, 0.02) << side;
    EXPECT_TRUE(says(forbidden, "friction is not fitted, as asked: it stays as it was")) << joined(forbidden);
    const RobotDescription without = calibrate(arm, forbidden.calibration).seenAt(side);
    EXPECT_EQ(without.joints[1].friction, 0.0);
    EXPECT_EQ(textOf(unasked.calibration), textOf(side == "motor" ? asked.calibration : forbidden.calibration)) << side;
  }
}

TEST(FitWrittenModelTest, AModelOfTheOtherSideOfTheGearsLeavesTheDescriptionsOwnDrives) {
  PanTilt described;
  described.damping = 0.3;
  const RobotDescription arm = described.describe();
  PanTiltRun run;
  run.damping = 0.3;
  const Demonstration recording = record(run, 2);
  FitOptions options;
  options.friction = false;
  options.hand_free = {{0.0, kAll}};
  options.start.side = "link";
  for (const char* const joint : {"pan", "tilt"}) {
    options.start.joints[joint].damping = CalibratedValue{0.0, 0.0};
    options.start.joints[joint].friction = CalibratedValue{0.0, 0.0};
  }
  const FitResult fit = fitModel(arm, {&recording}, options);
  ASSERT_EQ(fit.undetermined, "");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(fit.residual_start[i], run.noise, 0.001);
    EXPECT_NEAR(fit.residual[i], run.noise, 0.001);
  }
}

TEST(FitWrittenModelTest, AskedForFrictionIsFoundAlsoWhereAnEarlierFitAtTheLinksLeftItOut) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.side = "link";
  run.damping = 0.3;
  run.friction = 0.2;
  const Demonstration recording = record(run, 1);
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  FitOptions later = options;
  later.start = fitModel(arm, {&recording}, options).calibration;
  EXPECT_FALSE(later.start.joints.at("tilt").friction) << "not found is not known to be nothing";
  later.start.joints["tilt"].friction = CalibratedValue{0.0, 0.0};  // as someone may have written to say so
  later.friction = true;
  const FitResult fit = fitModel(arm, {&recording}, later);
  for (const char* const joint : {"pan", "tilt"}) {
    EXPECT_NEAR(fit.calibration.joints.at(joint).damping->value, 0.3, 0.02) << joined(fit);
    EXPECT_NEAR(fit.calibration.joints.at(joint).friction->value, 0.2, 0.02) << joined(fit);
  }
  // What someone states stays, and that is said.
  later.start.joints["tilt"].friction = CalibratedValue{0.1, 0.0};
  const FitResult stated = fitModel(arm, {&recording}, later);
  EXPECT_EQ(stated.calibration.joints.at("tilt").friction->value, 0.1);
  EXPECT_TRUE(says(stated, "tilt: friction 0.1 N m stays, as the model to start from states it without a deviation"))
      << joined(stated);
}

TEST(FitWrittenModelTest, ForbiddenFrictionIsNotFittedEvenIfTheStartIsNotSureOfIt) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.damping = 0.3;
  const Demonstration recording = record(run, 1);
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  options.friction = false;
  options.start.joints["tilt"].damping = CalibratedValue{0.1, 0.2};
  options.start.joints["tilt"].friction = CalibratedValue{0.05, 0.3};
  const FitResult fit = fitModel(arm, {&recording}, options);
  EXPECT_EQ(fit.calibration.joints.at("tilt").damping->value, 0.1);
  EXPECT_EQ(fit.calibration.joints.at("tilt").friction->value, 0.05);
}

TEST(FitWrittenModelTest, AMassThatTheArmHasNotIsNoModel) {
  // The description's last body is lighter than what is missing at the tip.
  RobotDescription arm = PanTilt{}.describe();
  arm.joints.back().body.mass = 0.05;
  arm.joints.front().body.mass = 2.0;
  PanTiltRun run;
  run.payload = 0.0;
  Demonstration recording = record(run, 1);
  recording.values.col(3) *= -1.0;  // and pulls up
  recording.values.col(2) *= -1.0;
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  options.friction = false;
  FitResult fit;
  ASSERT_NO_THROW(fit = fitModel(arm, {&recording}, options));
  ASSERT_NO_THROW(calibrate(arm, fit.calibration)) << joined(fit);
  EXPECT_TRUE(says(fit, "leaves no last body of 0.05 kg that there can be; it stays as it was")) << joined(fit);
  EXPECT_FALSE(fit.calibration.payload);
  EXPECT_FALSE(fit.doubts.empty());
}

TEST(FitWrittenModelTest, AStatedPayloadGoesWithTheBodiesThatAreFitted) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.payload = 0.3;
  const Demonstration recording = record(run, 1);
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  options.bodies = true;
  options.start.tip = "tool";
  options.start.payload = calibratedBody({0.3, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()});
  const FitResult fit = fitModel(arm, {&recording}, options);
  ASSERT_EQ(fit.undetermined, "");
  EXPECT_NEAR(fit.calibration.bodies.at("tilt").mass.value, 1.3, 0.02) << joined(fit);
  EXPECT_NEAR(fit.residual[1], run.noise, 0.002);
}

TEST(FitWrittenModelTest, BodiesThatTheStartStatesStayAndOthersAreHeldAsFirmlyAsItSays) {
  const RobotDescription arm = PanTilt{}.describe();
  const PanTiltRun run;
  const Demonstration recording = record(run, 1);
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  options.bodies = true;
  options.start.bodies["pan"] = calibratedBody(arm.joints[0].body);
  CalibratedBody& tilt = options.start.bodies["tilt"] = calibratedBody(arm.joints[1].body);
  tilt.mass = {1.2, 1e-3};  // wrong, and sure of it
  for (CalibratedValue& center : tilt.center) center.deviation = 0.1;
  for (CalibratedValue& inertia : tilt.inertia) inertia.deviation = 0.03;
  // A payload that is known not to be there.
  options.start.tip = "tool";
  options.start.payload = calibratedBody({1e-6, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()});
  const FitResult fit = fitModel(arm, {&recording}, options);
  ASSERT_EQ(fit.undetermined, "");
  EXPECT_EQ(fit.calibration.bodies.at("pan").mass.value, 2.0);
  EXPECT_NEAR(fit.calibration.bodies.at("pan").inertia[5].value, 0.01, 1e-12);
  EXPECT_NEAR(fit.calibration.bodies.at("tilt").mass.value, 1.2, 0.005) << joined(fit);
  EXPECT_NEAR(fit.calibration.bodies.at("tilt").center[0].value, 0.3 / 1.2, 0.005) << "m c is what torques tell";
  EXPECT_NEAR(fit.residual[1], run.noise, 0.001);
}

TEST(FitWrittenModelTest, GapsInOneJointsEffortsDoNotMakeTheOthersMoreParticular) {
  const RobotDescription arm = PanTilt{}.describe();
  PanTiltRun run;
  run.damping = 3.0;  // which the description has not, so that it is in doubt
  Demonstration recording = record(run, 1);
  FitOptions options;
  options.hand_free = {{0.0, kAll}};
  options.friction = false;
  const auto doubt = [&] {
    const FitResult fit = fitModel(arm, {&recording}, options);
    const std::string before = "where the model may be off by ";
    const std::string doubt = fit.doubts.empty() ? "" : fit.doubts.back();
    const std::size_t at = doubt.find(before);
    return at == std::string::npos ? std::string("no doubt") : doubt.substr(at + before.size());
  };
  const std::string whole = doubt();
  for (Index k = 0; k < recording.values.rows(); ++k) {
    if (k % 20 != 0) recording.values(k, 2) = std::nan("");
  }
  EXPECT_NE(whole, "no doubt");
  EXPECT_EQ(doubt(), whole);
}

}  // namespace
}  // namespace demo_logger
