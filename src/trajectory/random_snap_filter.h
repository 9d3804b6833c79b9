#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {

/// The Kalman filter and smoother behind smoothMotion, for one time constant T. Its state holds the derivatives in
/// units of T, ξ_i = Tⁱ dⁱq/dtⁱ, and its covariances are in units of the measurement's variance r, so that a fast and
/// noisy record gives it numbers as well scaled as a slow and quiet one.
///
/// While little is known, knowledge is kept as information Y = P⁻¹, y = Y ξ: at first both are zero. The covariance P,
/// which is cheaper, takes over when a time constant has been seen. What the later samples say about an instant is
/// information too; together they give the smoothed motion (Fraser and Potter 1969), without any difference of large
/// numbers.
///
/// A motion need not be as lively all the time: its snap density may be given a factor for each step. Nor need its
/// acceleration be continuous: at given samples it may jump.
class RandomSnapFilter {
 public:
  /// References are kept. `interval` is the usual one Δt [s].
  RandomSnapFilter(const std::vector<double>& time, const Eigen::VectorXd& position, double interval,
                   double time_constant);

  /// On the snap density before each sample, relative to that of T; of the first sample it does not matter.
  void setLiveliness(std::vector<double> factors) { liveliness_ = std::move(factors); }

  /// What the acceleration's variance gains at each sample beside the random snap, in units of r/T⁴; of the first
  /// sample it does not matter. Empty: nothing.
  void setJumps(Eigen::VectorXd variances) { jumps_ = std::move(variances); }

  /// Runs over samples [first, last) and adds up what the likelihood needs.
  void run(std::size_t first, std::size_t last);

  /// Runs over everything. The log-likelihood of each piece of so many samples, the last one included if it is shorter,
  /// given what came before it and the measurements' variance r; but for a term that all T have in common.
  std::vector<double> pieceLogLikelihoods(std::size_t samples, double r);

  /// Both as the samples filtered so far say. `variance` is the most likely r for this T.
  double variance() const;
  double logLikelihood() const;

  /// Runs over everything, then smooths. The measurements' variance r is `variance()` if none is given. What the
  /// samples say of jumps goes to `evidence`, if it is asked for.
  SmoothedMotion smooth(std::optional<double> r = std::nullopt, JumpEvidence* evidence = nullptr);

 private:
  using Vector = Eigen::Vector4d;
  using Matrix = Eigen::Matrix4d;

  /// What is known of the state: (Y, y) or (P, ξ).
  struct Knowledge {
    bool is_information = true;
    Matrix matrix = Matrix::Zero();
    Vector vector = Vector::Zero();
  };

  /// Calls visit(k, knowledge) after each sample k of [first, last).
  template <typename Visit>
  void filter(std::size_t first, std::size_t last, const Visit& visit);
  /// To sample k from the one before.
  void predict(Knowledge& knowledge, std::size_t k) const;
  /// `count`: how many samples were measured before.
  void measure(Knowledge& knowledge, double position, std::size_t count);
  void addUp(double innovation, double variance);
  /// What (Y, y), of the samples from k on, says of a jump right before k, in units of T.
  std::pair<double, double> evidenceOfJump(Knowledge before, std::size_t k, const Matrix& Y, const Vector& y) const;

  Matrix transition(double duration) const;
  Matrix processNoise(double duration) const;
  /// Both for the step to sample k, kept while steps are alike.
  struct Step {
    double duration = 0.0;
    double liveliness = 1.0;
    double jump = 0.0;
    Matrix F = Matrix::Identity();
    Matrix Q = Matrix::Zero();
  };
  const Step& stepTo(std::size_t k) const;
  double sumOfLogarithms() const;

  const std::vector<double>& time_;
  const Eigen::VectorXd& position_;
  const double interval_;
  const double T_;

  std::vector<double> liveliness_;  // empty: 1
  Eigen::VectorXd jumps_;           // empty: 0
  mutable Step step_;

  std::size_t innovations_ = 0;
  double squares_ = 0.0;     // Σ e² / s
  double logarithms_ = 0.0;  // Σ ln s, but for those in the product
  double product_ = 1.0;
};

}  // namespace demo_logger
