#include "src/nodes/simulated_hand_node.h"

#include <geometry_msgs/WrenchStamped.h>

#include <algorithm>
#include <cmath>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr double kJoyPeriod = 0.02;  // [s]

geometry_msgs::Vector3 toMessage(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

}  // namespace

SimulatedHandParameters readSimulatedHandParameters(Parameters& parameters, const ros::NodeHandle& private_node,
                                                    const std::string& task) {
  SimulatedHandParameters result;
  DescriptionOptions chain;
  chain.base = parameters.text("base", "");
  chain.tip = parameters.text("tip", "");
  SimulatedHandConfiguration& hand = result.hand;
  hand.task = handTask(task);
  hand.seed = static_cast<std::uint64_t>(parameters.integer("seed", 1, {0.0, INFINITY, ""}));
  const auto read = [&](const std::string& name, double& value, const std::string& unit) {
    value = parameters.number(name, value, {0.0, INFINITY, unit});
  };
  read("stiffness", hand.stiffness, "N/m");
  read("damping", hand.damping, "N s/m");
  read("turning_stiffness", hand.turning_stiffness, "N m/rad");
  read("turning_damping", hand.turning_damping, "N m s/rad");
  read("largest_force", hand.largest_force, "N");
  read("largest_torque", hand.largest_torque, "N m");
  read("grasp_ramp", hand.grasp_ramp, "s");
  read("release_ramp", hand.release_ramp, "s");
  read("tremor", hand.tremor, "N");
  result.buttons = readOperatorButtons(parameters);
  result.listeners = readListeners(parameters, result.buttons.any() ? 1 : 0);
  parameters.rejectUnknown();
  result.robot = describeRobot(readRobotDescription(private_node), chain);
  return result;
}

SimulatedHandNode::SimulatedHandNode(ros::NodeHandle node, const SimulatedHandParameters& parameters)
    : parameters_(parameters), arm_(parameters.robot), hand_(parameters.hand) {
  wrench_ = node.advertise<geometry_msgs::WrenchStamped>("human_wrench", kOperatorQueue);
  joy_ = node.advertise<sensor_msgs::Joy>("joy", kOperatorQueue);
  // Without delay: TCP likes to collect small messages for some 40 ms, which no hand could hold an arm with.
  truth_ = node.subscribe("ground_truth/joint_states", kOperatorQueue, &SimulatedHandNode::see, this,
                          ros::TransportHints().tcpNoDelay());
  reminder_ =
      remindOfWaiting(node, joy_, parameters.listeners,
                      "joint states on " + truth_.getTopic() + ", for an arm that listens to " + wrench_.getTopic(),
                      [this] { return !begun_; });
}

void SimulatedHandNode::run() {
  ros::spin();
  if (!hand_.slipped()) return;
  throw Error(
      "simulated hand: the tool slipped out of the hand, which it flung about; is the machine too busy for the arm and "
      "the hand to answer each other within a few milliseconds, or the hand too stiff for this arm?");
}

bool SimulatedHandNode::awaited() const {
  return wrench_.getNumSubscribers() > 0 && joy_.getNumSubscribers() >= parameters_.listeners;
}

void SimulatedHandNode::see(const sensor_msgs::JointState& state) {
  if (hand_.finished() || (!begun_ && !awaited())) return;
  const std::optional<ArmState> arm = arm_.read(state, /*with_velocities=*/true);
  if (!arm) {
    ROS_ERROR_STREAM_THROTTLE(kReminderPeriod, arm_.complaint(truth_.getTopic(), true));
    return;
  }
  begun_ = true;
  SeenTool tool;
  tool.X_base_tool = arm_.model().forwardKinematics(arm->q);
  tool.twist = arm_.model().jacobian(arm->q) * arm->dq;
  const HandAction action = hand_.act(static_cast<Nanoseconds>(state.header.stamp.toNSec()), tool);
  push(action.wrench, tool.X_base_tool, state.header.stamp);
  press(action, state.header.stamp);
  if (hand_.finished()) endWithTask();
}

/// Also when it holds nothing: then the arm need not wait until the last push has timed out.
void SimulatedHandNode::push(const TipWrench& wrench, const Eigen::Isometry3d& X_base_tool, const ros::Time& stamp) {
  const Eigen::Matrix3d R_tool_base = X_base_tool.linear().transpose();
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parameters_.robot.tip;
  message.wrench.force = toMessage(R_tool_base * wrench.force);
  message.wrench.torque = toMessage(R_tool_base * wrench.torque);
  wrench_.publish(message);
}

void SimulatedHandNode::press(const HandAction& action, const ros::Time& stamp) {
  const int most = std::max(parameters_.buttons.start, parameters_.buttons.stop);
  if (most < 0 || (next_joy_ && stamp < *next_joy_)) return;
  next_joy_ = stamp + ros::Duration(kJoyPeriod);
  sensor_msgs::Joy joy;
  joy.header.stamp = stamp;
  joy.buttons.resize(static_cast<std::size_t>(most) + 1);
  const auto set = [&](int button, bool pressed) {
    if (button >= 0 && pressed) joy.buttons[static_cast<std::size_t>(button)] = 1;
  };
  set(parameters_.buttons.start, action.start_pressed);
  set(parameters_.buttons.stop, action.stop_pressed);
  joy_.publish(joy);
}

}  // namespace demo_logger
