#pragma once

#include <algorithm>
#include <cmath>

#include "arm_kinematics.h"
#include "rotation_vector.h"

namespace demo_logger {

/// What takes `actual` to `target`, in base axes: the difference of positions [m], then the rotation vector of
/// R_target R_actualᵀ [rad].
inline Vector6 poseError(const RigidPose& target, const RigidPose& actual) {
  Vector6 error;
  error.head<3>() = target.p - actual.p;
  error.tail<3>() = rotationVector(target.R * actual.R.transpose());
  return error;
}

/// The larger of the two lengths.
inline double largerError(const Vector6& error) {
  return std::sqrt(std::max(error.head<3>().squaredNorm(), error.tail<3>().squaredNorm()));
}

/// Whether a target that is at `to` `dt` seconds after `from` did not move there, but is another one.
inline bool isJump(const RigidPose& from, const RigidPose& to, double dt) {
  constexpr double kFastest = 10.0;  // [m/s] or [rad/s]
  return largerError(poseError(to, from)) > kFastest * dt;
}

/// Whether it is a place that one can compute with, its matrix a rotation as far as a quaternion of a few digits makes
/// one.
inline bool isRigid(const RigidPose& pose) {
  constexpr double kSlack = 1e-6;
  constexpr double kFarthest = 1e9;  // [m]
  return pose.p.cwiseAbs().maxCoeff() <= kFarthest && pose.p.allFinite() && pose.R.allFinite() &&
         (pose.R.transpose() * pose.R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kSlack &&
         pose.R.determinant() > 0.0;
}

}  // namespace demo_logger
