#pragma once

#include "arm_kinematics.h"

namespace demo_logger {

/// One Levenberg-Marquardt step within joint limits:
///   minimise ‖e − J Δq‖² + damping ‖Δq‖²   with lower ≤ q + Δq ≤ upper, and no |Δq| above 1 rad or m
/// A joint that stands at a limit and is pushed beyond it stays; one that would cross a limit stops there, and the
/// others take over what it leaves. `error` and `jacobian` are weighted alike.
void dampedStep(const JacobianMatrix& jacobian, const Vector6& error, double damping, const JointVector& q,
                const JointVector& lower, const JointVector& upper, JointVector& step);

}  // namespace demo_logger
