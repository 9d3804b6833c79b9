// How well the hand's torque is recovered, against the truth of the simulated arm. The bounds are those of
// doc/benchmarks/human_torque.md, which has more seeds.

#include <gtest/gtest.h>

#include "demo_logger/pipelines/fit_model.h"
#include "demo_logger/pipelines/human_torque.h"
#include "demo_logger/pipelines/human_torque_observer.h"
#include "test/pipelines/panda_run.h"
#include "test/pipelines/taught_arm.h"

namespace demo_logger {
namespace {

CalibratedArm asItIs(const RobotDescription& arm) { return calibrate(arm, ModelCalibration()); }

Demonstration recovered(const TaughtRecording& recording, const CalibratedArm& arm = asItIs(taughtArm())) {
  Demonstration result = recording.log;
  addHumanTorque(arm, result);
  return result;
}

/// [%]
double offBy(const TaughtRecording& recording, const CalibratedArm& arm = asItIs(taughtArm())) {
  return percentOff(recording, jointColumns(recovered(recording, arm), "tau_h_"));
}

TEST(HumanTorqueAccuracyTest, ARowWithoutATorqueIsNotPassedOver) {
  TaughtRecording recording;
  recording.taught_to = 1.0;
  recording.log.time = {0.0, 0.5, 0.6, 1.0};
  recording.torque = Eigen::MatrixXd::Constant(4, 7, 2.0);
  Eigen::MatrixXd found = Eigen::MatrixXd::Constant(4, 7, 2.1);
  found.row(0).setConstant(std::nan(""));  // at the edge, where a smoother knows one side only
  EXPECT_NEAR(percentOff(recording, found), 5.0, 1e-9);
  found(2, 3) = std::nan("");
  EXPECT_TRUE(std::isnan(percentOff(recording, found)));
}

TEST(HumanTorqueAccuracyTest, NothingIsLostButWhatTheIntegratorLoses) {
  Teaching teaching;
  EXPECT_LT(offBy(teach(teaching)), 0.02);
  teaching.integrator = Integrator::runge_kutta_4;
  EXPECT_LT(offBy(teach(teaching)), 0.001);
}

TEST(HumanTorqueAccuracyTest, AnEncoderCostsLittleEvenInASlowLog) {
  Teaching teaching;
  teaching.encoder_step = encoderStep(18);
  const TaughtRecording recording = teach(teaching);
  EXPECT_LT(offBy(recording), 0.17) << "1 kHz";
  EXPECT_LT(offBy(thinned(recording, 10)), 0.24) << "100 Hz";
}

TEST(HumanTorqueAccuracyTest, TheControlPeriodDecidesOnTheInstantNotTheLogsInterval) {
  TaughtRecording slow = thinned(teach({}), 10);
  const double error = offBy(slow);
  slow.log.metadata.effort.control_period = 0.01;
  EXPECT_GT(offBy(slow), 9.0 * error) << "half the log's interval instead";
}

TEST(HumanTorqueAccuracyTest, IsAsSureAsItSays) {
  for (const double noise : {1e-5, 1e-4, 1e-3}) {
    SCOPED_TRACE(noise);
    Teaching teaching;
    teaching.position_noise = noise;
    const TaughtRecording recording = teach(teaching);
    const Demonstration result = recovered(recording);
    if (noise == 1e-4) {
      EXPECT_LT(percentOff(recording, jointColumns(result, "tau_h_")), 0.55);
    }
    const Eigen::ArrayXXd error =
        (jointColumns(result, "tau_h_") - recording.torque).array() / jointColumns(result, "tau_h_std_").array();
    EXPECT_GT((error.abs() <= 2.0).cast<double>().mean(), 0.93);
    EXPECT_GT(std::sqrt(error.square().mean()), 0.6);
    EXPECT_LT(std::sqrt(error.square().mean()), 1.2);
  }
}

TEST(HumanTorqueAccuracyTest, TrueStampsMakeJitterHarmless) {
  const TaughtRecording recording = teach({});
  const double step = encoderStep(18);
  TaughtRecording uneven = jittered(recording, 300e-6, step, 1);
  const double error = offBy(uneven);
  EXPECT_LT(error, 1.1 * offBy(jittered(recording, 1e-12, step, 1)));
  uneven.log.time = recording.log.time;
  EXPECT_GT(offBy(uneven), 2.0 * error) << "as if the stamps were even";
}

TEST(HumanTorqueAccuracyTest, APayloadThatNobodyKnewIsFoundWhereTheHandIsAway) {
  Teaching teaching;
  teaching.encoder_step = encoderStep(18);
  teaching.own_motion = 12.0;
  teaching.payload = BodyInertia{0.3, {0.01, 0.02, 0.05}, Eigen::Vector3d(4e-4, 4e-4, 2e-4).asDiagonal()};
  const TaughtRecording recording = teach(teaching);
  const FitResult fit = fitModel(taughtArm(), {&recording.log});
  ASSERT_EQ(fit.undetermined, "");
  EXPECT_NEAR(fit.calibration.payload->mass.value, 0.3, 0.005);
  EXPECT_GT(offBy(recording), 3.0);
  EXPECT_LT(offBy(recording, calibrate(taughtArm(), fit.calibration)), 0.5);
}

TEST(HumanTorqueAccuracyTest, FrictionThatNobodyKnewIsFoundWhereTheHandIsAway) {
  Teaching teaching;
  teaching.encoder_step = encoderStep(18);
  teaching.own_motion = 12.0;
  teaching.coulomb_friction = true;
  teaching.integrator = Integrator::runge_kutta_4;
  const TaughtRecording recording = teach(teaching);
  RobotDescription bare = taughtArm();
  for (ArmJoint& joint : bare.joints) joint.damping = 0.0;
  const FitResult fit = fitModel(bare, {&recording.log});
  ASSERT_EQ(fit.undetermined, "");
  for (const FitResult::Part& part : fit.hand_free) {
    EXPECT_FALSE(part.span.from > recording.taught_from + 1.5 && part.span.to < recording.taught_to - 2.0)
        << part.span.from << " to " << part.span.to << " s, where the hand is";
  }
  EXPECT_GT(offBy(recording, asItIs(bare)), 3.0);
  EXPECT_LT(offBy(recording, calibrate(bare, fit.calibration)), 0.7);
}

TEST(HumanTorqueAccuracyTest, AsItHappensItIsLateButRight) {
  Teaching teaching;
  teaching.encoder_step = encoderStep(18);
  const TaughtRecording recording = teach(teaching);
  HumanTorqueObserverConfiguration configuration;
  configuration.effort = recording.log.metadata.effort;
  HumanTorqueObserver observer(asItIs(taughtArm()), configuration);
  const Eigen::Index rows = recording.q.rows();
  const auto late = static_cast<Eigen::Index>(std::lround(1e3 * observer.delay()));
  Eigen::MatrixXd raw = Eigen::MatrixXd::Constant(rows, 7, std::nan(""));
  Eigen::MatrixXd shifted = raw;
  Eigen::VectorXd torque(7);
  for (Eigen::Index k = 0; k < rows; ++k) {
    observer.update(k * kMillisecond, recording.log.values.row(k).head(7), recording.log.values.row(k).tail(7), torque);
    raw.row(k) = torque;
    if (k >= late) shifted.row(k - late) = torque;
  }
  EXPECT_LT(percentOff(recording, raw), 3.0);
  EXPECT_LT(percentOff(recording, shifted), 0.8);
}

TEST(HumanTorqueAccuracyTest, ARealArmsModelFittedToTwoThirdsOfARunExplainsTheRestBetterThanThePublishedOne) {
  const auto arm = describePanda();
  auto run = readPandaRun();
  if (!arm || !run) GTEST_SKIP() << "DEMO_LOGGER_DATA and DEMO_LOGGER_URDF name no folders with panda files";
  FitOptions options;
  options.hand_free = {{0.0, 14.0}};
  options.friction = true;
  options.bodies = true;
  const FitResult fit = fitModel(*arm, {&*run}, options);
  ASSERT_EQ(fit.undetermined, "");
  addHumanTorque(calibrate(*arm, fit.calibration), *run);
  for (Eigen::Index i = 0; i < 7; ++i) {
    const std::string column = "tau_h_panda_joint" + std::to_string(i + 1);
    for (std::size_t c = 0; c < run->columns.size(); ++c) {
      if (run->columns[c].name != column) continue;
      const Eigen::VectorXd residual = run->values.col(static_cast<Eigen::Index>(c));
      EXPECT_LT(rootMeanSquare(throughQuartics(run->time, residual, 14.0, 21.0)),
                kPublishedResidual[static_cast<std::size_t>(i)])
          << "[N m] joint " << i + 1;
    }
  }
}

}  // namespace
}  // namespace demo_logger
