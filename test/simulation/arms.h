#pragma once

#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/simulation/simulated_arm.h"

namespace demo_logger {

inline RobotDescription describeDemoArm() {
  DescriptionOptions options;
  options.base = "base_link";
  options.tip = "tool_tip";
  return describeRobotFile(std::string(DEMO_LOGGER_SOURCE_DIR) + "/urdf/demo_arm.urdf", options);
}

/// Elbow and wrist bent, tool down: away from singularities and limits.
inline std::vector<double> bentPosition() { return {0.0, 0.3, 0.0, 1.4, 0.0, 1.44, 0.0}; }

inline SimulatedArmConfiguration makeArmConfiguration(ControlMode mode) {
  SimulatedArmConfiguration configuration;
  configuration.mode = mode;
  configuration.initial_position = bentPosition();
  return configuration;
}

inline SimulatedArm makeDemoArm(ControlMode mode) { return {describeDemoArm(), makeArmConfiguration(mode)}; }

constexpr Nanoseconds kMillisecond = 1'000'000;

}  // namespace demo_logger
