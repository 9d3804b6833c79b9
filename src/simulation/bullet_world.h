#pragma once

#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>

#include <deque>
#include <memory>
#include <vector>

#include "bullet_body.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "joint_constraints.h"

namespace demo_logger {

/// Bullet's world with one arm in it, and nothing to touch.
class BulletWorld {
 public:
  explicit BulletWorld(const RobotDescription& description);
  ~BulletWorld();
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  int size() const { return arm_.body->getNumLinks(); }

  void place(const ArmState& state);
  void read(ArmState& state) const;
  void step(const Eigen::VectorXd& torque, double step);

  /// Impulse [N m s or N s] of Coulomb friction at joint i in the last step.
  double frictionImpulse(int i) { return joints_[static_cast<std::size_t>(i)].frictionImpulse(); }

  Eigen::Isometry3d tipPose();

  /// q̈ under `torque` and gravity alone.
  void acceleration(const Eigen::VectorXd& torque, Eigen::VectorXd& result);

 private:
  void addCollider(int link);

  // Destroyed in reverse order: Bullet's world before what it points at.
  BulletBody arm_;
  Eigen::Isometry3d X_lastlink_tip_;
  btEmptyShape no_shape_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::deque<JointConstraints> joints_;  // stay where they are made
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSimpleBroadphase broadphase_;
  // Friction and stops of all joints are solved exactly. Bullet's usual sweeps from joint to joint leave an arm at rest
  // creeping (2e-4 rad in 2 s with the default of 10) and take longer once there are enough of them.
  btDantzigSolver exact_solver_;
  btMultiBodyMLCPConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_;
  btAlignedObjectArray<btScalar> scratch_numbers_;
  btAlignedObjectArray<btVector3> scratch_vectors_;
  btAlignedObjectArray<btMatrix3x3> scratch_matrices_;
  btAlignedObjectArray<btQuaternion> scratch_rotations_;
};

}  // namespace demo_logger
