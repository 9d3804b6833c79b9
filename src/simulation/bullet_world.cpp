#include "bullet_world.h"

#include <utility>

namespace demo_logger {
namespace {

// [(rad/s) / (N m)] A joint held by its friction and its stop at once is held twice; without a trace of softness the
// exact solver finds no answer to that. Stiction then creeps by 1e-12 rad in 2 s.
constexpr double kSoftness = 1e-12;

/// Bullet sets several megabytes aside for contacts; there are none.
btDefaultCollisionConstructionInfo noContacts() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 1;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 1;
  return info;
}

Eigen::Isometry3d toEigen(const btTransform& transform) {
  const btVector3& p = transform.getOrigin();
  const btQuaternion q = transform.getRotation();
  return Eigen::Translation3d(p.x(), p.y(), p.z()) * Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized();
}

}  // namespace

BulletWorld::BulletWorld(const RobotDescription& description)
    : arm_(makeBulletBody(description)),
      X_lastlink_tip_(description.X_lastlink_tip),
      configuration_(noContacts()),
      dispatcher_(&configuration_),
      broadphase_(/*maxProxies=*/size() + 1),
      solver_(&exact_solver_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  const Eigen::Vector3d& gravity = description.gravity;
  world_.setGravity(btVector3(gravity.x(), gravity.y(), gravity.z()));
  world_.getSolverInfo().m_globalCfm = kSoftness;
  world_.addMultiBody(arm_.body.get());
  for (int link = -1; link < size(); ++link) addCollider(link);
  for (int i = 0; i < size(); ++i) {
    joints_.emplace_back(*arm_.body, i, description.joints[static_cast<std::size_t>(i)]).addTo(world_);
  }
}

BulletWorld::~BulletWorld() {
  for (JointConstraints& joint : joints_) joint.removeFrom(world_);
  for (const auto& collider : colliders_) world_.removeCollisionObject(collider.get());
  world_.removeMultiBody(arm_.body.get());
}

/// Bullet ignores the constraints of a link without a collider. These are empty and touch nothing.
void BulletWorld::addCollider(int link) {
  auto collider = std::make_unique<btMultiBodyLinkCollider>(arm_.body.get(), link);
  collider->setCollisionShape(&no_shape_);
  collider->setActivationState(DISABLE_DEACTIVATION);
  if (link < 0) {
    arm_.body->setBaseCollider(collider.get());
  } else {
    arm_.body->getLink(link).m_collider = collider.get();
  }
  world_.addCollisionObject(collider.get(), /*collisionFilterGroup=*/0, /*collisionFilterMask=*/0);
  colliders_.push_back(std::move(collider));
}

void BulletWorld::place(const ArmState& state) {
  for (int i = 0; i < size(); ++i) {
    arm_.body->setJointPos(i, state.q[i]);
    arm_.body->setJointVel(i, state.dq[i]);
  }
}

void BulletWorld::read(ArmState& state) const {
  for (int i = 0; i < size(); ++i) {
    state.q[i] = arm_.body->getJointPos(i);
    state.dq[i] = arm_.body->getJointVel(i);
  }
}

/// Joint torques last for one call of stepSimulation only; with 0 internal sub-steps it makes one step of this length.
void BulletWorld::step(const Eigen::VectorXd& torque, double step) {
  for (JointConstraints& joint : joints_) joint.prepare(step);
  for (int i = 0; i < size(); ++i) arm_.body->addJointTorque(i, torque[i]);
  world_.stepSimulation(step, /*maxSubSteps=*/0);
}

/// Bullet refreshes the links' poses lazily, one step late: ask for fresh ones.
Eigen::Isometry3d BulletWorld::tipPose() {
  arm_.body->forwardKinematics(scratch_rotations_, scratch_vectors_);
  const Eigen::Isometry3d X_base_principal = toEigen(arm_.body->getLink(size() - 1).m_cachedWorldTransform);
  return X_base_principal * arm_.X_link_principal.back().inverse() * X_lastlink_tip_;
}

/// A step of no length leaves positions and velocities alone, and the accelerations in the scratch memory behind one
/// number per joint and the base's six.
void BulletWorld::acceleration(const Eigen::VectorXd& torque, Eigen::VectorXd& result) {
  btMultiBody& body = *arm_.body;
  body.clearForcesAndTorques();
  for (int i = 0; i < size(); ++i) {
    body.addLinkForce(i, world_.getGravity() * body.getLinkMass(i));
    body.addJointTorque(i, torque[i]);
  }
  body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(
      /*dt=*/0.0, scratch_numbers_, scratch_vectors_, scratch_matrices_, /*isConstraintPass=*/false,
      /*jointFeedbackInWorldSpace=*/false, /*jointFeedbackInJointFrame=*/false);
  for (int i = 0; i < size(); ++i) result[i] = scratch_numbers_[body.getNumDofs() + 6 + i];
  body.clearForcesAndTorques();
}

}  // namespace demo_logger
