#pragma once

#include "arm_kinematics.h"

namespace demo_logger {

/// The largest velocity for the next step of length dt after which a joint can come to rest within `distance`, however
/// long the steps then are. Mean velocities of consecutive steps differ by at most the acceleration times the mean of
/// the two lengths, so the joint moves as if it braked evenly from the middle of this step on:
///   v dt + (v − a dt/2)²/(2 a) = distance
double brakingVelocity(double distance, double acceleration, double dt);

/// Bounds for the next displacement of each joint [rad or m].
struct MotionBox {
  JointVector lower;
  JointVector upper;
};

/// What velocity, acceleration and position limits leave of the next step. A joint's velocity is its displacement over
/// the step's length; velocities of consecutive steps may differ by the acceleration limit times the mean of the two
/// lengths; and the joint must be able to stop before its position limits.
class MotionLimits {
 public:
  /// `max_velocity` caps those of the joints; `max_acceleration` holds for each [rad/s² or m/s²].
  MotionLimits(const RobotDescription& robot, double max_velocity, double max_acceleration);

  const JointVector& lower() const { return lower_; }
  const JointVector& upper() const { return upper_; }
  const JointVector& velocity() const { return velocity_; }
  /// The same with a number for joints without a limit, to compute with.
  JointVector finiteVelocity() const { return velocity_.cwiseMin(kFastest); }
  double acceleration() const { return acceleration_; }

  /// Never empty if the steps before kept to theirs; the lengths of steps may differ as they like.
  void box(const JointVector& q, const JointVector& velocity, double previous_dt, double dt, MotionBox& box) const;

 private:
  static constexpr double kFastest = 1e3;  // [rad/s or m/s] of a joint without a limit

  JointVector lower_, upper_;
  JointVector velocity_;
  double acceleration_;
};

}  // namespace demo_logger
