#include "joint_path.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "print.h"

namespace demo_logger {
namespace {

PathPoint atRest(const PathPoint& point, double time) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(point.q.size());
  return {time, point.q, none, none};
}

PathPoint straight(const PathPoint& from, const PathPoint& to, double time) {
  const Eigen::VectorXd slope = (to.q - from.q) / (to.time - from.time);
  return {time, from.q + (time - from.time) * slope, slope, Eigen::VectorXd::Zero(slope.size())};
}

/// The polynomial of 5th degree through positions, velocities and accelerations at both ends, in t from the first:
///   q = q₀ + v₀ t + a₀ t²/2 + c₃ t³ + c₄ t⁴ + c₅ t⁵
PathPoint quintic(const PathPoint& from, const PathPoint& to, double time) {
  const double T = to.time - from.time;
  const double t = time - from.time;
  const Eigen::VectorXd shift = to.q - from.q;
  const Eigen::VectorXd c3 =
      (20.0 * shift - (8.0 * to.dq + 12.0 * from.dq) * T - (3.0 * from.ddq - to.ddq) * T * T) / (2.0 * T * T * T);
  const Eigen::VectorXd c4 =
      (-30.0 * shift + (14.0 * to.dq + 16.0 * from.dq) * T + (3.0 * from.ddq - 2.0 * to.ddq) * T * T) /
      (2.0 * T * T * T * T);
  const Eigen::VectorXd c5 =
      (12.0 * shift - 6.0 * (to.dq + from.dq) * T + (to.ddq - from.ddq) * T * T) / (2.0 * T * T * T * T * T);
  return {time, from.q + t * (from.dq + t * (0.5 * from.ddq + t * (c3 + t * (c4 + t * c5)))),
          from.dq + t * (from.ddq + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5))),
          from.ddq + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5))};
}

/// The cubic through positions and velocities at both ends.
PathPoint cubic(const PathPoint& from, const PathPoint& to, double time) {
  const double T = to.time - from.time;
  const double t = time - from.time;
  const Eigen::VectorXd shift = to.q - from.q;
  const Eigen::VectorXd c2 = (3.0 * shift - (2.0 * from.dq + to.dq) * T) / (T * T);
  const Eigen::VectorXd c3 = (-2.0 * shift + (from.dq + to.dq) * T) / (T * T * T);
  return {time, from.q + t * (from.dq + t * (c2 + t * c3)), from.dq + t * (2.0 * c2 + t * 3.0 * c3),
          2.0 * c2 + t * 6.0 * c3};
}

PathPoint between(const PathPoint& from, const PathPoint& to, double time) {
  const bool velocities = from.dq.size() > 0 && to.dq.size() > 0;
  const bool accelerations = from.ddq.size() > 0 && to.ddq.size() > 0;
  if (!velocities) return straight(from, to, time);
  return accelerations ? quintic(from, to, time) : cubic(from, to, time);
}

std::string faultAt(const PathPoint& point, const std::vector<ArmJoint>& joints, double max_acceleration) {
  constexpr double kTolerance = 1e-3;  // paths are planned up to the limits themselves, and rounded
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const ArmJoint& joint = joints[i];
    const auto j = static_cast<Eigen::Index>(i);
    const std::string at = " at " + print(point.time) + " s of the path";
    if (point.q[j] < joint.lower - kTolerance || point.q[j] > joint.upper + kTolerance) {
      return joint.name + " would be at " + printPosition(joint, point.q[j]) + at + ", expected from " +
             print(joint.lower) + " to " + printPosition(joint, joint.upper);
    }
    if (std::abs(point.dq[j]) > joint.velocity_limit * (1.0 + kTolerance)) {
      return joint.name + " would move at " + printVelocity(joint, point.dq[j]) + at + ", expected at most " +
             printVelocity(joint, joint.velocity_limit) + "; give it more time";
    }
    if (std::abs(point.ddq[j]) > max_acceleration * (1.0 + kTolerance)) {
      return joint.name + " would accelerate by " + print(point.ddq[j]) + " rad/s2 or m/s2" + at +
             ", expected at most " + print(max_acceleration) + "; give it more time";
    }
  }
  return "";
}

}  // namespace

JointPath::JointPath(std::vector<PathPoint> points) : points_(std::move(points)) {}

PathPoint JointPath::at(double time) const {
  if (time >= points_.back().time) return atRest(points_.back(), time);
  if (time < points_.front().time) return atRest(points_.front(), time);
  const auto next = std::upper_bound(points_.begin(), points_.end(), time,
                                     [](double t, const PathPoint& point) { return t < point.time; });
  return between(*std::prev(next), *next, time);
}

std::string JointPath::fault(const std::vector<ArmJoint>& joints, double max_acceleration) const {
  constexpr std::size_t kMostPlaces = 32;
  constexpr std::size_t kMostInAll = 20000;  // bounds the time that this takes within a control tick
  const std::size_t places = std::clamp(kMostInAll / points_.size(), std::size_t{1}, kMostPlaces);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const PathPoint& from = points_[i - 1];
    const PathPoint& to = points_[i];
    for (std::size_t place = 0; place <= places; ++place) {
      const double share = static_cast<double>(place) / static_cast<double>(places);
      const double time = place == places ? to.time : from.time + (to.time - from.time) * share;
      std::string fault = faultAt(between(from, to, time), joints, max_acceleration);
      if (!fault.empty()) return fault;
    }
  }
  return faultAt(at(points_.back().time), joints, max_acceleration);
}

}  // namespace demo_logger
