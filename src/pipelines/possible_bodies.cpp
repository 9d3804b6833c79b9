#include "possible_bodies.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr Index kValues = 10;    // of a body
constexpr double kLeast = 1e-9;  // [kg m², kg] of every body in every direction, so that rounding takes none away

Eigen::Matrix4d pseudoInertia(const LinearInertia& body) {
  Eigen::Matrix3d I;
  I << body[4], body[5], body[6], body[5], body[7], body[8], body[6], body[8], body[9];
  Eigen::Matrix4d J;
  J.topLeftCorner<3, 3>() = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
  J.topRightCorner<3, 1>() = body.segment<3>(1);
  J.bottomLeftCorner<1, 3>() = body.segment<3>(1).transpose();
  J(3, 3) = body[0];
  return J;
}

LinearInertia fromPseudoInertia(const Eigen::Matrix4d& J) {
  const Eigen::Matrix3d Sigma = J.topLeftCorner<3, 3>();
  const Eigen::Matrix3d I = Sigma.trace() * Eigen::Matrix3d::Identity() - Sigma;
  LinearInertia body;
  body << J(3, 3), J.topRightCorner<3, 1>(), I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2);
  return body;
}

/// The body whose pseudo-inertia is L Lᵀ and a hair more, L lower triangular with eˣ on its diagonal: any ten numbers
/// make a possible body (Rucker and Wensing 2022).
LinearInertia bodyOf(const Eigen::Ref<const Eigen::VectorXd>& x) {
  Eigen::Matrix4d L = Eigen::Matrix4d::Zero();
  Index at = 0;
  for (Index i = 0; i < 4; ++i) {
    for (Index j = 0; j < i; ++j) L(i, j) = x[at++];
    L(i, i) = std::exp(x[at++]);
  }
  return fromPseudoInertia(L * L.transpose() + kLeast * Eigen::Matrix4d::Identity());
}

/// The other way; what is not possible, or hardly, is made so.
Eigen::VectorXd coordinatesOf(const LinearInertia& body) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(pseudoInertia(body));
  const Eigen::Vector4d values = eigen.eigenvalues().array().max(2.0 * kLeast) - kLeast;
  const Eigen::Matrix4d J = eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::Matrix4d L = J.llt().matrixL();
  Eigen::VectorXd x(kValues);
  Index at = 0;
  for (Index i = 0; i < 4; ++i) {
    for (Index j = 0; j < i; ++j) x[at++] = L(i, j);
    x[at++] = std::log(L(i, i));
  }
  return x;
}

Eigen::VectorXd bodiesOf(const Eigen::VectorXd& x) {
  Eigen::VectorXd bodies(x.size());
  for (Index at = 0; at < x.size(); at += kValues) bodies.segment<kValues>(at) = bodyOf(x.segment(at, kValues));
  return bodies;
}

/// ∂φ/∂x, a block for each body.
Eigen::MatrixXd slopes(const Eigen::VectorXd& x) {
  constexpr double kAside = 1e-6;
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(x.size(), x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const Index at = i / kValues * kValues;
    Eigen::VectorXd ahead = x.segment(at, kValues);
    Eigen::VectorXd behind = ahead;
    ahead[i - at] += kAside;
    behind[i - at] -= kAside;
    J.block(at, i, kValues, 1) = (bodyOf(ahead) - bodyOf(behind)) / (2.0 * kAside);
  }
  return J;
}

}  // namespace

bool isPossible(const LinearInertia& body) { return pseudoInertia(body).llt().info() == Eigen::Success; }

Eigen::VectorXd nearestPossibleBodies(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& before) {
  constexpr int kMostSteps = 500;
  constexpr double kEnough = 1e-9;  // of the distance, that a step must gain
  Eigen::VectorXd x(estimate.size());
  for (Index at = 0; at < x.size(); at += kValues) {
    const LinearInertia own = estimate.segment<kValues>(at);
    const LinearInertia start = isPossible(own) ? own : LinearInertia(before.segment<kValues>(at));
    x.segment(at, kValues) = coordinatesOf(start);
  }
  // Levenberg and Marquardt, in units in which C is the identity.
  const Eigen::LLT<Eigen::MatrixXd> whitening(covariance);
  const auto distance = [&](const Eigen::VectorXd& bodies) -> Eigen::VectorXd {
    return whitening.matrixL().solve(bodies - estimate);
  };
  Eigen::VectorXd residual = distance(bodiesOf(x));
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps && damping < 1e12; ++step) {
    const Eigen::MatrixXd J = whitening.matrixL().solve(slopes(x));
    Eigen::MatrixXd H = J.transpose() * J;
    H.diagonal() *= 1.0 + damping;
    H.diagonal().array() += 1e-12;
    const Eigen::VectorXd next = x - H.ldlt().solve(J.transpose() * residual);
    const Eigen::VectorXd next_residual = distance(bodiesOf(next));
    if (!(next_residual.squaredNorm() < residual.squaredNorm())) {
      damping *= 4.0;
      continue;
    }
    const bool is_enough = next_residual.squaredNorm() > (1.0 - kEnough) * residual.squaredNorm();
    x = next;
    residual = next_residual;
    damping = std::max(1e-9, damping / 3.0);
    if (is_enough) break;
  }
  return bodiesOf(x);
}

}  // namespace demo_logger
