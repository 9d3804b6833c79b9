#include "effort_guard.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "velocity_range.h"

namespace demo_logger {

EffortGuard::EffortGuard(const RobotModel& model, const JointServo& servo,
                         const ArmControllerConfiguration& configuration)
    : model_(model), servo_(servo), configuration_(configuration) {}

Eigen::VectorXd EffortGuard::guarded(const Eigen::VectorXd& asked, const ArmState& state, Reasons& reasons) const {
  const std::vector<ArmJoint>& joints = model_.description().joints;
  Eigen::VectorXd torque = servo_.limited(asked, reasons);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(model_.size());
  const Eigen::VectorXd bias = servo_.inverseDynamics(state, rest) + servo_.friction(state.dq, kUsualFrictionRise);
  Eigen::MatrixXd mass = model_.massMatrix(state.q);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    mass(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += joints[i].motor_inertia;
  }
  const Eigen::VectorXd predicted = mass.llt().solve(torque - bias);
  Eigen::VectorXd allowed = predicted;
  const double most = configuration_.max_acceleration;
  // This law sees one tick ahead and knows no stiction: it is stiff, and keeps half the deceleration and a part of the
  // velocity in hand.
  constexpr double kShareOfVelocity = 0.95;
  const double gain = 2.0 * configuration_.velocity_gain;
  const BrakingRule rule{most / 2.0, configuration_.control_period, configuration_.position_margin};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    const VelocityRange range = velocityRange(joints[i], state.q[j], rule);
    const double fastest = gain * (kShareOfVelocity * range.upper - state.dq[j]);
    const double slowest = gain * (kShareOfVelocity * range.lower - state.dq[j]);
    allowed[j] = std::clamp(predicted[j], slowest, fastest);
    if (allowed[j] == predicted[j]) continue;
    const bool by_position = predicted[j] > fastest ? range.upper_by_position : range.lower_by_position;
    reasons.add(joints[i].name + (by_position ? " braked before its position limit" : " braked at its velocity limit"));
  }
  if (allowed == predicted) return torque;
  // Once it interferes, no joint shall be so quick that the others' forces change within the tick.
  const double quickest = 10.0 * most;
  return feasibleTorque(allowed.cwiseMax(-quickest).cwiseMin(quickest), state);
}

/// The torque for `acceleration`, or where a motor is too weak for it, for something between it and braking all joints:
/// clamping that motor alone would let the others push it over its limit.
Eigen::VectorXd EffortGuard::feasibleTorque(const Eigen::VectorXd& acceleration, const ArmState& state) const {
  const double most = configuration_.max_acceleration;
  const Eigen::VectorXd braking = (-configuration_.velocity_gain * state.dq).cwiseMax(-most).cwiseMin(most);
  const Eigen::VectorXd resisting = servo_.friction(state.dq, kUsualFrictionRise);
  Eigen::VectorXd torque = servo_.inverseDynamics(state, braking) + resisting;
  const Eigen::VectorXd more = servo_.inverseDynamics(state, acceleration) + resisting - torque;
  double share = 1.0;
  for (Eigen::Index i = 0; i < torque.size(); ++i) {
    const double limit = model_.description().joints[static_cast<std::size_t>(i)].effort_limit;
    const double room = limit - std::copysign(1.0, more[i]) * torque[i];
    if (std::abs(more[i]) > room) share = std::min(share, std::max(room, 0.0) / std::abs(more[i]));
  }
  torque += share * more;
  Reasons known;
  return servo_.limited(torque, known);
}

}  // namespace demo_logger
