#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace demo_logger {

/// The motion of one joint, as far as its measured positions tell. Everything is given at the instants asked for.
struct SmoothedMotion {
  Eigen::VectorXd position;      // [rad or m]
  Eigen::VectorXd velocity;      // [rad/s or m/s]
  Eigen::VectorXd acceleration;  // [rad/s² or m/s²]
  /// Covariance of (position, velocity, acceleration), one per instant.
  std::vector<Eigen::Matrix3d> covariance;
  double measurement_deviation = 0.0;  // standard deviation of one measured position [rad or m]
  double snap_density = 0.0;           // S below [rad²/s⁷ or m²/s⁷], where the motion is liveliest
  double time_constant = 0.0;          // T = (r Δt / S)^(1/8) [s]: what is much faster counts as noise
  double log_likelihood = 0.0;         // of the measurements, at the values above
};

/// Estimates position, velocity and acceleration from noisy positions at increasing, irregular instants, looking both
/// ways in time (no delay). The model is a random snap,
///   d⁴q/dt⁴ = w,  E[w(t) w(t')] = S δ(t − t'),   z_k = q(t_k) + v_k,  Var v_k = r,
/// whose posterior a Kalman filter and smoother give exactly, in time linear in the samples. Nothing is known of the
/// motion beforehand. S and r follow from the data by maximum likelihood (T from some 16 000 samples spread over a
/// longer record): nothing is to be tuned. Where the motion is calmer for a while than elsewhere, S is smaller, by the
/// likelihood of each piece of some 40 T: a gentle part is not smoothed as if it were the jerky one before it.
///
/// The covariance is the posterior's, plus what the smoothing visibly took away from a motion that is no random snap
/// (a hand's tremor, under coarse noise): where the residuals z − q̂ at a frequency ω hold more power than the noise
/// leaves in them, (1 − H) r with H = 1 / (1 + (ωT)⁸), by more than chance, the excess p(ω) adds ω²ⁱ p(ω) to the
/// variance of the i-th derivative. A motion that the noise hides altogether is missing from it too.
///
/// The samples must number at least kFewestSamples finite ones. Positions that are NaN count as not measured: the
/// estimate bridges them, and its covariance says how well. Throws Error where the times do not increase, are not
/// finite, differ in number from the positions, or where there are too few of these.
SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position);

/// The same with a given T [s], all through; the covariance is the posterior's alone.
SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position, double time_constant);

constexpr int kFewestSamples = 8;

}  // namespace demo_logger
