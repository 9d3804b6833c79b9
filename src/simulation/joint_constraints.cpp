#include "joint_constraints.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

/// The speed [rad/s or m/s] at which a joint may approach a limit that is `room` away: to reach it in this step, not to
/// pass it. A joint that starts outside comes back slowly, for it keeps that speed.
double approachSpeed(double room, double step) {
  constexpr double kWayBack = 0.1;  // [rad/s or m/s]
  return std::max(room / step, -kWayBack);
}

}  // namespace

JointConstraints::JointConstraints(const std::vector<ArmJoint>& joints) {
  for (const ArmJoint& joint : joints) joints_.push_back({joint.friction, joint.lower, joint.upper, -1});
}

void JointConstraints::addTo(ConstraintProblem& problem, const ArmState& state, double step) {
  constexpr double kStrongest = 1e9;            // [N m s or N s]
  constexpr double kHighestAcceleration = 1e5;  // [rad/s² or m/s²]: nothing within reach of a step is overlooked
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    const auto j = static_cast<int>(i);
    joint.friction_row = -1;
    if (joint.friction > 0.0) {
      joint.friction_row = problem.addJoint(j, 0.0, -joint.friction * step, joint.friction * step);
    }
    const double reach = 2.0 * std::abs(state.dq[j]) * step + kHighestAcceleration * step * step;
    const double below = state.q[j] - joint.lower;
    const double above = joint.upper - state.q[j];
    if (below < reach && below <= above) {
      problem.addJoint(j, -approachSpeed(below, step), 0.0, kStrongest);
    } else if (above < reach) {
      problem.addJoint(j, approachSpeed(above, step), -kStrongest, 0.0);
    }
  }
}

void JointConstraints::addFrictionImpulse(const ConstraintProblem& problem, Eigen::VectorXd& impulse) const {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (joints_[i].friction_row < 0) continue;
    impulse[static_cast<Eigen::Index>(i)] += problem.impulse(joints_[i].friction_row);
  }
}

}  // namespace demo_logger
