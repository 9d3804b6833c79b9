#include "twist_resolution.h"

#include <Eigen/SVD>

namespace demo_logger {
namespace {

constexpr double kSingularBelow = 0.04;       // ε: metres per radian, or radians per radian
constexpr double kToleratedShortfall = 1e-3;  // of the twist; less is no intervention

}  // namespace

ResolvedTwist resolveTwist(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& twist) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::VectorXd gains = svd.singularValues();
  for (double& gain : gains) {
    const double sigma = gain;
    gain = sigma >= kSingularBelow ? 1.0 / sigma : sigma / (kSingularBelow * kSingularBelow);
  }
  ResolvedTwist resolved;
  resolved.velocity = svd.matrixV() * gains.cwiseProduct(svd.matrixU().transpose() * twist);
  const double shortfall = (jacobian * resolved.velocity - twist).norm();
  resolved.damped = shortfall > kToleratedShortfall * twist.norm();
  return resolved;
}

}  // namespace demo_logger
