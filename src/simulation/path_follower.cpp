#include "path_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "print.h"
#include "snapshot.h"

namespace demo_logger {
namespace {

constexpr double kFarthestStart = 0.05;  // [rad or m] from the arm to a first point that is there from the start
constexpr double kLongestPath = 3600.0;  // [s]

std::string pointName(std::size_t i) { return "point " + std::to_string(i + 1) + " of the path"; }

/// What can be judged without knowing where the arm is.
std::string formFault(const std::vector<PathPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPoint& point = points[i];
    if (!std::isfinite(point.time) || point.time < 0.0 || point.time > kLongestPath) {
      return pointName(i) + " is at " + print(point.time) + " s, expected from 0 to " + print(kLongestPath) + " s";
    }
    if (i > 0 && point.time <= points[i - 1].time) {
      return pointName(i) + " is at " + print(point.time) + " s, expected later than the " + print(points[i - 1].time) +
             " s of the one before";
    }
    if (point.ddq.size() > 0 && point.dq.size() == 0) return pointName(i) + " has accelerations but no velocities";
  }
  return "";
}

}  // namespace

PathFollower::PathFollower(std::vector<ArmJoint> joints, double max_acceleration)
    : joints_(std::move(joints)), max_acceleration_(max_acceleration) {}

std::string PathFollower::take(const std::vector<PathPoint>& points, Nanoseconds start, Nanoseconds now,
                               const PathPoint& present) {
  if (points.empty()) {
    clear();
    return "";
  }
  std::string fault = formFault(points);
  if (!fault.empty()) return fault;

  std::vector<PathPoint> whole = points;
  const double elapsed = toSeconds(now - start);
  if (points.back().time < elapsed) {
    return "the path ended " + print(elapsed - points.back().time) + " s ago";
  }
  // Points of the past are left out; the way from the arm to the first of the others is part of the path.
  std::size_t past = 0;
  while (past < whole.size() && whole[past].time < elapsed) ++past;
  whole.erase(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(past));
  PathPoint first = present;
  first.time = std::max(elapsed, 0.0);
  if (whole.front().time > first.time) {
    const PathPoint& next = whole.front();
    if (next.dq.size() == 0) first.dq.resize(0);
    if (next.ddq.size() == 0) first.ddq.resize(0);
    whole.insert(whole.begin(), first);
  } else {
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const auto j = static_cast<Eigen::Index>(i);
      const double distance = std::abs(whole.front().q[j] - present.q[j]);
      if (distance <= kFarthestStart) continue;
      return "the path starts with " + joints_[i].name + " at " + printPosition(joints_[i], whole.front().q[j]) +
             ", but the arm is at " + printPosition(joints_[i], present.q[j]) +
             "; give the first point time to be reached";
    }
  }
  JointPath path(std::move(whole));
  fault = path.fault(joints_, max_acceleration_);
  if (!fault.empty()) return fault;
  waiting_ = Timed{std::move(path), start};
  return "";
}

void PathFollower::advance(Nanoseconds now) {
  if (!waiting_ || now < waiting_->start) return;
  active_ = std::move(waiting_);
  waiting_.reset();
}

std::optional<PathPoint> PathFollower::at(Nanoseconds time) const {
  const std::optional<Timed>& timed = waiting_ && time >= waiting_->start ? waiting_ : active_;
  if (!timed) return std::nullopt;
  return timed->path.at(toSeconds(time - timed->start));
}

void PathFollower::clear() {
  active_.reset();
  waiting_.reset();
}

void PathFollower::exchange(Snapshot& snapshot) {
  const auto exchangeTimed = [this](Snapshot& inside, Timed& timed) {
    std::vector<PathPoint> points = timed.path.points();
    inside.path("points", points);
    const auto not_later = [](const PathPoint& a, const PathPoint& b) { return !(b.time > a.time); };
    if (points.empty() || std::adjacent_find(points.begin(), points.end(), not_later) != points.end()) {
      Snapshot::refuse("points", "are no path, expected at least one, and times that increase");
    }
    timed.path = JointPath(std::move(points));
    inside.stamp("start", timed.start);
    if (!inside.reading()) return;
    const std::string fault = timed.path.fault(joints_, max_acceleration_);
    if (!fault.empty()) Snapshot::refuse("points", "are no path: " + fault);
  };
  snapshot.optional("active", active_, exchangeTimed);
  snapshot.optional("waiting", waiting_, exchangeTimed);
}

}  // namespace demo_logger
