#include "velocity_reference.h"

#include <algorithm>
#include <cmath>

#include "print.h"
#include "snapshot.h"

namespace demo_logger {
namespace {

Eigen::VectorXd clamped(const Eigen::VectorXd& values, double most) { return values.cwiseMax(-most).cwiseMin(most); }

/// The longest part of `target` within `most` of `before` in every joint; where the velocity points elsewhere as yet,
/// so that there is none, the straight way there.
Eigen::VectorXd alongTarget(const Eigen::VectorXd& target, const Eigen::VectorXd& before, double most) {
  double shortest = 0.0;
  double longest = 1.0;
  for (Eigen::Index i = 0; i < target.size(); ++i) {
    if (target[i] == 0.0) {
      if (std::abs(before[i]) > most) longest = -1.0;
      continue;
    }
    const double one = (before[i] - most) / target[i];
    const double other = (before[i] + most) / target[i];
    shortest = std::max(shortest, std::min(one, other));
    longest = std::min(longest, std::max(one, other));
  }
  if (longest >= shortest) return longest * target;
  const Eigen::VectorXd change = target - before;
  return before + most / change.cwiseAbs().maxCoeff() * change;
}

}  // namespace

VelocityReference::VelocityReference(const std::vector<ArmJoint>& joints,
                                     const ArmControllerConfiguration& configuration)
    : joints_(joints),
      rule_{configuration.max_acceleration, configuration.control_period, configuration.position_margin},
      leash_(configuration.max_acceleration / configuration.velocity_gain),
      velocity_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(joints.size()))),
      acceleration_(velocity_),
      ranges_(joints.size()) {}

void VelocityReference::step(const Eigen::VectorXd& target, const ArmState& state, bool keep_direction,
                             Reasons& reasons) {
  // Held back by saturated motors or an obstacle, the arm would otherwise jump after a reference that has left it.
  const Eigen::VectorXd before = state.dq + clamped(velocity_ - state.dq, leash_);

  double scale = 1.0;
  Eigen::VectorXd limited = target;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    ranges_[i] = velocityRange(joints_[i], state.q[j], rule_);
    limited[j] = std::clamp(target[j], ranges_[i].lower, ranges_[i].upper);
    if (limited[j] == target[j]) continue;
    explain(i, target[j] > 0.0, reasons);
    scale = std::min(scale, limited[j] / target[j]);
  }
  if (keep_direction) limited = scale * target;

  const double most = rule_.deceleration * rule_.period;
  velocity_ = limited;
  if ((limited - before).cwiseAbs().maxCoeff() > most * (1.0 + 1e-9)) {
    reasons.add("acceleration limited to " + print(rule_.deceleration) + " rad/s2 or m/s2");
    velocity_ = keep_direction ? alongTarget(limited, before, most) : before + clamped(limited - before, most);
  }

  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    // A joint that is already too fast brakes as hard as it may.
    const double upper = std::max(ranges_[i].upper, before[j] - most);
    const double lower = std::min(ranges_[i].lower, before[j] + most);
    velocity_[j] = std::clamp(velocity_[j], lower, upper);
  }
  acceleration_ = (velocity_ - before) / rule_.period;
}

void VelocityReference::follow(const Eigen::VectorXd& velocity) {
  velocity_ = velocity;
  acceleration_.setZero();
}

void VelocityReference::exchange(Snapshot& snapshot) {
  snapshot.value("velocity", velocity_);
  snapshot.value("acceleration", acceleration_);
}

void VelocityReference::explain(std::size_t joint, bool above, Reasons& reasons) const {
  const ArmJoint& limits = joints_[joint];
  const VelocityRange& range = ranges_[joint];
  if (above ? range.upper_by_position : range.lower_by_position) {
    reasons.add(limits.name + " slowed before its " + (above ? "upper" : "lower") + " limit " +
                printPosition(limits, above ? limits.upper : limits.lower));
  } else {
    reasons.add("velocity of " + limits.name + " limited to " + printVelocity(limits, range.upper));
  }
}

}  // namespace demo_logger
