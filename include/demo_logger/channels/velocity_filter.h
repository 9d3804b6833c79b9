#pragma once

#include <Eigen/Core>

namespace demo_logger {

/// Velocities from measured positions as they come: the difference quotient of the last two, through a Butterworth
/// low-pass of second order, v̈ + √2 ω v̇ + ω² v = ω² q̇. Between two samples q̇ counts as constant, and the filter's
/// answer to that is exact for any interval, so that uneven stamps do it no harm.
///
/// Slow motions come out late by delay() = √2 / ω; the difference adds nothing, being the mean over its interval.
class VelocityFilter {
 public:
  static constexpr double kFewestSamplesPerPeriod = 4.0;  // of the cut-off; with fewer the filter has nothing to filter

  /// Throws ConfigurationError for a cut-off [Hz] that is not positive.
  VelocityFilter(Eigen::Index joints, double cutoff);

  /// Forgets everything, as before the first sample.
  void restart();

  /// `dt` [s] since the sample before, ignored for the first, which says nothing of velocity: zero. Returns false, and
  /// NaN, where samples come too rarely for the cut-off, or where one is not finite; it restarts then. `velocity` is
  /// resized if need be; nothing else is allocated.
  bool update(double dt, const Eigen::VectorXd& position, Eigen::VectorXd& velocity);

  double delay() const;  // [s]

 private:
  double omega_;
  bool started_ = false;
  Eigen::VectorXd last_;
  Eigen::VectorXd velocity_;
  Eigen::VectorXd rate_;  // of the velocity
};

}  // namespace demo_logger
