#include "joint_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

constexpr double kTurn = 2.0 * M_PI;
constexpr double kHalfOfAnOpenRange = 1.0;  // [rad or m]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One step of SplitMix64: every counter gives an independent 64-bit number.
std::uint64_t mixed(std::uint64_t counter) {
  std::uint64_t z = counter + 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

}  // namespace

JointRanges::JointRanges(const RobotDescription& robot) {
  const auto n = static_cast<Eigen::Index>(robot.joints.size());
  stated_lower_.resize(n);
  stated_upper_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ArmJoint& joint = robot.joints[static_cast<std::size_t>(i)];
    stated_lower_[i] = joint.lower;
    stated_upper_[i] = joint.upper;
    turns_.push_back(joint.type != JointType::prismatic && joint.upper - joint.lower >= kTurn);
  }
  lower_ = stated_lower_;
  upper_ = stated_upper_;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!turns_[static_cast<std::size_t>(i)]) continue;
    lower_[i] = -kInfinity;
    upper_[i] = kInfinity;
  }
}

JointVector JointRanges::middle() const {
  JointVector middle(lower_.size());
  for (Eigen::Index i = 0; i < middle.size(); ++i) {
    const bool limited = std::isfinite(stated_lower_[i]) && std::isfinite(stated_upper_[i]);
    middle[i] =
        limited ? 0.5 * (stated_lower_[i] + stated_upper_[i]) : std::clamp(0.0, stated_lower_[i], stated_upper_[i]);
  }
  return middle;
}

JointVector JointRanges::clamped(const Eigen::VectorXd& q) const {
  return q.cwiseMax(stated_lower_).cwiseMin(stated_upper_);
}

void JointRanges::turnTowards(const JointVector& seed, JointVector& q) const {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (!turns_[static_cast<std::size_t>(i)]) continue;
    q[i] += kTurn * std::round((seed[i] - q[i]) / kTurn);
    if (q[i] > stated_upper_[i]) q[i] -= kTurn * std::ceil((q[i] - stated_upper_[i]) / kTurn);
    if (q[i] < stated_lower_[i]) q[i] += kTurn * std::ceil((stated_lower_[i] - q[i]) / kTurn);
    q[i] = std::clamp(q[i], stated_lower_[i], stated_upper_[i]);  // where rounding left a turn that just does not fit
  }
}

double JointRanges::largestMove(const JointVector& from, const JointVector& to) const {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < to.size(); ++i) {
    double move = to[i] - from[i];
    if (turns_[static_cast<std::size_t>(i)]) move -= kTurn * std::round(move / kTurn);
    largest = std::max(largest, std::abs(move));
  }
  return largest;
}

void JointRanges::cornerPosture(std::uint64_t key, std::uint64_t counter, JointVector& q) const {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;  // times an odd number, modulo a power of two, is a permutation
  randomPosture(key, counter, q);
  std::uint64_t which = counter * kOdd;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (!std::isfinite(upper_[i] - lower_[i])) continue;
    q[i] = (which & 1U) != 0 ? upper_[i] : lower_[i];
    which >>= 1U;
  }
}

void JointRanges::randomPosture(std::uint64_t key, std::uint64_t counter, JointVector& q) const {
  const auto n = static_cast<std::uint64_t>(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const std::uint64_t bits = mixed(mixed(key) ^ (counter * n + static_cast<std::uint64_t>(i)));
    const double unit = static_cast<double>(bits >> 11U) * 0x1p-53;
    double from = lower_[i];
    double to = upper_[i];
    if (!std::isfinite(to - from)) {
      const double half = turns_[static_cast<std::size_t>(i)] ? M_PI : kHalfOfAnOpenRange;
      const double about = std::clamp(0.0, from + half, to - half);
      from = about - half;
      to = about + half;
    }
    q[i] = from + unit * (to - from);
  }
}

}  // namespace demo_logger
