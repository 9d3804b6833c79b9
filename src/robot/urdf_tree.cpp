#include "urdf_tree.h"

#include <algorithm>
#include <sstream>

#include "demo_logger/trajectory/error.h"
#include "near_names.h"

namespace demo_logger {
namespace {

Eigen::Vector3d toEigen(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

}  // namespace

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  return Eigen::Translation3d(toEigen(pose.position)) * rotation.normalized();
}

bool isMoving(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

/// The squares of a long or short axis may overflow or vanish.
Eigen::Vector3d unitAxis(const urdf::Joint& joint) { return toEigen(joint.axis).stableNormalized(); }

Eigen::Isometry3d childInParent(const urdf::Joint& joint, double position) {
  Eigen::Isometry3d origin = toEigen(joint.parent_to_joint_origin_transform);
  if (!isMoving(joint)) return origin;
  if (joint.type == urdf::Joint::PRISMATIC) return origin * Eigen::Translation3d(position * unitAxis(joint));
  return origin * Eigen::AngleAxisd(position, unitAxis(joint));
}

BodyInertia inertiaOf(const urdf::Link& link) {
  if (!link.inertial) return {};
  const urdf::Inertial& given = *link.inertial;
  BodyInertia body;
  body.mass = given.mass;
  body.inertia << given.ixx, given.ixy, given.ixz,  //
      given.ixy, given.iyy, given.iyz,              //
      given.ixz, given.iyz, given.izz;
  const Eigen::Isometry3d X_link_inertial = toEigen(given.origin);
  body.center = X_link_inertial.translation();
  body.inertia = X_link_inertial.linear() * body.inertia * X_link_inertial.linear().transpose();
  return body;
}

void refuseUnusableJoint(const urdf::Joint& joint) {
  const bool floating = joint.type == urdf::Joint::FLOATING;
  if (floating || joint.type == urdf::Joint::PLANAR) {
    throw ModelError("joint '" + joint.name + "' is " + (floating ? "floating" : "planar") +
                     "; an arm and what hangs from it may have revolute, continuous, prismatic and fixed joints only");
  }
  if (!isMoving(joint)) return;
  if (toEigen(joint.axis).isZero(0.0)) {
    throw ModelError("joint '" + joint.name + "' has the axis 0 0 0, expected a direction such as 0 0 1");
  }
  if (joint.limits && joint.type != urdf::Joint::CONTINUOUS && joint.limits->lower > joint.limits->upper) {
    std::ostringstream sentence;
    sentence << "joint '" << joint.name << "' has its limits swapped: lower " << joint.limits->lower << ", upper "
             << joint.limits->upper << (joint.type == urdf::Joint::PRISMATIC ? " m" : " rad");
    throw ModelError(sentence.str());
  }
}

urdf::LinkConstSharedPtr findLink(const urdf::ModelInterface& model, const std::string& name) {
  if (auto link = model.getLink(name)) return link;
  std::vector<std::string> names;
  for (const auto& [known, link] : model.links_) names.push_back(known);
  throw ModelError("no link '" + name + "' in robot '" + model.getName() + "' of " + std::to_string(names.size()) +
                   " links; the nearest names are " + nearNames(name, names));
}

urdf::LinkConstSharedPtr onlyLeaf(const urdf::ModelInterface& model) {
  std::vector<std::string> leaves;
  for (const auto& [name, link] : model.links_) {
    if (link->child_links.empty()) leaves.push_back(name);
  }
  if (leaves.size() == 1) return model.getLink(leaves.front());
  throw ModelError("robot '" + model.getName() + "' ends in several links, so the tip must be named; choose among " +
                   quotedList(leaves));
}

std::vector<urdf::JointConstSharedPtr> jointsBetween(const urdf::ModelInterface& model,
                                                     const urdf::LinkConstSharedPtr& base,
                                                     const urdf::LinkConstSharedPtr& tip) {
  std::vector<urdf::JointConstSharedPtr> joints;
  std::vector<std::string> above;
  for (urdf::LinkConstSharedPtr link = tip; link->name != base->name; link = model.getLink(above.back())) {
    if (!link->parent_joint) {
      throw ModelError("tip '" + tip->name + "' is not below base '" + base->name + "'" +
                       (above.empty() ? ": it is the root of robot '" + model.getName() + "'"
                                      : "; links above the tip: " + quotedList(above)));
    }
    joints.push_back(link->parent_joint);
    above.push_back(link->parent_joint->parent_link_name);
  }
  std::reverse(joints.begin(), joints.end());
  return joints;
}

}  // namespace demo_logger
