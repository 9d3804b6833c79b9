#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "demo_logger/simulation/simulated_human.h"

namespace demo_logger {

class GaussianNoise;

struct ToolPoint {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();  // v of the origin, then ω, base axes
};

/// From rest to rest through way-points, in the smoothest way hands know (Flash and Hogan's minimum jerk):
///   s(τ) = 10 τ³ − 15 τ⁴ + 6 τ⁵,  τ = t / duration of the segment,
/// along straight lines for the position, and about a fixed axis for the orientation. With an overlap each movement
/// begins that part of the last one's duration before its end, and they add up (Flash and Henis): a curve past the
/// way-points between.
class WaypointPath {
 public:
  WaypointPath(const Eigen::Isometry3d& start, const std::vector<Waypoint>& waypoints, double overlap = 0.0);

  double duration() const { return duration_; }
  /// At rest in the first pose before time 0, and in the last one after the end.
  ToolPoint at(double time) const;

 private:
  struct Movement {
    double start = 0.0;  // [s]
    double duration = 0.0;
    Eigen::Vector3d shift;  // [m]
    Eigen::Vector3d turn;   // [rad] rotation vector
  };
  Eigen::Isometry3d start_;
  std::vector<Movement> movements_;
  double duration_ = 0.0;
};

/// s(τ): 0 before 0, 1 after 1.
double minimumJerk(double tau);

/// The task as one human of many means it: each way-point moved by up to a centimetre and 0.05 rad along each axis, and
/// up to a tenth faster or slower.
std::vector<Waypoint> scattered(std::vector<Waypoint> task, GaussianNoise& random);

/// Axis times angle of a rotation, angle within [0, π].
Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation);

}  // namespace demo_logger
