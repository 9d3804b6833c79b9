#pragma once

#include "arm_kinematics.h"

namespace demo_logger {

using SquareMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostJoints, kMostJoints>;

/// Minimises ½ xᵀ H x − gᵀ x within lower ≤ x ≤ upper, exactly, for symmetric positive definite H (lower triangle) and
/// lower ≤ upper. Joints are moved between "free", "at lower" and "at upper" until the Karush-Kuhn-Tucker conditions
/// hold: all wrong ones at once while that makes progress, else one at a time, which is known to end.
void minimiseInBox(const SquareMatrix& H, const JointVector& g, const JointVector& lower, const JointVector& upper,
                   JointVector& x);

}  // namespace demo_logger
