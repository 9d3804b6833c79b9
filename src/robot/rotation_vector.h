#pragma once

#include <Eigen/Core>

namespace demo_logger {

/// The rotation vector of R: axis times angle in [0, π], the matrix logarithm. Right to rounding at 0, where it tells
/// angles of 1e-16 rad, and at π, where either of the two axes may come out.
Eigen::Vector3d rotationVector(const Eigen::Matrix3d& R);

}  // namespace demo_logger
