#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace demo_logger {

/// [rad] between two orientations, from sine and cosine of the matrix itself: right at 0 (where the sine tells) and at
/// π (where the cosine does), and shares no line with the solver.
inline double angleBetween(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  const Eigen::Matrix3d R = A.transpose() * B;
  const Eigen::Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(0.5 * twice_sine.norm(), 0.5 * (R.trace() - 1.0));
}

/// The larger of the distance [m] and the angle [rad].
inline double poseDistance(const Eigen::Isometry3d& A, const Eigen::Isometry3d& B) {
  return std::max((A.translation() - B.translation()).norm(), angleBetween(A.linear(), B.linear()));
}

}  // namespace demo_logger
