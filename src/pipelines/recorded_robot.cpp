#include "demo_logger/pipelines/recorded_robot.h"

#include <algorithm>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

void recordRobot(const RobotDescription& robot, RecorderConfiguration& configuration) {
  SynchroniserConfiguration& synchroniser = configuration.synchroniser;
  if (synchroniser.joints.empty()) {
    synchroniser.joints = robot.jointNames();
  }
  const std::vector<std::string>& recorded = synchroniser.joints;
  for (const ArmJoint& joint : robot.joints) {
    if (std::find(recorded.begin(), recorded.end(), joint.name) == recorded.end()) {
      throw ConfigurationError("joints: '" + joint.name + "' is not among them, which the arm from " + robot.base +
                               " to " + robot.tip + " has; add it, or leave out the list for all of the arm's.");
    }
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
