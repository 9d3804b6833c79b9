#include "src/tool/robot_options.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {

void addRobotOptions(CLI::App& verb, RobotOptions& options) {
  verb.add_option("--urdf", options.urdf, "robot description")->required();
  verb.add_option("--base", options.base, "link in whose frame the tool's pose is given (default: the root)");
  verb.add_option("--tip", options.tip, "link of the tool (default: the only leaf)");
  verb.add_option("--at", options.at, "JOINT=VALUE [rad or m] where a joint beside the chain is held, once per joint")
      ->type_size(1)
      ->allow_extra_args(false);
}

RobotDescription describeRobot(const RobotOptions& options) {
  DescriptionOptions description;
  description.base = options.base;
  description.tip = options.tip;
  for (const std::string& text : options.at) {
    const std::size_t equals = text.rfind('=');
    char* end = nullptr;
    const char* number = equals == std::string::npos ? "" : text.c_str() + equals + 1;
    const double value = std::strtod(number, &end);
    if (end == number || *end != '\0' || !std::isfinite(value) || equals == 0) {
      throw ConfigurationError("--at \"" + text +
                               "\": expected JOINT=VALUE with a position in rad or m, as in --at torso=0.3");
    }
    const std::string joint = text.substr(0, equals);
    if (!description.locked.emplace(joint, value).second) {
      throw ConfigurationError("--at says twice where joint '" + joint + "' is held, at " +
                               print(description.locked[joint]) + " and at " + print(value) +
                               " [rad or m]; expected once per joint");
    }
  }
  RobotDescription robot = describeRobotFile(options.urdf, description);
  for (const std::string& warning : robot.warnings) std::cerr << "warning: " << warning << '\n';
  return robot;
}

}  // namespace demo_logger
