#pragma once

#include <Eigen/Core>

namespace demo_logger {

/// A Butterworth low-pass of second order, v̈ + √2 ω v̇ + ω² v = ω² u, for signals that come at uneven intervals: between
/// two samples its input u counts as constant, and its answer to that is exact for any interval.
/// Slow signals come out late by delay() = √2 / ω. Nothing is allocated after construction.
class LowPass {
 public:
  /// Throws ConfigurationError for a cut-off [Hz] that is not positive.
  LowPass(Eigen::Index size, double cutoff);

  /// At rest at `value`, as after a long time of it.
  void start(const Eigen::VectorXd& value);
  /// `input` for `dt` [s], which is positive.
  void advance(double dt, const Eigen::VectorXd& input);

  const Eigen::VectorXd& value() const { return value_; }  // v
  const Eigen::VectorXd& rate() const { return rate_; }    // v̇
  double delay() const;                                    // [s]
  double omega() const { return omega_; }                  // [rad/s]

 private:
  double omega_;
  Eigen::VectorXd value_;
  Eigen::VectorXd rate_;
};

}  // namespace demo_logger
