#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// What a command to the arm means; one mode is in force at a time. The arm compensates gravity in all of them.
///   effort:             a torque per joint [N m or N], on top of gravity compensation unless that is switched off
///   velocity:           a velocity per joint [rad/s or m/s]
///   position:           a position per joint [rad or m] to go to, and perhaps the velocity at which it moves itself
///   trajectory:         a path of joint positions over time
///   cartesian_velocity: of the tip, v of its origin [m/s] then ω [rad/s]
/// A hand guides the arm, and no command is expected, in the compliant ones:
///   gravity_compensation: the arm stays where it is put
///   impedance:            a spring and a damper at each joint, about where the arm was when the mode was chosen
enum class ControlMode { effort, velocity, position, trajectory, cartesian_velocity, gravity_compensation, impedance };

constexpr bool isCompliant(ControlMode mode) {
  return mode == ControlMode::gravity_compensation || mode == ControlMode::impedance;
}

std::string toString(ControlMode mode);
/// Throws ConfigurationError listing the modes there are.
ControlMode toControlMode(const std::string& name);
std::vector<std::string> controlModeNames();

/// A point of a path, joints in the order of the command's names.
struct PathPoint {
  double time = 0.0;    // [s] since the path's start
  Eigen::VectorXd q;    // [rad or m]
  Eigen::VectorXd dq;   // [rad/s or m/s]; empty: not stated
  Eigen::VectorXd ddq;  // [rad/s² or m/s²]; empty: not stated
};

struct ArmCommand {
  ControlMode mode = ControlMode::velocity;
  std::vector<std::string> names;  // joints, in any order; empty: all of them in the arm's order
  Eigen::VectorXd values;          // in mode trajectory: none
  Eigen::VectorXd rates;           // position: how fast the target itself moves [rad/s or m/s]; empty: it rests
  std::vector<PathPoint> path;     // trajectory: empty stops the arm
  std::string frame;               // cartesian_velocity: the axes it is given in, base or tip link; empty: the base's
  // Of its making, on the publisher's clock; 0: none. In mode trajectory when it starts, on the arm's clock; 0: at
  // once.
  Nanoseconds stamp = 0;
  std::string source;  // who sent it; each has a clock of its own
};

}  // namespace demo_logger
