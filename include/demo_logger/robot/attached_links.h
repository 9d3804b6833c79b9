#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// A simple solid, centred in its frame. Cylinders stand along z.
struct CollisionShape {
  enum class Kind { box, sphere, cylinder };
  Kind kind = Kind::box;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // [m] box: its edges; sphere: radius; cylinder: radius, length
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // in the frame of what it belongs to
};

/// Any link of the URDF as a part of the arm.
struct AttachedLink {
  std::string name;
  int joint = -1;  // of the RobotDescription, whose link it moves with; -1: with the base
  Eigen::Isometry3d X_body_link = Eigen::Isometry3d::Identity();  // in that joint's link, or in the base
  std::vector<CollisionShape> shapes;                             // in the frame of this link
  bool has_mesh = false;                                          // a collision mesh, which no shape stands for
};

/// Every link that `describeRobot` lumped, with what it was made from. Throws ModelError as describeRobot does.
std::vector<AttachedLink> attachedLinks(const std::string& urdf_xml, const DescriptionOptions& options);

}  // namespace demo_logger
