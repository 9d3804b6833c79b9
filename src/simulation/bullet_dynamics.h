#pragma once

#include <LinearMath/btAlignedObjectArray.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "bullet_body.h"
#include "demo_logger/simulation/bullet_arm.h"

namespace demo_logger {

/// Bullet's forward dynamics (Featherstone's articulated-body algorithm) of one arm, used without Bullet's world. A
/// world would spend most of its time on islands, broad phase and a general constraint solver that one arm has no use
/// for.
class BulletDynamics {
 public:
  explicit BulletDynamics(const RobotDescription& description);

  /// q̈ at `state` under `torque` and gravity; motor inertia, friction, stops and contacts are the caller's.
  void acceleration(const ArmState& state, const Eigen::VectorXd& torque, Eigen::VectorXd& result);

  /// X_base_tip as Bullet sees it.
  Eigen::Isometry3d tipPose(const Eigen::VectorXd& q);

 private:
  int size() const { return arm_.body->getNumLinks(); }

  BulletBody arm_;
  Eigen::Isometry3d X_lastlink_tip_;
  btVector3 gravity_;
  btAlignedObjectArray<btScalar> scratch_numbers_;
  btAlignedObjectArray<btVector3> scratch_vectors_;
  btAlignedObjectArray<btMatrix3x3> scratch_matrices_;
  btAlignedObjectArray<btQuaternion> scratch_rotations_;
};

}  // namespace demo_logger
