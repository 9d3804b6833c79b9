#pragma once

#include "demo_logger/recording/recorder.h"
#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// Makes a recording that of `robot`: its joints, unless some are listed already, which of them are prismatic, and
/// what the sidecar says of it. Throws ConfigurationError if those listed lack one of the robot's: whatever is computed
/// from its pose would be missing in every row.
void recordRobot(const RobotDescription& robot, RecorderConfiguration& configuration);

}  // namespace demo_logger
