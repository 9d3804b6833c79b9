#pragma once

#include <Eigen/Core>

namespace demo_logger {

/// The torque from outside, as it happens, from the momentum p = M q̇ of an arm (De Luca and Mattone 2003):
///   r = K_o (p − p(0) − ∫ (τ_c + u + r) dt),    u = Cᵀ q̇ − g − friction,    Cᵀ q̇ = Ṁ q̇ − C q̇
/// r follows the outside torque as a low-pass of first order does, ṙ = K_o (τ − r), K_o [1/s]: late by delay() = 1/K_o,
/// and blind to what is much faster. No acceleration is needed. From one sample to the next the mean of τ is what the
/// momentum tells, Δp / Δt − mean(τ_c) − mean(u), u by the trapezium; the answer of r to that is exact, and stable, for
/// any interval.
class MomentumObserver {
 public:
  static constexpr double kSettlingTimes = 5.0;  // of 1/K_o, before which p(0) may still be mistaken

  /// Throws ConfigurationError for a gain [1/s] that is not positive.
  MomentumObserver(Eigen::Index joints, double gain);

  /// Forgets everything: the next sample is the first.
  void restart();

  /// One sample, `dt` [s] after the one before: p and u there, and the mean of the motor torque in between. The first
  /// sample only says where the momentum begins; `dt` and `motor_torque` are ignored then. Returns false, and NaN in
  /// `torque`, until kSettlingTimes / gain after a restart, and where an argument is not finite or dt not positive,
  /// which restarts it. `torque` is resized if need be; nothing else is allocated.
  bool update(double dt, const Eigen::VectorXd& momentum, const Eigen::VectorXd& u, const Eigen::VectorXd& motor_torque,
              Eigen::VectorXd& torque);

  double delay() const { return 1.0 / gain_; }  // [s]

 private:
  double gain_;
  bool started_ = false;
  double running_ = 0.0;  // [s] since the restart
  Eigen::VectorXd last_momentum_;
  Eigen::VectorXd last_u_;
  Eigen::VectorXd residual_;  // r
};

}  // namespace demo_logger
