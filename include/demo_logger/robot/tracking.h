#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <memory>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

struct TrackingOptions {
  double max_velocity = std::numeric_limits<double>::infinity();  // [rad/s or m/s] caps the joints' own limits
  double max_acceleration = 10.0;                                 // [rad/s² or m/s²] of each joint
  double tolerance = 1e-3;  // [m] and [rad] within which a target counts as tracked
  // [s] that a target must have been out of reach from where the arm is, but not from another posture, before the arm
  // goes there through joint space, which leads the tip away from the target for a while. At once if the target
  // jumped. Infinity: never.
  double patience = std::numeric_limits<double>::infinity();
};

enum class TrackingStatus {
  tracked,        // within the tolerance
  speed_limited,  // could be reached, but not yet: velocity or acceleration is at its limit, or another posture is
                  // needed
  at_limit,       // joints stand at their position limits
  unreachable     // beyond the arm's reach in every posture, as far as a search tells; or no pose at all
};

/// The word used in files: "tracked", "speed_limited", ….
const char* toString(TrackingStatus status);

struct TrackedStep {
  TrackingStatus status = TrackingStatus::unreachable;
  double position_error = 0.0;  // [m]; NaN where the target was no pose
  double rotation_error = 0.0;  // [rad]
  bool in_reach = false;        // by moving on from the present posture, however long that takes
};

/// Follows a moving target pose of the tip, one step at a time, with a motion that the arm can make. Each step
/// minimises the pose error at its end among the displacements Δq that keep
///   lower ≤ q ≤ upper,   |Δq / dt| ≤ velocity limit,   |Δq / dt − the step before's| ≤ max_acceleration dt
/// (dt there being the mean of the two steps' lengths)
/// and from which the arm can still stop before its position limits. The limits hold whatever the target does. In what
/// the target leaves open (a seventh joint, a singular posture) the arm moves on smoothly and away from its limits.
/// Out of reach, position comes before orientation. Continuous joints are never wrapped. A step is local: what can only
/// be reached with another elbow is out of reach, unless `patience` lets the arm change over.
///
/// All state is in the object; nothing is allocated in a step; the number of iterations is bounded.
class Tracker {
 public:
  /// Throws ConfigurationError for limits that are not positive, ModelError for an arm with more than 32 joints.
  explicit Tracker(const RobotDescription& robot, const TrackingOptions& options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// At rest at `q`, moved to the limits if it is beyond. Throws ModelError if it is not of size n or not finite.
  void reset(const Eigen::VectorXd& q);

  /// Moves on by `dt` [s]. A target that is not finite or not a rigid pose makes the arm slow down. Steps may
  /// differ in length. Throws ConfigurationError for a dt that is not positive.
  TrackedStep step(const Eigen::Isometry3d& X_base_target, double dt);

  /// How well the arm as it stands meets a target, without moving: for the first row of a path.
  TrackedStep stay(const Eigen::Isometry3d& X_base_target);

  /// What to do with the freedom that the next target leaves, instead of keeping away from limits by itself: be at
  /// `posture`, moving with `velocity`, at the end of the next step (robot/posture_plan.h). Forgotten after the step.
  void prefer(const Eigen::VectorXd& posture, const Eigen::VectorXd& velocity);

  /// Where it is now: the middle of the ranges before the first reset.
  const Eigen::VectorXd& q() const;
  /// [rad/s or m/s] mean velocity of the last step.
  const Eigen::VectorXd& velocity() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
