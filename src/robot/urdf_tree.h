#pragma once

#include <urdf_model/model.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

bool isMoving(const urdf::Joint& joint);  // revolute, continuous or prismatic

/// A rotation that is not normalised is made so.
Eigen::Isometry3d toEigen(const urdf::Pose& pose);

/// Pose of the child link in the parent link with the joint at `position` [rad or m].
Eigen::Isometry3d childInParent(const urdf::Joint& joint, double position);

/// Unit axis in the joint frame.
Eigen::Vector3d unitAxis(const urdf::Joint& joint);

/// Mass properties in the link frame; nothing if the link states none.
BodyInertia inertiaOf(const urdf::Link& link);

/// Throws ModelError if an arm with this joint, in its chain or hanging from it, cannot be described: floating or
/// planar, no axis, lower limit above the upper.
void refuseUnusableJoint(const urdf::Joint& joint);

/// Throws ModelError offering near names.
urdf::LinkConstSharedPtr findLink(const urdf::ModelInterface& model, const std::string& name);

/// The link without children; throws ModelError naming them if there are several.
urdf::LinkConstSharedPtr onlyLeaf(const urdf::ModelInterface& model);

/// The joints from `base` out to `tip`, in order. Throws ModelError if the tip is not below the base.
std::vector<urdf::JointConstSharedPtr> jointsBetween(const urdf::ModelInterface& model,
                                                     const urdf::LinkConstSharedPtr& base,
                                                     const urdf::LinkConstSharedPtr& tip);

}  // namespace demo_logger
