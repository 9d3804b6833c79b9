#pragma once

#include <limits>

#include "arm_kinematics.h"
#include "joint_ranges.h"

namespace demo_logger {

/// Damped least squares from one start towards one target pose.
class PoseDescent {
 public:
  struct Found {
    JointVector q;
    double residual = std::numeric_limits<double>::infinity();  // larger of position [m] and rotation error [rad]
  };

  PoseDescent(const ArmKinematics& kinematics, const JointRanges& ranges);

  /// The weight that makes a position error [m] comparable to a rotation error [rad]: about one over half the reach.
  double perMetre() const { return per_metre_; }

  /// Descends from `start`, which is within the ranges, until `tolerance` is met, and then on as long as that is cheap;
  /// gives up where it stalls. Counts down `iterations_left` and stops at 0.
  void run(const RigidPose& target, const JointVector& start, double tolerance, int& iterations_left,
           Found& found) const;

 private:
  const ArmKinematics& kinematics_;
  const JointRanges& ranges_;
  double per_metre_;
};

}  // namespace demo_logger
