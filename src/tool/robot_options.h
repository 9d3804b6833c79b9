#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// --urdf, --base, --tip and --at, as every verb takes them that needs the arm.
struct RobotOptions {
  std::string urdf;
  std::string base;
  std::string tip;
  std::vector<std::string> at;
};

/// Declares them; --urdf is required.
void addRobotOptions(CLI::App& verb, RobotOptions& options);

/// What is doubtful about the description goes to standard error.
/// Throws ConfigurationError for an --at that is not JOINT=VALUE, ModelError or FileError for the description.
RobotDescription describeRobot(const RobotOptions& options);

}  // namespace demo_logger
