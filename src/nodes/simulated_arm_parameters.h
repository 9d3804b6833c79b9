#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/robot/attached_links.h"
#include "demo_logger/robot/robot_description.h"
#include "demo_logger/simulation/joint_state_faults.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/simulation/tick_clock.h"

namespace demo_logger {

struct SimulatedArmParameters {
  RobotDescription robot;
  SimulatedArmConfiguration arm;
  TickClock::Configuration clock;
  int ticks_per_joint_state = 2;  // joint_states come with every so many control ticks
  JointStateFaultsConfiguration faults;
  std::vector<AttachedLink> links;  // where wrenches may act
  std::optional<BodyInertia> load;
  double wrench_timeout = 0.2;  // [s] how long a human_wrench acts without the next one
  std::string initial_state;    // a file that ~save_state wrote; empty: initial_position, at rest
  std::string state_dir;        // where ~save_state writes
};

/// Reads the private parameters and the robot_description (config/simulated_arm.yaml lists them). Throws
/// ConfigurationError or ModelError in one sentence.
SimulatedArmParameters readSimulatedArmParameters(const ros::NodeHandle& private_node);

}  // namespace demo_logger
