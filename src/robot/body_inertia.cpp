#include "body_inertia.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <sstream>

namespace demo_logger {
namespace {

/// Steiner's term of a mass at offset `r`: m (|r|² 1 − r rᵀ).
Eigen::Matrix3d pointMassInertia(double mass, const Eigen::Vector3d& r) {
  return mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
}

}  // namespace

BodyInertia movedTo(const Eigen::Isometry3d& X_A_B, const BodyInertia& body) {
  const Eigen::Matrix3d R = X_A_B.linear();
  return {body.mass, X_A_B * body.center, R * body.inertia * R.transpose()};
}

BodyInertia lumped(const BodyInertia& a, const BodyInertia& b) {
  const double mass = a.mass + b.mass;
  if (mass == 0.0) return {};
  const Eigen::Vector3d center = (a.mass * a.center + b.mass * b.center) / mass;
  const Eigen::Matrix3d inertia = a.inertia + pointMassInertia(a.mass, a.center - center) +  //
                                  b.inertia + pointMassInertia(b.mass, b.center - center);
  return {mass, center, inertia};
}

namespace {

/// Principal moments I₁ ≤ I₂ ≤ I₃ [kg m²].
Eigen::Vector3d principalMoments(const BodyInertia& body) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
}

/// What exporters' rounding may add or take [kg m²]: six significant digits, or six decimals; and a hair for turning
/// tensors that are zero.
double rounding(const BodyInertia& body, const Eigen::Vector3d& moments) {
  return 1e-5 * moments.cwiseAbs().maxCoeff() + 1e-10 * body.mass;
}
constexpr double kSixDecimals = 2e-6;  // [kg m²]

/// By how much the largest moment exceeds the sum of the other two, which no body has [kg m²].
double excess(const Eigen::Vector3d& moments) { return moments[2] - moments[0] - moments[1]; }

std::string impossibleMoments(const Eigen::Vector3d& moments, const char* rule) {
  std::ostringstream fault;
  fault << "principal moments of inertia " << moments[0] << ", " << moments[1] << ", " << moments[2]
        << " kg m², which no body has: " << rule;
  return fault.str();
}

constexpr const char* kTriangle = "the largest may not exceed the sum of the other two";

}  // namespace

std::string impossibility(const BodyInertia& body) {
  constexpr double kGross = 0.2;  // of the largest moment

  if (!std::isfinite(body.mass) || !body.center.allFinite() || !body.inertia.allFinite()) {
    return "mass properties that are not finite";
  }
  if (body.mass < 0.0) {
    std::ostringstream fault;
    fault << "mass " << body.mass << " kg, expected a positive one";
    return fault.str();
  }
  if (body.mass == 0.0) return body.inertia.isZero(0.0) ? "" : "inertia without mass";
  const Eigen::Vector3d moments = principalMoments(body);
  if (moments[0] < -rounding(body, moments)) return impossibleMoments(moments, "none may be negative");
  if (excess(moments) > kSixDecimals + kGross * moments[2]) return impossibleMoments(moments, kTriangle);
  return {};
}

std::string implausibility(const BodyInertia& body) {
  if (std::string impossible = impossibility(body); !impossible.empty()) return impossible;
  const Eigen::Vector3d moments = principalMoments(body);
  return excess(moments) > kSixDecimals + rounding(body, moments) ? impossibleMoments(moments, kTriangle) : "";
}

}  // namespace demo_logger
