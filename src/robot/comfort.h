#pragma once

#include "motion_limits.h"
#include "step_solver.h"

namespace demo_logger {

/// The velocities with which joints would leave uncomfortable postures: away from their limits, the faster the nearer,
/// and on arms with more than six joints away from singular postures.
void comfortVelocity(const JointVector& q, const MotionLimits& limits, StepSolver& solver, JointVector& velocity);

}  // namespace demo_logger
