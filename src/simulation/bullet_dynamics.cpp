#include "bullet_dynamics.h"

namespace demo_logger {
namespace {

Eigen::Isometry3d toEigen(const btTransform& transform) {
  const btVector3& p = transform.getOrigin();
  const btQuaternion q = transform.getRotation();
  return Eigen::Translation3d(p.x(), p.y(), p.z()) * Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized();
}

}  // namespace

BulletDynamics::BulletDynamics(const RobotDescription& description)
    : arm_(makeBulletBody(description)),
      X_lastlink_tip_(description.X_lastlink_tip),
      gravity_(description.gravity.x(), description.gravity.y(), description.gravity.z()) {}

/// A step of no length leaves positions and velocities alone, and the accelerations in the scratch memory behind one
/// number per joint and the base's six.
void BulletDynamics::acceleration(const ArmState& state, const Eigen::VectorXd& torque, Eigen::VectorXd& result) {
  btMultiBody& body = *arm_.body;
  body.clearForcesAndTorques();
  for (int i = 0; i < size(); ++i) {
    body.setJointPos(i, state.q[i]);
    body.setJointVel(i, state.dq[i]);
    body.addLinkForce(i, gravity_ * body.getLinkMass(i));
    body.addJointTorque(i, torque[i]);
  }
  body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(
      /*dt=*/0.0, scratch_numbers_, scratch_vectors_, scratch_matrices_, /*isConstraintPass=*/false,
      /*jointFeedbackInWorldSpace=*/false, /*jointFeedbackInJointFrame=*/false);
  result.resize(size());
  for (int i = 0; i < size(); ++i) result[i] = scratch_numbers_[body.getNumDofs() + 6 + i];
}

Eigen::Isometry3d BulletDynamics::tipPose(const Eigen::VectorXd& q) {
  for (int i = 0; i < size(); ++i) arm_.body->setJointPos(i, q[i]);
  arm_.body->forwardKinematics(scratch_rotations_, scratch_vectors_);
  const Eigen::Isometry3d X_base_principal = toEigen(arm_.body->getLink(size() - 1).m_cachedWorldTransform);
  return X_base_principal * arm_.X_link_principal.back().inverse() * X_lastlink_tip_;
}

}  // namespace demo_logger
