#include "waypoint_path.h"

#include <algorithm>

namespace demo_logger {

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

WaypointPath::WaypointPath(const Eigen::Isometry3d& start, const std::vector<Waypoint>& waypoints) : poses_{start} {
  for (const Waypoint& waypoint : waypoints) {
    Eigen::Isometry3d pose = start;
    pose.translation() += waypoint.shift;
    const double angle = waypoint.turn.norm();
    if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, waypoint.turn / angle) * start.linear();
    poses_.push_back(pose);
    durations_.push_back(waypoint.duration);
    duration_ += waypoint.duration;
  }
}

ToolPoint WaypointPath::at(double time) const {
  if (time <= 0.0) return {poses_.front(), Eigen::Matrix<double, 6, 1>::Zero()};
  std::size_t segment = 0;
  while (segment < durations_.size() && time >= durations_[segment]) time -= durations_[segment++];
  if (segment == durations_.size()) return {poses_.back(), Eigen::Matrix<double, 6, 1>::Zero()};

  const double x = time / durations_[segment];
  const double s = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
  const double rate = 30.0 * x * x * (1.0 - x) * (1.0 - x) / durations_[segment];  // ds/dt

  const Eigen::Isometry3d& from = poses_[segment];
  const Eigen::Isometry3d& to = poses_[segment + 1];
  const Eigen::Vector3d shift = to.translation() - from.translation();
  const Eigen::Vector3d turn = rotationVector(to.linear() * from.linear().transpose());
  const double angle = turn.norm();

  ToolPoint point;
  point.pose.translation() = from.translation() + s * shift;
  point.pose.linear() = from.linear();
  if (angle > 0.0) point.pose.linear() = Eigen::AngleAxisd(s * angle, turn / angle) * from.linear();
  point.twist << rate * shift, rate * turn;
  return point;
}

}  // namespace demo_logger
