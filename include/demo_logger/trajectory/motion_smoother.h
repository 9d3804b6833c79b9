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

/// What the samples say of a jump of the acceleration right before each of them: one by δ [rad/s² or m/s²] would change
/// the logarithm of their likelihood by score · δ − information · δ² / 2. Zero where too little is known.
struct JumpEvidence {
  Eigen::VectorXd score;
  Eigen::VectorXd information;
};

/// The same as the first, with that evidence.
SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position, JumpEvidence& evidence);

/// Smooths again what came out `before`, where the acceleration is now known to jump, as it does when a joint's
/// friction turns round: right before each sample by a Gaussian of `jump_variance` [rad²/s⁴ or m²/s⁴], 0 at most of
/// them. Where it jumps is known exactly; how far, as well as the positions tell. T stays; r and how lively the motion
/// is in each piece are found anew. Without noise all stays as it was. Throws Error where the variances differ in
/// number from the times, or are not all finite and at least 0.
SmoothedMotion smoothMotionAgain(const std::vector<double>& time, const Eigen::VectorXd& position,
                                 const SmoothedMotion& before, const Eigen::VectorXd& jump_variance);

constexpr int kFewestSamples = 8;

}  // namespace demo_logger
