#include "src/simulation/velocity_reference.h"

#include <algorithm>
#include <cmath>

#include "src/simulation/print.h"

namespace demo_logger {

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
  const Eigen::VectorXd before = state.dq + (velocity_ - state.dq).cwiseMax(-leash_).cwiseMin(leash_);

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

  Eigen::VectorXd change = limited - before;
  const double most = rule_.deceleration * rule_.period;
  const double largest = change.cwiseAbs().maxCoeff();
  if (largest > most * (1.0 + 1e-9)) {
    reasons.add("acceleration limited to " + print(rule_.deceleration) + " rad/s2 or m/s2");
    if (keep_direction) {
      change *= most / largest;
    } else {
      change = change.cwiseMax(-most).cwiseMin(most);
    }
  }
  velocity_ = before + change;

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
