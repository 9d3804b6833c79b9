#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "demo_logger/simulation/simulated_human.h"

namespace demo_logger {

struct ToolPoint {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();  // v of the origin, then ω, base axes
};

/// From rest to rest through way-points, in the smoothest way hands know (Flash and Hogan's minimum jerk):
///   s(τ) = 10 τ³ − 15 τ⁴ + 6 τ⁵,  τ = t / duration of the segment,
/// along straight lines for the position, and about a fixed axis for the orientation.
class WaypointPath {
 public:
  WaypointPath(const Eigen::Isometry3d& start, const std::vector<Waypoint>& waypoints);

  double duration() const { return duration_; }
  /// At rest in the first pose before time 0, and in the last one after the end.
  ToolPoint at(double time) const;

 private:
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<double> durations_;
  double duration_ = 0.0;
};

/// Axis times angle of a rotation, angle within [0, π].
Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation);

}  // namespace demo_logger
