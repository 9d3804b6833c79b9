#pragma once

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/trajectory/stamp.h"
#include "joint_path.h"

namespace demo_logger {

class Snapshot;

/// Keeps the path in force and the one that waits for its start. A new path replaces what was there before, from its
/// own start on. It begins where the arm is meant to be then: its first point either lies in time after the start, and
/// the way there is part of the path, or is where the arm is.
class PathFollower {
 public:
  PathFollower(std::vector<ArmJoint> joints, double max_acceleration);

  /// Takes a path, points in the arm's order, that starts at `start`; `present` is where the arm is meant to be then.
  /// Returns why it is refused, empty if it is not; what was in force before a refused path goes on. No points: stop.
  std::string take(const std::vector<PathPoint>& points, Nanoseconds start, Nanoseconds now, const PathPoint& present);

  /// Time goes on to `now`: a path whose start has come replaces the one in force.
  void advance(Nanoseconds now);

  /// Where the arm shall be at `time`, now or later; nothing if there is no path.
  std::optional<PathPoint> at(Nanoseconds time) const;

  void clear();

  void exchange(Snapshot& snapshot);

 private:
  struct Timed {
    JointPath path;
    Nanoseconds start = 0;
  };
  std::vector<ArmJoint> joints_;
  double max_acceleration_;
  std::optional<Timed> active_;
  std::optional<Timed> waiting_;
};

}  // namespace demo_logger
