#pragma once

#include <optional>

#include "demo_logger/trajectory/metadata.h"
#include "src/ros/parameters.h"

namespace demo_logger {

/// The teleoperation node leaves the map in force on the parameter server, under the keys of the sidecar: mode, inputs,
/// outputs, gain, offset, dead_zone, saturation. Throws ConfigurationError where the sizes or types do not fit.
TeleopMapMetadata parseTeleopMap(Parameters parameters);

/// `teleop_map` in the namespace of `node`; nothing where nobody has set it.
std::optional<TeleopMapMetadata> readTeleopMap(const ros::NodeHandle& node);

}  // namespace demo_logger
