#pragma once

#include <Eigen/Core>
#include <vector>

#include "inertia_regressor.h"

namespace demo_logger {

/// Whether there can be such a body: its pseudo-inertia [½ tr(I) 1 − I, m c; (m c)ᵀ, m] about the frame's origin is
/// positive definite, so that mass is positive everywhere and the moments keep the triangle inequality.
bool isPossible(const LinearInertia& body);

/// Of all bodies that there can be the ones nearest to `estimate` (ten values each, one body after the other), as far
/// as `covariance` says what is near: least (φ − φ*)ᵀ C⁻¹ (φ − φ*). `before` are possible bodies, or nearly so, from
/// which the search starts; what it finds is possible by construction.
Eigen::VectorXd nearestPossibleBodies(const Eigen::VectorXd& estimate, const Eigen::MatrixXd& covariance,
                                      const Eigen::VectorXd& before);

}  // namespace demo_logger
