#pragma once

#include "demo_logger/recording/recorder.h"
#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// Makes a recording that of `robot`: its joints, unless others are listed already, which of them are prismatic, and
/// what the sidecar says of it.
void recordRobot(const RobotDescription& robot, RecorderConfiguration& configuration);

}  // namespace demo_logger
