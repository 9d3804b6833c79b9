#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "bullet_dynamics.h"
#include "constraint_problem.h"
#include "contact_finder.h"
#include "joint_constraints.h"
#include "moving_chain.h"

namespace demo_logger {

/// What acts on an arm during a step, besides gravity.
struct ArmLoads {
  const Eigen::VectorXd& torque;  // of the motors
  const std::vector<LinkWrench>& wrenches;
};

/// Moves one arm by steps of length h. Semi-implicit Euler, with Bullet's acceleration a of the bare arm:
///   (M + B + h D) q̇⁺ = M (q̇ + h a) + B q̇ + impulses of friction, stops and contacts,     q⁺ = q + h q̇⁺
/// Viscous damping D is taken at the end of the step: taken at its beginning it would diverge once h D exceeds twice
/// the inertia of a joint (a light wrist with a stiff damper), so it only ever brakes, however large.
/// Everything about the arm is in its ArmState; this only has work space.
class ArmDynamics {
 public:
  ArmDynamics(const RobotDescription& description, const Surroundings& surroundings);

  void stepEuler(ArmState& state, const ArmLoads& loads, double step);
  void stepRungeKutta(ArmState& state, const ArmLoads& loads, double step);

  /// Impulse [N m s or N s] of friction and damping in the last step.
  const Eigen::VectorXd& frictionImpulse() const { return friction_impulse_; }
  /// Between gears and links, mean over the last step [N m or N].
  const Eigen::VectorXd& linkTorque() const { return link_torque_; }
  const std::vector<Contact>& contacts() const { return contacts_; }
  std::vector<Contact> overlaps(const Eigen::VectorXd& q);

  /// q̈ under `torque` and gravity alone.
  Eigen::VectorXd acceleration(const ArmState& state, const Eigen::VectorXd& torque);
  Eigen::VectorXd externalTorque(const Eigen::VectorXd& q, const std::vector<LinkWrench>& wrenches);
  Eigen::Isometry3d tipPose(const Eigen::VectorXd& q) { return bullet_.tipPose(q); }

 private:
  void addExternalTorque(const std::vector<LinkWrench>& wrenches, Eigen::VectorXd& torque) const;
  void addContactRows(double step);
  void applyConstraints(ArmState& state, double step);
  Eigen::VectorXd smoothFriction(const Eigen::VectorXd& dq) const;
  Eigen::VectorXd smoothAcceleration(const ArmState& state, const ArmLoads& loads);

  BulletDynamics bullet_;
  MovingChain chain_;
  JointConstraints joints_;
  ContactFinder finder_;
  ConstraintProblem problem_;
  double contact_friction_;
  Eigen::VectorXd damping_, motor_inertia_, coulomb_, coulomb_velocity_;
  bool bare_;  // neither damping nor motor inertia
  Eigen::VectorXd friction_impulse_, link_torque_;
  std::vector<Contact> contacts_;
  std::vector<int> contact_rows_;
  Eigen::VectorXd acceleration_, total_, before_, direction_;
  Eigen::MatrixXd inertia_, inverse_;
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace demo_logger
