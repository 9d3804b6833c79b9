#pragma once

#include <Eigen/Core>
#include <vector>

namespace demo_logger {

/// What is known of parameters before the data: each around `mean` with `deviation`; 0: it is known.
struct Prior {
  Eigen::VectorXd mean;
  Eigen::VectorXd deviation;
  std::vector<bool> not_negative;
};

struct RidgeEstimate {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

/// The θ that minimises θᵀ A θ − 2 bᵀ θ + Σ ((θ_i − mean_i) / deviation_i)², A = Σ w x xᵀ and b = Σ w x y with weights
/// w that are one over the variance of each equation. A parameter that would be below zero and must not stays there;
/// its covariance is as if it were free.
RidgeEstimate solveRidge(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, const Prior& prior);

}  // namespace demo_logger
