#include "branch_search.h"

#include "pose_error.h"

namespace demo_logger {
namespace {

constexpr double kTolerance = 1e-5;  // [m] and [rad]
constexpr double kInterval = 0.1;    // [s] between searches
constexpr double kElsewhere = 0.1;   // [m] or [rad] by which the target must have moved for another one at once
constexpr int kFollowing = 50;       // iterations, some 0.5 µs each
constexpr int kFirst = 3000;         // more than all but one in 10,000 reachable targets take
constexpr int kLater = 500;
constexpr int kFurtherStarts = 4;  // in search of the nearest

}  // namespace

BranchSearch::BranchSearch(const RobotDescription& robot)
    : solver_(robot), posture_(solver_.middle()), result_(solver_.middle()) {}

void BranchSearch::forget() {
  is_found_ = false;
  has_failed_ = false;
  searches_ = 0;
}

bool BranchSearch::find(const RigidPose& target, const Eigen::VectorXd& q, double dt) {
  SolveOptions options;
  options.tolerance = kTolerance;
  if (is_found_) {
    options.most_iterations = kFollowing;
    options.further_starts = 0;
    if (solve(target, posture_, options)) return true;
    is_found_ = false;
  }
  waited_ += dt;
  if (has_failed_ && waited_ < kInterval && largerError(poseError(target, failed_target_)) < kElsewhere) return false;
  options.most_iterations = searches_ == 0 ? kFirst : kLater;
  options.further_starts = kFurtherStarts;
  options.restart_seed = ++searches_;
  is_found_ = solve(target, q, options);
  has_failed_ = !is_found_;
  failed_target_ = target;
  waited_ = 0.0;
  return is_found_;
}

bool BranchSearch::solve(const RigidPose& target, const Eigen::VectorXd& seed, const SolveOptions& options) {
  Eigen::Isometry3d X_base_target = Eigen::Isometry3d::Identity();
  X_base_target.linear() = target.R;
  X_base_target.translation() = target.p;
  if (!solver_.solve(X_base_target, seed, result_, options).solved) return false;
  posture_ = result_;
  return true;
}

}  // namespace demo_logger
