#pragma once

#include "demo_logger/channels/teleoperation.h"
#include "src/ros/parameters.h"

namespace demo_logger {

/// The names of a device's map and of how it is used (config/teleop.yaml explains each):
///   mode, enable_button, dead_zone, saturation, offset, joy_timeout, and either
///   axis_linear{x,y,z}, scale_linear, axis_angular{yaw,pitch,roll}, scale_angular, as teleop_twist_joy has them, or
///   axes, gain: the whole matrix, a row for each output, a column for each axis.
/// The map's inputs are named as the recorder's columns are when it records joy as the stream `h`: h_axis0, h_axis1, …
/// Does not reject other names: the caller may have more. Throws ConfigurationError.
TeleoperationConfiguration readTeleoperation(Parameters& parameters);

/// The map as a parameter, with the keys of the sidecar's `teleop_map`.
XmlRpc::XmlRpcValue toParameter(const TeleopMapMetadata& map);

}  // namespace demo_logger
