#include "possible_bodies.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <limits>

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr Index kValues = 10;     // of a body
constexpr double kInside = 1e-6;  // of the largest eigenvalue, to start from
constexpr double kLeast = 1e-9;   // [kg m², kg] of every body in every direction, so that rounding takes none away

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

/// Well inside of what can be; what is not, or hardly, is made so.
LinearInertia inside(const LinearInertia& body) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(pseudoInertia(body));
  const Eigen::Vector4d values = eigen.eigenvalues().cwiseMax(kInside * eigen.eigenvalues().maxCoeff() + 2.0 * kLeast);
  return fromPseudoInertia(eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose());
}

/// Of −log det of each body's pseudo-inertia, less a hair, which bars the way to what cannot be. It is convex.
struct Barrier {
  double value = 0.0;  // infinite beyond
  Eigen::VectorXd slope;
  Eigen::MatrixXd curvature;
};

double barrierAt(const Eigen::VectorXd& bodies) {
  double value = 0.0;
  for (Index at = 0; at < bodies.size(); at += kValues) {
    const Eigen::LLT<Eigen::Matrix4d> root(pseudoInertia(bodies.segment<kValues>(at)) -
                                           kLeast * Eigen::Matrix4d::Identity());
    if (root.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    value -= 2.0 * root.matrixLLT().diagonal().array().log().sum();
  }
  return value;
}

Barrier barrierWithSlopes(const Eigen::VectorXd& bodies) {
  Barrier barrier{barrierAt(bodies), Eigen::VectorXd::Zero(bodies.size()),
                  Eigen::MatrixXd::Zero(bodies.size(), bodies.size())};
  for (Index at = 0; at < bodies.size(); at += kValues) {
    const Eigen::Matrix4d inverse =
        (pseudoInertia(bodies.segment<kValues>(at)) - kLeast * Eigen::Matrix4d::Identity()).inverse();
    std::array<Eigen::Matrix4d, kValues> change;  // J⁻¹ ∂J/∂φ
    for (Index k = 0; k < kValues; ++k) {
      change[static_cast<std::size_t>(k)] = inverse * pseudoInertia(LinearInertia::Unit(k));
      barrier.slope[at + k] = -change[static_cast<std::size_t>(k)].trace();
    }
    for (Index k = 0; k < kValues; ++k) {
      for (Index l = 0; l < kValues; ++l) {
        barrier.curvature(at + k, at + l) =
            (change[static_cast<std::size_t>(k)] * change[static_cast<std::size_t>(l)]).trace();
      }
    }
  }
  return barrier;
}

}  // namespace

bool isPossible(const LinearInertia& body) { return pseudoInertia(body).llt().info() == Eigen::Success; }

/// The problem is convex in φ, so Newton's steps behind an ever steeper barrier come to the one that is nearest.
Eigen::VectorXd nearestPossibleBodies(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& before) {
  constexpr int kMostSteps = 60;        // for one barrier
  constexpr double kSettled = 1e-6;     // Newton's decrement, squared
  constexpr double kSteeper = 0.1;      // from one barrier to the next
  constexpr double kEnough = 1e-7;      // [deviations²] farther than need be
  constexpr double kLeastStep = 1e-10;  // of Newton's
  bool is_possible = true;
  Eigen::VectorXd bodies = estimate;
  for (Index at = 0; at < bodies.size(); at += kValues) {
    is_possible = is_possible && isPossible(estimate.segment<kValues>(at));
    const LinearInertia own = estimate.segment<kValues>(at);
    bodies.segment<kValues>(at) = inside(isPossible(own) ? own : LinearInertia(before.segment<kValues>(at)));
  }
  if (is_possible) return estimate;

  const Eigen::LLT<Eigen::MatrixXd> whitening(covariance);
  const Eigen::MatrixXd information = whitening.solve(Eigen::MatrixXd::Identity(bodies.size(), bodies.size()));
  const auto distance = [&](const Eigen::VectorXd& other) {
    return whitening.matrixL().solve(other - estimate).squaredNorm();
  };
  const double eigenvalues = 0.4 * static_cast<double>(bodies.size());  // four of ten values
  for (double softness = distance(bodies) / eigenvalues; softness * eigenvalues > kEnough; softness *= kSteeper) {
    const auto cost = [&](const Eigen::VectorXd& other) { return distance(other) / softness + barrierAt(other); };
    for (int step = 0; step < kMostSteps; ++step) {
      const Barrier barrier = barrierWithSlopes(bodies);
      const Eigen::VectorXd slope = information * (bodies - estimate) * (2.0 / softness) + barrier.slope;
      const Eigen::MatrixXd curvature = information * (2.0 / softness) + barrier.curvature;
      const Eigen::VectorXd newton = curvature.ldlt().solve(-slope);
      const double decrement = -slope.dot(newton);
      if (!(decrement > kSettled)) break;
      double length = 1.0;
      const double now = distance(bodies) / softness + barrier.value;
      while (length > kLeastStep && !(cost(bodies + length * newton) < now - 1e-4 * length * decrement)) length *= 0.5;
      if (length <= kLeastStep) break;  // rounding
      bodies += length * newton;
    }
  }
  return bodies;
}

}  // namespace demo_logger
