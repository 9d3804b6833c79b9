#include "joint_named.h"

#include "demo_logger/trajectory/error.h"
#include "near_names.h"

namespace demo_logger {

ArmJoint& jointNamed(RobotDescription& arm, const std::string& name, const std::string& purpose) {
  for (ArmJoint& joint : arm.joints) {
    if (joint.name == name) return joint;
  }
  throw ModelError("no joint '" + name + "' " + purpose + " in the arm of robot '" + arm.name +
                   "'; the nearest names are " + nearNames(name, arm.jointNames()));
}

}  // namespace demo_logger
