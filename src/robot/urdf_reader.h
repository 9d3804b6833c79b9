#pragma once

#include <urdf_world/types.h>

#include <string>

namespace demo_logger {

/// Parses URDF text with urdfdom, whose console messages are caught and become part of the error. Throws ModelError:
/// empty text, an unexpanded xacro file, malformed XML, anything urdfdom refuses, links that hang in a loop.
urdf::ModelInterfaceSharedPtr parseUrdf(const std::string& xml);

}  // namespace demo_logger
