#include "rotation_vector.h"

#include <Eigen/Geometry>
#include <cmath>

namespace demo_logger {

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& R) {
  // By way of the quaternion, which Eigen takes from the largest of trace and diagonal: no cancellation anywhere.
  const Eigen::Quaterniond quaternion(R);
  const double sine = quaternion.vec().norm();  // of half the angle
  const double angle = 2.0 * std::atan2(sine, std::abs(quaternion.w()));
  const double per_sine = sine > 0.0 ? angle / sine : 2.0;
  return std::copysign(per_sine, quaternion.w()) * quaternion.vec();
}

}  // namespace demo_logger
