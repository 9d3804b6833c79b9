#pragma once

#include <Eigen/Core>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {

/// A joint as a first smoothing has it.
struct JointInMotion {
  SmoothedMotion motion;
  JumpEvidence jumps;
};

/// Whether a joint of the arm has Coulomb friction.
bool hasFriction(const RobotDescription& robot);

/// By how much accelerations may jump, as a joint comes to a stand or turns round: its friction F then changes at once,
/// by up to 2 F, and the accelerations of all joints that move by M(q)⁻¹ times that. Rows x joints, variances
/// [rad²/s⁴ or m²/s⁴] right before each row, 0 at most of them.
///
/// When a joint arrives at zero follows from its velocity, to some T of the smoother; the instant is the one of which
/// the joint's own samples say most, if they say enough. A joint that breaks loose starts from zero acceleration: there
/// nothing jumps. Nor where friction turns round more slowly than T, its friction velocity being large.
Eigen::MatrixXd frictionJumps(const RobotModel& model, const std::vector<double>& time,
                              const std::vector<JointInMotion>& joints);

}  // namespace demo_logger
