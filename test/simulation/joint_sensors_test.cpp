#include "demo_logger/simulation/joint_sensors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

const ArmState kTruth{Eigen::Vector2d(0.1234567, -2.0), Eigen::Vector2d(0.5, 0.0)};
const Eigen::Vector2d kEffort(10.0, -3.0);

TEST(JointSensorsTest, WithoutNoiseTheReadingsAreTheTruth) {
  JointSensors sensors({});
  const JointReading reading = sensors.read(kTruth, kEffort);
  EXPECT_EQ(reading.q, kTruth.q);
  EXPECT_EQ(reading.dq, kTruth.dq);
  EXPECT_EQ(reading.effort, kEffort);
}

TEST(JointSensorsTest, AnEncoderReadsMultiplesOfItsStepAtMostHalfAStepOff) {
  SensorConfiguration configuration;
  configuration.position_resolution = 0.01;
  const JointReading reading = JointSensors(configuration).read(kTruth, kEffort);
  EXPECT_DOUBLE_EQ(reading.q[0], 0.12);
  EXPECT_DOUBLE_EQ(reading.q[1], -2.0);
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
    const JointReading reading = sensors.read(kTruth, kEffort);
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
  const Eigen::VectorXd reading = first.read(kTruth, kEffort).q;
  EXPECT_EQ(reading, second.read(kTruth, kEffort).q);
  EXPECT_NE(reading, other.read(kTruth, kEffort).q);
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
