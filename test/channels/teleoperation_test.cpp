#include "demo_logger/channels/teleoperation.h"

#include <gtest/gtest.h>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

/// Axis 1 of the device drives vx with 0.5 m/s; button 2 enables; a reading older than 0.2 s stops.
TeleoperationConfiguration makeConfiguration() {
  TeleoperationConfiguration configuration;
  configuration.map.inputs = {"joy_axis1"};
  configuration.map.outputs = {"u_vx", "u_vy", "u_vz", "u_wx", "u_wy", "u_wz"};
  configuration.map.gain = Eigen::MatrixXd::Zero(6, 1);
  configuration.map.gain(0, 0) = 0.5;
  configuration.map.offset = Eigen::VectorXd::Zero(6);
  configuration.axes = {1};
  configuration.enable_button = 2;
  configuration.timeout = 0.2;
  return configuration;
}

DeviceReading makeReading(Nanoseconds time, double axis, bool enabled) {
  return {time, time, {0.0, axis}, {0, 0, enabled ? 1 : 0}};
}

TEST(TeleoperationTest, EachReadingGivesOneCommandWithTheStampOfTheReading) {
  Teleoperation teleoperation(makeConfiguration());

  const auto command = teleoperation.receive(makeReading(40 * kMillisecond, 0.8, true));

  ASSERT_TRUE(command);
  EXPECT_EQ(command->stamp, 40 * kMillisecond);
  EXPECT_DOUBLE_EQ(command->output.value[0], 0.4);
}

TEST(TeleoperationTest, NothingIsSentBeforeTheEnableButtonIsHeld) {
  Teleoperation teleoperation(makeConfiguration());
  EXPECT_FALSE(teleoperation.receive(makeReading(0, 1.0, false)));
  EXPECT_FALSE(teleoperation.expire(10'000 * kMillisecond));
}

TEST(TeleoperationTest, LettingTheButtonGoSendsOneZeroAndThenSilence) {
  Teleoperation teleoperation(makeConfiguration());
  teleoperation.receive(makeReading(0, 1.0, true));

  const auto stop = teleoperation.receive(makeReading(20 * kMillisecond, 1.0, false));
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->stamp, 20 * kMillisecond);
  EXPECT_TRUE(stop->output.value.isZero(0.0));
  EXPECT_FALSE(teleoperation.receive(makeReading(40 * kMillisecond, 1.0, false)));
}

TEST(TeleoperationTest, ASilentDeviceIsStoppedOnceAtTheTimeoutAndNotBefore) {
  Teleoperation teleoperation(makeConfiguration());
  teleoperation.receive(makeReading(1000 * kMillisecond, 1.0, true));

  EXPECT_FALSE(teleoperation.expire(1199 * kMillisecond));
  const auto stop = teleoperation.expire(1200 * kMillisecond);
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->stamp, 1200 * kMillisecond);
  EXPECT_TRUE(stop->output.value.isZero(0.0));
  EXPECT_FALSE(teleoperation.expire(1300 * kMillisecond));
}

TEST(TeleoperationTest, TheStopOfASilentDeviceIsStampedOnTheClockOfTheDevice) {
  Teleoperation teleoperation(makeConfiguration());
  DeviceReading reading = makeReading(5000 * kMillisecond, 1.0, true);
  reading.receipt = 1000 * kMillisecond;  // the device's clock is 4 s ahead of this one
  teleoperation.receive(reading);

  const auto stop = teleoperation.expire(1250 * kMillisecond);

  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->stamp, 5250 * kMillisecond) << "stamps of one stream must stay on one clock";
}

TEST(TeleoperationTest, AStopIsZeroEvenWhereTheMapHasAnOffset) {
  TeleoperationConfiguration configuration = makeConfiguration();
  configuration.map.offset[1] = 0.3;
  Teleoperation teleoperation(configuration);
  teleoperation.receive(makeReading(0, 1.0, true));

  const auto stop = teleoperation.receive(makeReading(20 * kMillisecond, 1.0, false));

  ASSERT_TRUE(stop);
  EXPECT_TRUE(stop->output.value.isZero(0.0));
  EXPECT_FALSE(stop->output.linear);
}

TEST(TeleoperationTest, InModePoseTheArmIsLeftAtTheLastPose) {
  TeleoperationConfiguration configuration = makeConfiguration();
  configuration.map.mode = TeleopMode::pose;
  Teleoperation teleoperation(configuration);

  EXPECT_TRUE(teleoperation.receive(makeReading(0, 1.0, true)));
  EXPECT_FALSE(teleoperation.receive(makeReading(20 * kMillisecond, 1.0, false)));
  EXPECT_FALSE(teleoperation.expire(10'000 * kMillisecond));
}

TEST(TeleoperationTest, WithoutAnEnableButtonCommandsAlwaysFlow) {
  TeleoperationConfiguration configuration = makeConfiguration();
  configuration.enable_button = -1;
  Teleoperation teleoperation(configuration);
  EXPECT_TRUE(teleoperation.receive({0, 0, {0.0, 1.0}, {}}));
}

TEST(TeleoperationTest, ADeviceWithTooFewAxesOrButtonsStopsTheArmAndSaysWhy) {
  Teleoperation teleoperation(makeConfiguration());
  teleoperation.receive(makeReading(0, 1.0, true));

  const auto stop = teleoperation.receive({20 * kMillisecond, 20 * kMillisecond, {0.5}, {0, 0, 1}});
  ASSERT_TRUE(stop);
  EXPECT_TRUE(stop->output.value.isZero(0.0));
  EXPECT_EQ(teleoperation.complaint(),
            "the device has 1 axes, but axis 1 is asked for (they count from 0); nothing moves.");

  teleoperation.receive({40 * kMillisecond, 40 * kMillisecond, {0.5, 0.5}, {1}});
  EXPECT_EQ(teleoperation.complaint(),
            "the device has 1 buttons, but enable_button is 2 (they count from 0); nothing moves.");

  teleoperation.receive(makeReading(60 * kMillisecond, 1.0, true));
  EXPECT_EQ(teleoperation.complaint(), "");
}

TEST(TeleoperationTest, WhatCannotBeIsRefusedInASentence) {
  TeleoperationConfiguration configuration = makeConfiguration();
  configuration.axes = {0, 1};
  try {
    Teleoperation teleoperation(configuration);
    FAIL() << "two axes were taken for one input";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "teleoperation: 2 axes are listed, expected 1 as the map has inputs.");
  }
  configuration = makeConfiguration();
  configuration.timeout = 0.0;
  EXPECT_THROW(Teleoperation{configuration}, ConfigurationError);
  configuration = makeConfiguration();
  configuration.axes = {-1};
  EXPECT_THROW(Teleoperation{configuration}, ConfigurationError);
}

}  // namespace
}  // namespace demo_logger
