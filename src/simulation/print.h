#pragma once

#include <string>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {

/// "1.5 rad", "0.2 m/s", "12 N m": a quantity of this joint with the unit that its type gives it.
std::string printPosition(const ArmJoint& joint, double position);
std::string printVelocity(const ArmJoint& joint, double velocity);
std::string printEffort(const ArmJoint& joint, double effort);

}  // namespace demo_logger
