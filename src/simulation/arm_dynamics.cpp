#include "arm_dynamics.h"

namespace demo_logger {

ArmDynamics::ArmDynamics(const RobotDescription& description)
    : bullet_(description),
      chain_(description),
      joints_(description.joints),
      damping_(chain_.size()),
      inverse_(chain_.size(), chain_.size()) {
  for (int i = 0; i < chain_.size(); ++i) damping_[i] = description.joints[static_cast<std::size_t>(i)].damping;
}

void ArmDynamics::step(ArmState& state, const Eigen::VectorXd& torque, double step, Eigen::VectorXd& friction_impulse) {
  bullet_.acceleration(state, torque, acceleration_);
  problem_.clear();
  joints_.addTo(problem_, state, step);
  state.dq += step * acceleration_;
  const bool damped = !damping_.isZero(0.0);
  if (damped || problem_.rows() > 0) {
    chain_.place(state.q);
    inertia_ = chain_.massMatrix();
    Eigen::VectorXd& momentum = acceleration_;
    momentum.noalias() = inertia_ * state.dq;
    inertia_.diagonal() += step * damping_;
    factors_.compute(inertia_);
    if (damped) state.dq = factors_.solve(momentum);
    if (problem_.rows() > 0) {
      inverse_.setIdentity();
      factors_.solveInPlace(inverse_);
      problem_.solve(inverse_, state.dq);
      joints_.addFrictionImpulse(problem_, friction_impulse);
    }
    friction_impulse -= step * damping_.cwiseProduct(state.dq);
  }
  state.q += step * state.dq;
}

Eigen::VectorXd ArmDynamics::acceleration(const ArmState& state, const Eigen::VectorXd& torque) {
  Eigen::VectorXd result;
  bullet_.acceleration(state, torque, result);
  return result;
}

}  // namespace demo_logger
