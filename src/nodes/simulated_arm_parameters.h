#pragma once

#include <ros/node_handle.h>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/simulation/tick_clock.h"

namespace demo_logger {

struct SimulatedArmParameters {
  RobotDescription robot;
  SimulatedArmConfiguration arm;
  TickClock::Configuration clock;
  int ticks_per_joint_state = 2;  // joint_states come with every so many control ticks
};

/// Reads the private parameters and the robot_description (config/simulated_arm.yaml lists them). Throws
/// ConfigurationError or ModelError in one sentence.
SimulatedArmParameters readSimulatedArmParameters(const ros::NodeHandle& private_node);

}  // namespace demo_logger
