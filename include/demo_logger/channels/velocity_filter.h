#pragma once

#include <Eigen/Core>

#include "demo_logger/channels/low_pass.h"

namespace demo_logger {

/// Velocities from measured positions as they come: the difference quotient of the last two, through a LowPass. The
/// quotient is the mean over its interval, so that uneven stamps do no harm and only the filter makes it late.
class VelocityFilter {
 public:
  static constexpr double kFewestSamplesPerPeriod = 4.0;  // of the cut-off; with fewer the filter has nothing to filter
  static constexpr double kFastest = 100.0;  // [rad/s or m/s] between two samples; beyond, the position jumped

  /// Throws ConfigurationError for a cut-off [Hz] that is not positive.
  VelocityFilter(Eigen::Index joints, double cutoff);

  /// Forgets everything, as before the first sample.
  void restart();

  /// `dt` [s] since the sample before. Returns false for the first sample (whose `dt` is ignored), for one more than
  /// longestInterval() after the one before or not after it, or of a position that jumped (kFastest), which is the
  /// first of a new beginning, and for one that is not finite. The second sample's velocity is the difference quotient,
  /// so that an arm may be moving when it begins. Nothing is allocated.
  bool update(double dt, const Eigen::VectorXd& position);

  /// Of the last update, if that returned true.
  const Eigen::VectorXd& velocity() const { return filter_.value(); }
  /// The position that changes with that velocity, and is as late:  ω² x = ω² q − √2 ω v − v̇
  void position(Eigen::VectorXd& result) const;

  double delay() const { return filter_.delay(); }  // [s]
  double longestInterval() const;                   // [s]

 private:
  LowPass filter_;
  bool has_position_ = false;
  bool has_velocity_ = false;
  Eigen::VectorXd last_;
  Eigen::VectorXd quotient_;
};

}  // namespace demo_logger
