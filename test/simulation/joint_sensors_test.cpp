#include "demo_logger/simulation/joint_sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

const ArmState kTruth{Eigen::Vector2d(0.1234567, -2.0), Eigen::Vector2d(0.5, 0.0)};
const Eigen::Vector2d kEffort(10.0, -3.0);

JointReading read(JointSensors& sensors) { return sensors.read({kTruth, kEffort, {}}); }

TEST(JointSensorsTest, WithoutNoiseTheReadingsAreTheTruth) {
  JointSensors sensors({});
  const JointReading reading = read(sensors);
  EXPECT_EQ(reading.q, kTruth.q);
  EXPECT_EQ(reading.dq, kTruth.dq);
  EXPECT_EQ(reading.effort, kEffort);
}

TEST(JointSensorsTest, AnEncoderReadsMultiplesOfItsStepAtMostHalfAStepOff) {
  SensorConfiguration configuration;
  configuration.position_resolution = 0.01;
  const JointReading reading = JointSensors(configuration).read({kTruth, kEffort, {}});
  EXPECT_DOUBLE_EQ(reading.q[0], 0.12);
  EXPECT_DOUBLE_EQ(reading.q[1], -2.0);
}

TEST(JointSensorsTest, ABiasShiftsWhatTheEncoderReads) {
  SensorConfiguration configuration;
  configuration.position_bias = {0.01, -0.02};
  JointSensors sensors(configuration);
  EXPECT_DOUBLE_EQ(read(sensors).q[0], 0.1334567);
  EXPECT_DOUBLE_EQ(read(sensors).q[1], -2.02);
}

TEST(JointSensorsTest, DifferencedVelocitiesAreThoseOfTheReadings) {
  SensorConfiguration configuration;
  configuration.velocity_from_positions = true;
  configuration.position_resolution = 0.01;
  JointSensors sensors(configuration, /*period=*/0.001);
  const auto readAt = [&](double q) {
    return sensors.read({{Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, 77.0)}, kEffort, {}}).dq[0];
  };
  EXPECT_EQ(readAt(0.104), 0.0) << "nothing to compare with";
  EXPECT_EQ(readAt(0.1049), 0.0) << "the encoder saw no step";
  EXPECT_NEAR(readAt(0.1051), 10.0, 1e-9) << "one step of 0.01 rad in 1 ms";
  sensors.forgetPositions();
  EXPECT_EQ(readAt(2.0), 0.0);
}

TEST(JointSensorsTest, ALowPassOverTheDifferencesHasTheTimeConstantOfItsCutoff) {
  SensorConfiguration configuration;
  configuration.velocity_from_positions = true;
  configuration.velocity_cutoff = 10.0;  // time constant 1 / (2π 10) s
  JointSensors sensors(configuration, 0.001);
  double velocity = 0.0;
  for (int k = 0; k <= 20; ++k) {
    velocity = sensors.read({{Eigen::VectorXd::Constant(1, 0.002 * k), Eigen::VectorXd(1)}, kEffort, {}}).dq[0];
  }
  EXPECT_NEAR(velocity, 2.0 * (1.0 - std::exp(-2.0 * M_PI * 10.0 * 0.020)), 1e-9) << "2 rad/s for 20 ms";
}

TEST(JointSensorsTest, TheEffortIsThatOfTheMotorOrOfTheLink) {
  SensorConfiguration configuration;
  const Eigen::Vector2d at_link(1.0, 2.0);
  EXPECT_EQ(JointSensors(configuration).read({kTruth, kEffort, at_link}).effort, kEffort);
  configuration.effort_side = EffortSide::link;
  EXPECT_EQ(JointSensors(configuration).read({kTruth, kEffort, at_link}).effort, at_link);
}

TEST(JointSensorsTest, NoiseHasTheMeanAndTheDeviationItWasGiven) {
  SensorConfiguration configuration;
  configuration.position_noise = 1e-3;
  configuration.velocity_noise = 0.02;
  configuration.effort_noise = 0.3;
  JointSensors sensors(configuration);
  constexpr int kReadings = 20'000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (int i = 0; i < kReadings; ++i) {
    const JointReading reading = read(sensors);
    const Eigen::Vector3d error((reading.q[0] - kTruth.q[0]) / 1e-3, (reading.dq[0] - kTruth.dq[0]) / 0.02,
                                (reading.effort[0] - kEffort[0]) / 0.3);
    sum += error;
    squares += error.cwiseProduct(error);
  }
  const double five_sigma = 5.0 / std::sqrt(kReadings);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sum[i] / kReadings, 0.0, five_sigma);
    EXPECT_NEAR(squares[i] / kReadings, 1.0, five_sigma * std::sqrt(2.0));
  }
}

TEST(JointSensorsTest, TheSameSeedGivesTheSameBitsAndAnotherSeedOthers) {
  SensorConfiguration configuration;
  configuration.position_noise = 1e-3;
  JointSensors first(configuration);
  JointSensors second(configuration);
  configuration.seed = 2;
  JointSensors other(configuration);
  const Eigen::VectorXd reading = read(first).q;
  EXPECT_EQ(reading, read(second).q);
  EXPECT_NE(reading, read(other).q);
}

TEST(JointSensorsTest, NegativeNoiseIsRefusedByName) {
  SensorConfiguration configuration;
  configuration.effort_noise = -0.1;
  try {
    JointSensors sensors(configuration);
    FAIL() << "negative noise was taken";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "joint sensors: effort_noise is -0.1 N m or N, expected a number of at least 0.");
  }
}

}  // namespace
}  // namespace demo_logger
