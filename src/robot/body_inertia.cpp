#include "body_inertia.h"

#include <Eigen/Eigenvalues>
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

std::string impossibility(const BodyInertia& body) {
  // Exporters print six digits: a rod's or a plate's exact equality may be missed by that much.
  constexpr double kRelativeRounding = 1e-5;

  std::ostringstream fault;
  if (!std::isfinite(body.mass) || !body.center.allFinite() || !body.inertia.allFinite()) {
    fault << "mass properties that are not finite";
  } else if (body.mass < 0.0) {
    fault << "mass " << body.mass << " kg, expected a positive one";
  } else if (body.mass == 0.0) {
    if (!body.inertia.isZero(0.0)) fault << "inertia without mass";
  } else {
    const Eigen::Vector3d moments =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(body.inertia, Eigen::EigenvaluesOnly).eigenvalues();
    const double rounding = kRelativeRounding * moments.cwiseAbs().maxCoeff();
    const bool negative = moments[0] < -rounding;
    const bool triangle_broken = moments[2] > moments[0] + moments[1] + rounding;
    if (negative || triangle_broken) {
      fault << "principal moments of inertia " << moments[0] << ", " << moments[1] << ", " << moments[2]
            << " kg m², which no body has: "
            << (negative ? "none may be negative" : "the largest may not exceed the sum of the other two");
    }
  }
  return fault.str();
}

}  // namespace demo_logger
