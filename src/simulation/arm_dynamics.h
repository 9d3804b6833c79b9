#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "bullet_dynamics.h"
#include "constraint_problem.h"
#include "joint_constraints.h"
#include "moving_chain.h"

namespace demo_logger {

/// Moves one arm by steps of semi-implicit Euler. With Bullet's acceleration a of the bare arm, one step of length h is
///   (M + h D) q̇⁺ = M (q̇ + h a) + impulses of friction and stops,     q⁺ = q + h q̇⁺
/// Viscous damping D is taken at the end of the step: taken at its beginning it would diverge once h D exceeds twice
/// the inertia of a joint (a light wrist with a stiff damper), so it only ever brakes, however large.
/// Everything about the arm is in its ArmState; this only has work space.
class ArmDynamics {
 public:
  explicit ArmDynamics(const RobotDescription& description);

  /// Adds the impulse of friction and damping [N m s or N s] to `friction_impulse`.
  void step(ArmState& state, const Eigen::VectorXd& torque, double step, Eigen::VectorXd& friction_impulse);

  /// q̈ under `torque` and gravity alone.
  Eigen::VectorXd acceleration(const ArmState& state, const Eigen::VectorXd& torque);

  Eigen::Isometry3d tipPose(const Eigen::VectorXd& q) { return bullet_.tipPose(q); }

 private:
  BulletDynamics bullet_;
  MovingChain chain_;
  JointConstraints joints_;
  ConstraintProblem problem_;
  Eigen::VectorXd damping_;
  Eigen::VectorXd acceleration_;
  Eigen::MatrixXd inertia_;
  Eigen::MatrixXd inverse_;
  Eigen::LLT<Eigen::MatrixXd> factors_;
};

}  // namespace demo_logger
