#pragma once

#include "arm_kinematics.h"

namespace demo_logger {

/// The largest velocity for the next step of length dt from which a joint comes to rest within `distance`, slowing
/// down by at most `acceleration` from step to step:
///   dt Σ_{j ≥ 0} max(0, v − j a dt) = distance
double brakingVelocity(double distance, double acceleration, double dt);

/// Bounds for the next displacement of each joint [rad or m].
struct MotionBox {
  JointVector lower;
  JointVector upper;
};

/// What velocity, acceleration and position limits leave of the next step. A joint's velocity is its displacement over
/// the step's length; velocities of consecutive steps may differ by the acceleration limit times the mean of the two
/// lengths; and the joint must be able to stop before its position limits with steps of this length.
class MotionLimits {
 public:
  /// `max_velocity` caps those of the joints; `max_acceleration` holds for each [rad/s² or m/s²].
  MotionLimits(const RobotDescription& robot, double max_velocity, double max_acceleration);

  const JointVector& lower() const { return lower_; }
  const JointVector& upper() const { return upper_; }
  const JointVector& velocity() const { return velocity_; }
  double acceleration() const { return acceleration_; }

  /// False if nothing is left, which happens only when a step is longer than the one before; then the position limit
  /// wins over the acceleration.
  bool box(const JointVector& q, const JointVector& velocity, double previous_dt, double dt, MotionBox& box) const;

 private:
  JointVector lower_, upper_;
  JointVector velocity_;
  double acceleration_;
};

}  // namespace demo_logger
