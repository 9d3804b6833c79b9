#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

struct SolveOptions {
  double tolerance = 1e-6;            // [m] and [rad] that a solution may be off the target; the solver aims far below
  int most_iterations = 10000;        // of one call, some 0.5 µs each
  int further_starts = 1;             // after a solution far from the seed, in search of a nearer one
  std::uint64_t restart_seed = 1;     // of the postures tried after the seed: the same arguments give the same bits
  std::function<bool()> out_of_time;  // asked before each new start, if given; makes the result depend on the machine
};

struct Solution {
  bool solved = false;
  double residual = 0.0;  // larger of the position [m] and the rotation error [rad]; NaN where the input was refused
  int iterations = 0;
  int starts = 0;
};

/// Joint positions for one pose of the tip, from anywhere: given X_base_tip and a seed, finds q with
///   FK(q) = X_base_tip   and   lower ≤ q ≤ upper
/// by damped least squares from the seed, and if that fails from further postures: first those of a table whose tip is
/// nearest to the target, then pseudo-random ones. Of the branches found, the one nearest to the seed is returned, by
/// the largest move of a single joint [rad or m]. Joints that can turn further than once return the turn nearest to the
/// seed. If no q is good enough, the best one found within limits is returned with its residual, not solved.
///
/// The number of iterations is bounded; nothing is allocated in a call; the result depends on the arguments alone.
/// Nothing changes after construction: one object serves any number of threads.
class InverseKinematics {
 public:
  /// Throws ModelError for an arm with more joints than one has (32).
  explicit InverseKinematics(const RobotDescription& robot);
  ~InverseKinematics();
  InverseKinematics(InverseKinematics&&) noexcept;
  InverseKinematics& operator=(InverseKinematics&&) noexcept;

  /// The middle of each joint's range, 0 for a joint without one: the seed to take if there is none.
  const Eigen::VectorXd& middle() const;

  /// A seed out of limits is moved to them. `q` gets the result, resized if need be; NaN, unsolved, if the target or
  /// the seed is not finite or the target not a rigid pose. Throws ModelError if the seed is not of size n.
  Solution solve(const Eigen::Isometry3d& X_base_tip, const Eigen::VectorXd& seed, Eigen::VectorXd& q,
                 const SolveOptions& options = {}) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
