#pragma once

#include <urdf_world/types.h>

#include <map>
#include <string>

namespace demo_logger {

struct ParsedUrdf {
  urdf::ModelInterfaceSharedPtr model;
  /// Why the <inertial> of a link could not be read, by link: urdfdom goes on as if the link had none, or half of one.
  std::map<std::string, std::string> unread_inertia;
};

/// Parses URDF text with urdfdom, whose console messages are caught and become part of the error. Throws ModelError:
/// empty text, a xacro file or what is left of its macros, malformed XML, elements nested too deeply, more links than a
/// robot has, anything urdfdom refuses, links that hang in a loop.
ParsedUrdf parseUrdf(const std::string& xml);

}  // namespace demo_logger
