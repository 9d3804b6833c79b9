#pragma once

#include "arm_kinematics.h"
#include "box_least_squares.h"
#include "motion_limits.h"

namespace demo_logger {

/// What a displacement should be where its target leaves it open.
struct StepWishes {
  JointVector displacement;  // [rad or m] wanted …
  double weight = 0.0;       // … with this weight, small beside the target's
  JointVector calm;          // what it is kept close to …
  double calming = 0.0;      // … with this weight: where the linear model is far from the target's surface
  double rotation = 1.0;     // weight of the rotation error against the position error
};

/// Least squares for one step of the arm, by Gauss-Newton with exact bounds:
///   minimise ‖W (target ⊖ FK(q + x))‖² + weight ‖x − displacement‖² + calming ‖x − calm‖²,  lower ≤ x ≤ upper
/// W makes metres comparable to radians by half the arm's reach. Keeps work space, but no state between calls other
/// than the last linearisation.
class StepSolver {
 public:
  explicit StepSolver(const RobotDescription& robot);

  const ArmKinematics& kinematics() const { return kinematics_; }

  /// target ⊖ FK(q): position [m] and rotation [rad] error in base axes.
  Vector6 errorAt(const RigidPose& target, const JointVector& q);
  /// The length of an error as `approach` weighs it.
  double weighed(const Vector6& error, double rotation) const;

  /// Improves `x`, which is within `box`, by at most `iterations`.
  void approach(const RigidPose& target, const JointVector& q, const StepWishes& wishes, const MotionBox& box,
                int iterations, JointVector& x);

  /// The displacement that moves the tip by `twist` (position [m], rotation [rad]), linearised where approach() was
  /// last.
  void follow(const Vector6& twist, const StepWishes& wishes, const MotionBox& box, JointVector& x);

  /// How far the tip is from postures in which it cannot move in some direction: log sqrt det J Jᵀ, weighed.
  double logDexterity(const JointVector& q);

 private:
  void weigh(double rotation);
  void formHessian(double damping);

  ArmKinematics kinematics_;
  double per_metre_;
  RigidPose pose_;
  JacobianMatrix jacobian_;
  Vector6 error_;
  SquareMatrix hessian_;
  JointVector gradient_, change_;
  MotionBox left_;
};

}  // namespace demo_logger
