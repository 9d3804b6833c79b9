#pragma once

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <optional>

#include "demo_logger/simulation/simulated_hand.h"
#include "src/nodes/seen_arm.h"
#include "src/nodes/simulated_operator.h"
#include "src/ros/parameters.h"

namespace demo_logger {

struct SimulatedHandParameters {
  SimulatedHandConfiguration hand;
  OperatorButtons buttons;
  std::uint32_t listeners = 0;  // nodes that must listen to joy before the hand begins
  RobotDescription robot;
};

/// Reads what is there besides `task`, which the caller has read, and the robot_description. Throws ConfigurationError
/// or ModelError in one sentence.
SimulatedHandParameters readSimulatedHandParameters(Parameters& parameters, const ros::NodeHandle& private_node,
                                                    const std::string& task);

/// Wires a SimulatedHand to ROS: it sees the true arm, and pushes on the tool.
///   subscribes  ground_truth/joint_states
///   publishes   human_wrench (at the tool's origin, in its axes, one for each joint state, with its stamp), joy
/// The course goes by the arm's own stamps, so that it is the same whatever the machine is busy with. A wrench comes to
/// the arm a tick or a few after the state that it answers, which the hand's damping bears (SimulatedHand).
class SimulatedHandNode {
 public:
  SimulatedHandNode(ros::NodeHandle node, const SimulatedHandParameters& parameters);

  /// Until the task is done. Throws Error if the tool slipped out of the hand.
  void run();

 private:
  void see(const sensor_msgs::JointState& state);
  bool awaited() const;
  void push(const TipWrench& wrench, const Eigen::Isometry3d& X_base_tool, const ros::Time& stamp);
  void press(const HandAction& action, const ros::Time& stamp);

  SimulatedHandParameters parameters_;
  SeenArm arm_;
  SimulatedHand hand_;
  bool begun_ = false;
  std::optional<ros::Time> next_joy_;
  ros::Publisher wrench_;
  ros::Publisher joy_;
  ros::Subscriber truth_;
  ros::WallTimer reminder_;
};

}  // namespace demo_logger
