#include "ridge_regression.h"

#include <Eigen/Cholesky>

namespace demo_logger {
namespace {

/// In units of the deviations the ridge is the identity, and what is known drops out.
RidgeEstimate solveFree(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const Prior& prior) {
  const auto S = prior.deviation.asDiagonal();
  Eigen::MatrixXd H = S * A * S;
  H.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> cholesky(H);
  const Eigen::VectorXd pull = S * (b - A * prior.mean);
  RidgeEstimate estimate;
  estimate.value = prior.mean + S * cholesky.solve(pull);
  estimate.covariance = S * cholesky.solve(Eigen::MatrixXd(S));
  return estimate;
}

}  // namespace

RidgeEstimate solveRidge(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const Prior& prior) {
  RidgeEstimate estimate = solveFree(A, b, prior);
  const Eigen::MatrixXd covariance = estimate.covariance;
  Prior bounded = prior;
  for (Eigen::Index round = 0; round < prior.mean.size(); ++round) {
    bool changed = false;
    for (Eigen::Index i = 0; i < prior.mean.size(); ++i) {
      if (!prior.not_negative[static_cast<std::size_t>(i)] || estimate.value[i] >= 0.0) continue;
      bounded.mean[i] = bounded.deviation[i] = 0.0;
      changed = true;
    }
    if (!changed) break;
    estimate.value = solveFree(A, b, bounded).value;
  }
  estimate.covariance = covariance;
  return estimate;
}

}  // namespace demo_logger
