#include "demo_logger/channels/impedance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace demo_logger {
namespace {

// What rounding leaves of a radius of 1, which an arm without stiffness has: nothing calls it back.
constexpr double kRounding = 1e-9;

}  // namespace

Eigen::VectorXd impedanceTorque(const ImpedanceGains& gains, const Eigen::VectorXd& gravity, const Eigen::VectorXd& q,
                                const Eigen::VectorXd& dq, const Eigen::VectorXd& q_ref, const Eigen::VectorXd& limit) {
  const Eigen::VectorXd torque = gravity - gains.stiffness.cwiseProduct(q - q_ref) - gains.damping.cwiseProduct(dq);
  return torque.cwiseMin(limit).cwiseMax(-limit);
}

ImpedanceStability judgeStability(const ImpedanceGains& gains, const Eigen::MatrixXd& M, double h) {
  const Eigen::Index n = M.rows();
  const Eigen::LLT<Eigen::MatrixXd> inertia(M);
  const Eigen::MatrixXd stiffness = inertia.solve(Eigen::MatrixXd(gains.stiffness.asDiagonal()));
  const Eigen::MatrixXd damping = inertia.solve(Eigen::MatrixXd(gains.damping.asDiagonal()));

  Eigen::MatrixXd period(2 * n, 2 * n);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  period << one - 0.5 * h * h * stiffness, h * one - 0.5 * h * h * damping,  //
      -h * stiffness, one - h * damping;

  ImpedanceStability stability;
  stability.damping_rate = damping.eigenvalues().real().maxCoeff();  // real: M and K_d are symmetric, M is positive
  stability.spectral_radius = period.eigenvalues().cwiseAbs().maxCoeff();
  stability.stable = stability.damping_rate <= 1.0 / h && stability.spectral_radius <= 1.0 + kRounding;
  return stability;
}

}  // namespace demo_logger
