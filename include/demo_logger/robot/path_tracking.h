#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/robot/tracking.h"

namespace demo_logger {

/// Follows a path of poses that is known beforehand, as a recording is: a Tracker with foresight. What the poses leave
/// open, the elbow of a seven-joint arm above all, must be chosen with a view to what comes: the posture that is most
/// comfortable now may end at a joint limit later. So a plan is made from where the arm is, up to 20 s ahead, and made
/// anew where the path has led out of reach and the arm is back, if need be in another posture (`patience`). The plan
/// is advice; limits and errors are the Tracker's, step by step.
class PathTracker {
 public:
  using Poses = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;

  /// Starts at rest at `start` at the first of `times` [s]. Keeps references to `poses` and `times`. Throws
  /// ConfigurationError if they are not as many, or the times do not strictly increase; else as Tracker.
  PathTracker(const RobotDescription& robot, const Poses& poses, const std::vector<double>& times,
              const Eigen::VectorXd& start, const TrackingOptions& options = {});
  ~PathTracker();
  PathTracker(PathTracker&&) noexcept;
  PathTracker& operator=(PathTracker&&) noexcept;

  /// Whether the next step will make a plan first, which takes some 5 µs per millisecond planned.
  bool needsPlan() const;
  void plan();

  /// The next row: at the first the arm still rests at the start. To be called once for each pose.
  TrackedStep step();

  const Eigen::VectorXd& q() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
