#include "demo_logger/simulation/simulated_human.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "demo_logger/trajectory/error.h"
#include "test/simulation/teleoperated_arm.h"

namespace demo_logger {
namespace {

/// The readings of a human who sees the tool always where it was: all that they do is their own.
std::vector<DeviceReading> blindReadings(std::uint64_t seed, double tremor = 0.005) {
  SimulatedHumanConfiguration configuration;
  configuration.device = makeSixAxisDevice();
  configuration.seed = seed;
  configuration.tremor = tremor;
  configuration.start_button = 1;
  configuration.stop_button = 2;
  SimulatedHuman human(configuration);
  std::vector<DeviceReading> readings;
  while (!human.finished()) {
    readings.push_back(
        human.next(static_cast<Nanoseconds>(readings.size()) * 20 * kMillisecond, Eigen::Isometry3d::Identity()));
  }
  return readings;
}

TEST(SimulatedHumanTest, TheSameSeedGivesTheSameReadingsBitForBit) {
  const std::vector<DeviceReading> first = blindReadings(5);
  const std::vector<DeviceReading> again = blindReadings(5);
  const std::vector<DeviceReading> other = blindReadings(6);
  ASSERT_EQ(first.size(), again.size());
  bool same_as_other = first.size() == other.size();
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].axes, again[i].axes);
    EXPECT_EQ(first[i].buttons, again[i].buttons);
    if (same_as_other) same_as_other = first[i].axes == other[i].axes;
  }
  EXPECT_FALSE(same_as_other);
}

TEST(SimulatedHumanTest, PressesStartThenEnableThenStopAndRestsAtBothEnds) {
  const std::vector<DeviceReading> readings = blindReadings(1);
  enum Phase { before, started, enabled, released, stopped };
  Phase phase = before;
  for (const DeviceReading& reading : readings) {
    if (reading.buttons[1] == 1) {
      EXPECT_LE(phase, started);
      phase = started;
    }
    if (reading.buttons[0] == 1) {
      EXPECT_TRUE(phase == started || phase == enabled);
      phase = enabled;
    } else {
      EXPECT_TRUE(std::all_of(reading.axes.begin(), reading.axes.end(), [](double axis) { return axis == 0.0; }));
      if (phase == enabled) phase = released;
    }
    if (reading.buttons[2] == 1) {
      EXPECT_GE(phase, released);
      phase = stopped;
    }
  }
  EXPECT_EQ(phase, stopped);
  EXPECT_NEAR(static_cast<double>(readings.size()) * 0.02, 20.5, 2.0) << "[s], way-points are up to a tenth faster";
}

TEST(SimulatedHumanTest, AxesStayInRangeOnTheirStepsAndTheHandWithinItsRate) {
  const std::vector<DeviceReading> readings = blindReadings(2, /*tremor=*/0.0);
  bool moved = false;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const double value = readings[i].axes[axis];
      EXPECT_LE(std::abs(value), 1.0);
      EXPECT_EQ(value * 512.0, std::round(value * 512.0)) << "ten bits";
      EXPECT_LE(std::abs(value - readings[i - 1].axes[axis]), 4.0 * 0.02 + 1.0 / 512.0);
      moved = moved || value != 0.0;
    }
  }
  EXPECT_TRUE(moved);
}

TEST(SimulatedHumanTest, ReactsToWhatItSeesOneReactionDelayLater) {
  // The tool is pushed aside at reading 200, in the midst of the task: until a reaction delay of 0.2 s, ten readings,
  // has passed, the human does what one does who saw nothing.
  const auto read = [](bool pushed) {
    SimulatedHumanConfiguration configuration;
    configuration.device = makeSixAxisDevice();
    SimulatedHuman human(configuration);
    std::vector<std::vector<double>> axes;
    for (int i = 0; i < 250; ++i) {
      Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
      if (pushed && i >= 200) tool.translation().x() = 0.05;
      axes.push_back(human.next(0, tool).axes);
    }
    return axes;
  };
  const auto calm = read(false);
  const auto disturbed = read(true);
  for (std::size_t i = 0; i < 210; ++i) EXPECT_EQ(calm[i], disturbed[i]) << "reading " << i;
  EXPECT_LT(disturbed[212][0], calm[212][0] - 0.05) << "pulls back against the push along x";
}

TEST(SimulatedHumanTest, BringsTheToolToEachWayPointWithinAHandsAccuracy) {
  const RobotModel model(describeDemoArm());
  SimulatedHumanConfiguration configuration;
  std::vector<Eigen::Vector3d> path;
  teleoperate(configuration, [&](const TeleoperatedTick& tick) {
    path.push_back(model.forwardKinematics(tick.arm.truth.q).translation());
  });
  const double accuracy = 0.03;  // [m]: a centimetre on each axis is drawn from the seed, the rest is the hand's
  for (const Waypoint& waypoint : teleoperationTask()) {
    const Eigen::Vector3d goal = path.front() + waypoint.shift;
    double nearest = 1.0;
    for (const Eigen::Vector3d& position : path) nearest = std::min(nearest, (position - goal).norm());
    EXPECT_LT(nearest, accuracy) << "way-point " << waypoint.shift.transpose();
  }
}

TEST(SimulatedHumanTest, TeleoperationGivesTheSameDemonstrationFromTheSameSeed) {
  const auto run = [] {
    SimulatedHumanConfiguration configuration;
    configuration.task = {{{0.0, 0.1, 0.0}, {0.0, 0.0, 0.0}, 1.0}};
    std::vector<double> positions;
    teleoperate(configuration, [&](const TeleoperatedTick& tick) { positions.push_back(tick.arm.truth.q.sum()); });
    return positions;
  };
  EXPECT_EQ(run(), run());
}

TEST(SimulatedHumanTest, WhatNoHumanIsIsRefused) {
  SimulatedHumanConfiguration configuration;
  configuration.device = makeSixAxisDevice();
  configuration.reaction_delay = 1.0;
  try {
    SimulatedHuman human(configuration);
    FAIL() << "a second of reaction delay was taken";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(),
                 "simulated human: reaction_delay is 1, expected from 0 to 0.5 s; a slower eye makes the hand "
                 "oscillate.");
  }
  configuration = {};
  configuration.device = makeSixAxisDevice();
  configuration.device.map.mode = TeleopMode::pose;
  EXPECT_THROW(SimulatedHuman{configuration}, ConfigurationError);
}

}  // namespace
}  // namespace demo_logger
