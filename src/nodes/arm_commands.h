#pragma once

#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <trajectory_msgs/JointTrajectory.h>

#include "demo_logger/simulation/arm_command.h"

namespace demo_logger {

/// Messages as commands; whether they are sound, the arm judges. `source` is left to the receiver.
ArmCommand toArmCommand(const geometry_msgs::Twist& message);
ArmCommand toArmCommand(const geometry_msgs::TwistStamped& message);
/// One value per joint, in the arm's order.
ArmCommand toArmCommand(ControlMode mode, const std_msgs::Float64MultiArray& message);
/// Positions to go to; velocities, if there are any, say how the target itself moves.
ArmCommand toArmCommand(const sensor_msgs::JointState& message);
/// A path that starts at the header's stamp, or at once if that is zero.
ArmCommand toArmCommand(const trajectory_msgs::JointTrajectory& message);

}  // namespace demo_logger
