#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/simulation/arm_command.h"

namespace demo_logger {

/// A path through points, segment by segment as its two ends allow, like ROS's joint trajectory controllers:
///   positions only: straight;  with velocities: cubic;  with velocities and accelerations: quintic
/// A point that leaves out what its neighbour has makes their common segments of the lower kind. Before the first point
/// it is there, and after the last one it rests there.
class JointPath {
 public:
  JointPath() = default;
  /// At least one point; times strictly increasing; all of the same size.
  explicit JointPath(std::vector<PathPoint> points);

  double duration() const { return points_.back().time; }
  PathPoint at(double time) const;
  const std::vector<PathPoint>& points() const { return points_; }

  /// Why these joints cannot follow, looked at in up to 32 places of every segment; empty if they can. Straight
  /// segments meet at corners, which are not judged: the arm rounds them.
  std::string fault(const std::vector<ArmJoint>& joints, double max_acceleration) const;

 private:
  std::vector<PathPoint> points_;
};

}  // namespace demo_logger
