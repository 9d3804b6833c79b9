#include "demo_logger/channels/momentum_observer.h"

#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {

MomentumObserver::MomentumObserver(Eigen::Index joints, double gain)
    : gain_(gain),
      last_momentum_(Eigen::VectorXd::Zero(joints)),
      last_u_(Eigen::VectorXd::Zero(joints)),
      residual_(Eigen::VectorXd::Zero(joints)) {
  if (!(gain > 0.0) || !std::isfinite(gain)) {
    throw ConfigurationError("momentum observer: the gain is " + print(gain) + " 1/s, expected a positive number.");
  }
}

void MomentumObserver::restart() { started_ = false; }

bool MomentumObserver::update(double dt, const Eigen::VectorXd& momentum, const Eigen::VectorXd& u,
                              const Eigen::VectorXd& motor_torque, Eigen::VectorXd& torque) {
  torque.setConstant(momentum.size(), kNaN);
  const bool usable = momentum.allFinite() && u.allFinite();
  if (started_ && !(usable && motor_torque.allFinite() && dt > 0.0 && std::isfinite(dt))) started_ = false;
  if (!usable) return false;
  if (!started_) {
    started_ = true;
    running_ = 0.0;
    last_momentum_ = momentum;
    last_u_ = u;
    residual_.setZero();
    return false;
  }
  const double taken = -std::expm1(-gain_ * dt);
  residual_ += taken * ((momentum - last_momentum_) / dt - motor_torque - 0.5 * (last_u_ + u) - residual_);
  last_momentum_ = momentum;
  last_u_ = u;
  running_ += dt;
  if (running_ < kSettlingTimes / gain_) return false;
  torque = residual_;
  return true;
}

}  // namespace demo_logger
