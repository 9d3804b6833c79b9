#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// What a command to the arm means; one mode is in force at a time.
///   effort:             a torque per joint [N m or N], gravity not compensated
///   velocity:           a velocity per joint [rad/s or m/s]
///   cartesian_velocity: of the tip, v of its origin [m/s] then ω [rad/s]
enum class ControlMode { effort, velocity, cartesian_velocity };

std::string toString(ControlMode mode);
/// Throws ConfigurationError listing the modes there are.
ControlMode toControlMode(const std::string& name);

struct ArmCommand {
  ControlMode mode = ControlMode::velocity;
  std::vector<std::string> names;  // joints, in any order; empty: all of them in the arm's order
  Eigen::VectorXd values;
  std::string frame;      // cartesian_velocity: the axes it is given in, base or tip link; empty: the base's
  Nanoseconds stamp = 0;  // of its making, on the publisher's clock; 0: none
  std::string source;     // who sent it; each has a clock of its own
};

}  // namespace demo_logger
