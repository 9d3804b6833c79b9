#pragma once

#include <string>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// The arm's joint of that name. Throws ModelError naming the nearest ones; `purpose` says what it was wanted for, as
/// in "to drive".
ArmJoint& jointNamed(RobotDescription& arm, const std::string& name, const std::string& purpose);

}  // namespace demo_logger
