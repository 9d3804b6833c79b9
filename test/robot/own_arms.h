#pragma once

#include <string>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// The arms of the package's own urdf folder: "demo_arm", "two_link".
inline std::string ownUrdf(const std::string& name) { return DEMO_LOGGER_SOURCE_DIR "/urdf/" + name + ".urdf"; }

inline RobotDescription describeOwnArm(const std::string& name) {
  DescriptionOptions options;
  options.base = "base_link";
  options.tip = "tool_tip";
  return describeRobotFile(ownUrdf(name), options);
}

}  // namespace demo_logger
