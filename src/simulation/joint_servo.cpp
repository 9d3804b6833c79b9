#include "joint_servo.h"

#include <cmath>

#include "print.h"

namespace demo_logger {

JointServo::JointServo(const RobotModel& model, const ArmControllerConfiguration& configuration)
    : model_(model), gain_(configuration.velocity_gain), max_acceleration_(configuration.max_acceleration) {}

Eigen::VectorXd JointServo::trackingTorque(const VelocityReference& reference, const ArmState& state,
                                           double friction_rise) const {
  const Eigen::VectorXd correction =
      (gain_ * (reference.velocity() - state.dq)).cwiseMax(-max_acceleration_).cwiseMin(max_acceleration_);
  return inverseDynamics(state, reference.acceleration() + correction) + friction(reference.velocity(), friction_rise);
}

Eigen::VectorXd JointServo::inverseDynamics(const ArmState& state, const Eigen::VectorXd& acceleration) const {
  Eigen::VectorXd torque = model_.inverseDynamics(state.q, state.dq, acceleration);
  for (std::size_t i = 0; i < joints().size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    torque[j] += joints()[i].motor_inertia * acceleration[j];
  }
  return torque;
}

Eigen::VectorXd JointServo::friction(const Eigen::VectorXd& velocity, double rise) const {
  Eigen::VectorXd torque(velocity.size());
  for (std::size_t i = 0; i < joints().size(); ++i) {
    const double v = velocity[static_cast<Eigen::Index>(i)];
    torque[static_cast<Eigen::Index>(i)] = joints()[i].damping * v + joints()[i].friction * std::tanh(v / rise);
  }
  return torque;
}

Eigen::VectorXd JointServo::limited(Eigen::VectorXd torque, Reasons& reasons) const {
  for (std::size_t i = 0; i < joints().size(); ++i) {
    double& effort = torque[static_cast<Eigen::Index>(i)];
    const double limit = joints()[i].effort_limit;
    if (std::abs(effort) <= limit) continue;
    effort = std::copysign(limit, effort);
    reasons.add("effort of " + joints()[i].name + " limited to " + printEffort(joints()[i], limit));
  }
  return torque;
}

}  // namespace demo_logger
