#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "arm_kinematics.h"
#include "demo_logger/robot/inverse_kinematics.h"

namespace demo_logger {

/// For a target that the arm cannot reach by moving on from where it is: whether another posture does, and which. Once
/// found it is followed from target to target, which costs little; a search that failed is repeated only after a while,
/// or when the target is somewhere else, with other postures each time.
class BranchSearch {
 public:
  explicit BranchSearch(const RobotDescription& robot);

  void forget();

  /// The posture nearest to `q`, or the one found before, moved on with the target. `dt` [s] has passed since the last
  /// call. Nothing is allocated.
  bool find(const RigidPose& target, const Eigen::VectorXd& q, double dt);
  const Eigen::VectorXd& posture() const { return posture_; }

 private:
  bool solve(const RigidPose& target, const Eigen::VectorXd& seed, const SolveOptions& options);

  InverseKinematics solver_;
  Eigen::VectorXd posture_, result_;
  RigidPose failed_target_;
  bool is_found_ = false;
  bool has_failed_ = false;
  double waited_ = 0.0;  // [s] since the search that failed
  std::uint64_t searches_ = 0;
};

}  // namespace demo_logger
