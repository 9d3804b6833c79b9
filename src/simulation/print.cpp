#include "print.h"

namespace demo_logger {
namespace {

bool slides(const ArmJoint& joint) { return joint.type == JointType::prismatic; }

}  // namespace

std::string printPosition(const ArmJoint& joint, double position) {
  return print(position) + (slides(joint) ? " m" : " rad");
}

std::string printVelocity(const ArmJoint& joint, double velocity) {
  return print(velocity) + (slides(joint) ? " m/s" : " rad/s");
}

std::string printEffort(const ArmJoint& joint, double effort) {
  return print(effort) + (slides(joint) ? " N" : " N m");
}

}  // namespace demo_logger
