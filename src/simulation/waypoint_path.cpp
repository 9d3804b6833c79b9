#include "waypoint_path.h"

#include <algorithm>

#include "demo_logger/simulation/gaussian_noise.h"

namespace demo_logger {

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

double minimumJerk(double tau) {
  const double x = std::clamp(tau, 0.0, 1.0);
  return x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
}

std::vector<Waypoint> scattered(std::vector<Waypoint> task, GaussianNoise& random) {
  constexpr double kPlaceScatter = 0.01;  // [m]
  constexpr double kTurnScatter = 0.05;   // [rad]
  constexpr double kTempoScatter = 0.1;   // of a duration
  for (Waypoint& waypoint : task) {
    for (double& shift : waypoint.shift) shift += random.uniform(-kPlaceScatter, kPlaceScatter);
    for (double& turn : waypoint.turn) turn += random.uniform(-kTurnScatter, kTurnScatter);
    waypoint.duration *= 1.0 + random.uniform(-kTempoScatter, kTempoScatter);
  }
  return task;
}

namespace {

double minimumJerkRate(double tau) {  // ds/dτ
  const double x = std::clamp(tau, 0.0, 1.0);
  return 30.0 * x * x * (1.0 - x) * (1.0 - x);
}

Eigen::Matrix3d turned(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

}  // namespace

WaypointPath::WaypointPath(const Eigen::Isometry3d& start, const std::vector<Waypoint>& waypoints, double overlap)
    : start_(start) {
  Eigen::Vector3d reached = Eigen::Vector3d::Zero();
  Eigen::Matrix3d facing = Eigen::Matrix3d::Identity();
  double begin = 0.0;
  for (const Waypoint& waypoint : waypoints) {
    const Eigen::Matrix3d meant = turned(waypoint.turn);
    movements_.push_back(
        {begin, waypoint.duration, waypoint.shift - reached, rotationVector(meant * facing.transpose())});
    reached = waypoint.shift;
    facing = meant;
    duration_ = std::max(duration_, begin + waypoint.duration);
    begin += (1.0 - overlap) * waypoint.duration;
  }
}

ToolPoint WaypointPath::at(double time) const {
  ToolPoint point{start_, Eigen::Matrix<double, 6, 1>::Zero()};
  for (const Movement& movement : movements_) {
    const double tau = (time - movement.start) / movement.duration;
    if (tau <= 0.0) continue;
    const double rate = minimumJerkRate(tau) / movement.duration;
    const Eigen::Matrix3d turn = turned(minimumJerk(tau) * movement.turn);
    point.pose.translation() += minimumJerk(tau) * movement.shift;
    point.pose.linear() = turn * point.pose.linear();
    point.twist.head<3>() += rate * movement.shift;
    point.twist.tail<3>() = turn * point.twist.tail<3>() + rate * movement.turn;
  }
  return point;
}

}  // namespace demo_logger
