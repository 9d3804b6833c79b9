#pragma once

#include <cstddef>
#include <vector>

#include "joint_ranges.h"
#include "motion_limits.h"
#include "pose_descent.h"

namespace demo_logger {

/// Plans the joints' way along poses that are known: forward through knots in time, with many postures kept at each,
/// each reached from one at the knot before within the limits of velocity and acceleration; then back along the
/// cheapest way, far from joint limits and singular postures and with little motion; then smoothed.
class PosturePlanner {
 public:
  PosturePlanner(const RobotDescription& robot, const MotionLimits& limits);

  struct Knot {
    double time;  // [s]
    RigidPose pose;
  };

  /// A posture for each knot, the first being `start`. Knots that cannot be reached get the nearest there is.
  std::vector<JointVector> plan(const std::vector<Knot>& knots, const JointVector& start) const;

 private:
  struct Candidate {
    JointVector q;
    JointVector move;  // from the parent
    double cost = 0.0;
    std::size_t parent = 0;
  };

  std::vector<Candidate> expanded(const std::vector<Candidate>& parents, const Knot& knot, double dt) const;
  void addChildren(const std::vector<Candidate>& parents, std::size_t parent, const Knot& knot, double dt,
                   std::vector<Candidate>& children) const;
  Candidate child(const Candidate& parent, const JointVector& guess, const Knot& knot, double dt) const;
  JacobianMatrix scaledJacobian(const JointVector& q) const;
  double discomfort(const JointVector& q) const;
  bool selfMotion(const JointVector& q, int which, JointVector& direction) const;
  bool reach(const Knot& knot, const JointVector& guess, PoseDescent::Found& found) const;
  double speed(const JointVector& from, const JointVector& to, double dt) const;
  void smooth(const std::vector<Knot>& knots, std::vector<JointVector>& postures) const;

  ArmKinematics kinematics_;
  JointRanges ranges_;
  MotionLimits limits_;
  PoseDescent descent_;
  JointVector velocity_;  // limits, finite
};

/// Posture and velocity at a time between knots: cubic, with velocities taken from the neighbours.
void interpolatePostures(const std::vector<PosturePlanner::Knot>& knots, const std::vector<JointVector>& postures,
                         double time, Eigen::VectorXd& q, Eigen::VectorXd& velocity);

}  // namespace demo_logger
