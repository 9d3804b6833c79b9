#pragma once

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// The velocities a joint may have at a position [rad/s or m/s]. Zero is always among them.
struct VelocityRange {
  double lower = 0.0;
  double upper = 0.0;
  bool lower_by_position = false;  // the position limit, not the velocity limit, sets it
  bool upper_by_position = false;
};

struct BrakingRule {
  double deceleration = 10.0;  // [rad/s² or m/s²]
  double period = 0.001;       // [s] from one decision to the next
  double margin = 0.0;         // [rad or m] before a position limit at which the joint comes to rest
};

/// Velocities from which the joint can still come to rest in front of its position limits, braking from the next tick
/// on, and which lie 3 % below its velocity limit, which leaves room for the tracking error.
VelocityRange velocityRange(const ArmJoint& joint, double position, const BrakingRule& rule);

}  // namespace demo_logger
