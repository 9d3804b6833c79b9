#pragma once

#include <cstdint>
#include <vector>

#include "arm_kinematics.h"

namespace demo_logger {

/// Where the joints may be. A revolute joint whose limits leave it a full turn reaches every angle: while solving it
/// has no limits (`lower()` and `upper()` are infinite), and turnTowards() puts it back within them.
class JointRanges {
 public:
  explicit JointRanges(const RobotDescription& robot);

  const JointVector& lower() const { return lower_; }
  const JointVector& upper() const { return upper_; }

  /// [rad or m] halfway between the limits, 0 without.
  JointVector middle() const;
  JointVector clamped(const Eigen::VectorXd& q) const;

  /// Adds full turns where joints can make them: each comes as near to `seed` as its limits allow.
  void turnTowards(const JointVector& seed, JointVector& q) const;

  /// [rad or m] of a single joint, on the way between the turns nearest to each other.
  double largestMove(const JointVector& from, const JointVector& to) const;

  /// Uniform within the limits (within one turn, 1 m, where there are none); `counter` and `key` say which. Counting
  /// instead of remembering keeps a call's result free of the calls before.
  void randomPosture(std::uint64_t key, std::uint64_t counter, JointVector& q) const;

  /// Likewise, but with every joint that has limits at one of them: counting visits every such corner once before it
  /// comes to the first one again.
  void cornerPosture(std::uint64_t key, std::uint64_t counter, JointVector& q) const;

 private:
  JointVector stated_lower_, stated_upper_;
  JointVector lower_, upper_;
  std::vector<bool> turns_;
};

}  // namespace demo_logger
