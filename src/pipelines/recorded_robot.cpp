#include "demo_logger/pipelines/recorded_robot.h"

namespace demo_logger {

void recordRobot(const RobotDescription& robot, RecorderConfiguration& configuration) {
  SynchroniserConfiguration& synchroniser = configuration.synchroniser;
  if (synchroniser.joints.empty()) {
    synchroniser.joints = robot.jointNames();
  }
  for (const ArmJoint& joint : robot.joints) {
    if (joint.type == JointType::prismatic) {
      synchroniser.prismatic_joints.push_back(joint.name);
    }
  }
  RobotMetadata& metadata = configuration.metadata.robot;
  metadata.name = robot.name;
  metadata.urdf_sha256 = robot.urdf_sha256;
  metadata.base = robot.base;
  metadata.tip = robot.tip;
}

}  // namespace demo_logger
