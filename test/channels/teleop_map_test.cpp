#include "demo_logger/channels/teleop_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

const std::vector<std::string> kTwist{"u_vx", "u_vy", "u_vz", "u_wx", "u_wy", "u_wz"};

/// Two axes drive vx and vy; the second one also turns about z.
TeleopMapConfiguration makeConfiguration() {
  TeleopMapConfiguration configuration;
  configuration.inputs = {"joy_axis0", "joy_axis1"};
  configuration.outputs = kTwist;
  configuration.gain = Eigen::MatrixXd::Zero(6, 2);
  configuration.gain(0, 0) = 0.5;
  configuration.gain(1, 1) = 0.25;
  configuration.gain(5, 1) = -2.0;
  configuration.offset = Eigen::VectorXd::Zero(6);
  return configuration;
}

std::string messageOf(const TeleopMapConfiguration& configuration) {
  try {
    TeleopMap map(configuration);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(TeleopMapTest, MapsEachReadingByGainAndOffset) {
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.offset[2] = 0.1;

  const TeleopOutput output = TeleopMap(configuration).map(Eigen::Vector2d(0.8, -0.4));

  Eigen::VectorXd expected(6);
  expected << 0.4, -0.1, 0.1, 0.0, 0.0, 0.8;  // by hand: 0.5·0.8, 0.25·(-0.4), the offset, -2·(-0.4)
  EXPECT_TRUE(output.value.isApprox(expected, 1e-15)) << output.value.transpose();
  EXPECT_TRUE(output.linear);
}

TEST(TeleopMapTest, AReadingWithinTheDeadZoneCountsAsZeroAndIsFlagged) {
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.dead_zone = 0.1;

  const TeleopOutput output = TeleopMap(configuration).map(Eigen::Vector2d(0.1, 0.4));

  EXPECT_EQ(output.value[0], 0.0) << "the edge belongs to the dead zone";
  EXPECT_EQ(output.value[1], 0.1) << "beyond the dead zone the map is the linear one, not a stretched one";
  EXPECT_FALSE(output.linear);
}

TEST(TeleopMapTest, AReadingOfExactlyZeroIsLinearInsideAnyDeadZone) {
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.dead_zone = 0.1;
  EXPECT_TRUE(TeleopMap(configuration).map(Eigen::Vector2d::Zero()).linear);
}

TEST(TeleopMapTest, SaturationCutsEachOutputByItselfAndIsFlagged) {
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.saturation = Eigen::VectorXd::Constant(6, 0.2);

  const TeleopOutput output = TeleopMap(configuration).map(Eigen::Vector2d(0.2, 0.6));

  EXPECT_DOUBLE_EQ(output.value[0], 0.1);
  EXPECT_DOUBLE_EQ(output.value[1], 0.15);
  EXPECT_DOUBLE_EQ(output.value[5], -0.2) << "-1.2 rad/s is cut, its sign kept";
  EXPECT_FALSE(output.linear);
}

TEST(TeleopMapTest, WhereItSaysLinearTheRecordedGainAndOffsetExplainTheOutput) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> reading(-1.0, 1.0);
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.dead_zone = 0.2;
  configuration.offset = Eigen::VectorXd::LinSpaced(6, -0.1, 0.1);
  configuration.saturation = Eigen::VectorXd::Constant(6, 1.0);
  const TeleopMap map(configuration);

  int linear = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::Vector2d h(reading(random), reading(random));
    const Eigen::VectorXd explained = configuration.gain * h + configuration.offset;
    const TeleopOutput output = map.map(h);
    const bool equal = output.value == explained;
    EXPECT_EQ(output.linear, equal) << "at h = " << h.transpose();
    linear += output.linear ? 1 : 0;
  }
  EXPECT_GT(linear, 50);
  EXPECT_LT(linear, 950);
}

TEST(TeleopMapTest, AReadingThatIsNotANumberMovesNothing) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const TeleopOutput output = TeleopMap(makeConfiguration()).map(Eigen::Vector2d(not_a_number, INFINITY));
  EXPECT_TRUE(output.value.isZero(0.0));
  EXPECT_FALSE(output.linear);
}

TEST(TeleopMapTest, APoseIsAPositionAndARotationVector) {
  Eigen::VectorXd output(6);
  output << 0.1, 0.2, 0.3, 0.0, 0.0, M_PI / 2;

  const Eigen::Isometry3d pose = toPose(output);

  EXPECT_TRUE(pose.translation().isApprox(Eigen::Vector3d(0.1, 0.2, 0.3)));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-15));
  EXPECT_TRUE(toPose(Eigen::VectorXd::Zero(6)).isApprox(Eigen::Isometry3d::Identity(), 0.0));
}

TEST(TeleopMapTest, TheMetadataHoldTheMapRowByRow) {
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.dead_zone = 0.05;
  configuration.saturation = Eigen::VectorXd::Constant(6, 1.0);

  const TeleopMapMetadata metadata = TeleopMap(configuration).metadata();

  EXPECT_EQ(metadata.mode, "rate");
  EXPECT_EQ(metadata.inputs, (std::vector<std::string>{"joy_axis0", "joy_axis1"}));
  EXPECT_EQ(metadata.outputs, kTwist);
  ASSERT_EQ(metadata.gain.size(), 6U);
  EXPECT_EQ(metadata.gain[5], (std::vector<double>{0.0, -2.0}));
  EXPECT_EQ(metadata.offset, std::vector<double>(6, 0.0));
  EXPECT_EQ(metadata.dead_zone, 0.05);
  EXPECT_EQ(metadata.saturation, std::vector<double>(6, 1.0));
}

TEST(TeleopMapTest, WhatCannotBeAMapIsRefusedInASentence) {
  TeleopMapConfiguration configuration = makeConfiguration();
  configuration.gain = Eigen::MatrixXd::Zero(3, 2);
  EXPECT_EQ(messageOf(configuration),
            "teleoperation map: gain is 3 x 2, expected 6 rows, one for each output, and a column for each input.");

  configuration = makeConfiguration();
  configuration.inputs.pop_back();
  EXPECT_EQ(messageOf(configuration),
            "teleoperation map: the list of inputs is 1 names long, expected 2 as the gain has columns.");

  configuration = makeConfiguration();
  configuration.offset = Eigen::VectorXd::Zero(3);
  EXPECT_EQ(messageOf(configuration), "teleoperation map: offset is 3 numbers long, expected 6 as the gain has rows.");

  configuration = makeConfiguration();
  configuration.gain(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(messageOf(configuration), "teleoperation map: gain is not finite, expected numbers.");

  configuration = makeConfiguration();
  configuration.dead_zone = -0.1;
  EXPECT_EQ(messageOf(configuration),
            "teleoperation map: dead_zone is -0.1, expected a number of at least 0 in the unit of the device.");

  configuration = makeConfiguration();
  configuration.saturation = Eigen::VectorXd::Constant(6, 1.0);
  configuration.saturation[2] = 0.0;
  EXPECT_EQ(messageOf(configuration), "teleoperation map: saturation of u_vz is 0, expected a positive magnitude.");
}

}  // namespace
}  // namespace demo_logger
