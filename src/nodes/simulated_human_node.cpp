// simulated_human_node: sees the true arm, and moves a joystick or guides the tool, as its task is. Ends with it.
//   ground_truth/joint_states → joy, human_wrench
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>

#include <cmath>
#include <optional>

#include "demo_logger/simulation/simulated_human.h"
#include "src/nodes/seen_arm.h"
#include "src/nodes/simulated_hand_node.h"
#include "src/nodes/simulated_operator.h"
#include "src/nodes/teleop_parameters.h"
#include "src/ros/node_main.h"

namespace demo_logger {
namespace {

struct SimulatedHumanParameters {
  SimulatedHumanConfiguration human;
  std::uint32_t listeners = 1;  // nodes that must listen to joy before the human begins
  RobotDescription robot;
};

SimulatedHumanParameters readSimulatedHumanParameters(Parameters& parameters, const ros::NodeHandle& private_node) {
  SimulatedHumanParameters result;
  DescriptionOptions chain;
  chain.base = parameters.text("base", "");
  chain.tip = parameters.text("tip", "");

  SimulatedHumanConfiguration& human = result.human;
  human.seed = static_cast<std::uint64_t>(parameters.integer("seed", 1, {0.0, INFINITY, ""}));
  human.reading_period = 1.0 / parameters.number("joy_rate", 50.0, {10.0, 1000.0, "Hz"});
  human.reaction_delay = parameters.number("reaction_delay", human.reaction_delay, {0.0, 0.5, "s"});
  human.tremor = parameters.number("tremor", human.tremor, {0.0, 0.2, "of an axis"});
  human.largest_rate = parameters.number("largest_rate", human.largest_rate, {0.1, 1000.0, "1/s"});
  const OperatorButtons buttons = readOperatorButtons(parameters);
  human.start_button = buttons.start;
  human.stop_button = buttons.stop;
  result.listeners = readListeners(parameters, result.listeners);
  Parameters device = parameters.group("device");
  human.device = readTeleoperation(device);
  device.rejectUnknown();
  parameters.rejectUnknown();
  result.robot = describeRobot(readRobotDescription(private_node), chain);
  return result;
}

class SimulatedHumanNode {
 public:
  SimulatedHumanNode(ros::NodeHandle node, const SimulatedHumanParameters& parameters)
      : arm_(parameters.robot),
        human_(parameters.human),
        listeners_(parameters.listeners),
        period_(fromSeconds(parameters.human.reading_period)) {
    joy_ = node.advertise<sensor_msgs::Joy>("joy", kOperatorQueue);
    truth_ = node.subscribe("ground_truth/joint_states", kOperatorQueue, &SimulatedHumanNode::see, this);
    reminder_ = remindOfWaiting(node, joy_, listeners_, "joint states on " + truth_.getTopic(),
                                [this] { return !next_reading_; });
  }

 private:
  /// The readings are due by the arm's own stamps: then they are the same whatever the machine is busy with.
  void see(const sensor_msgs::JointState& state) {
    if (human_.finished()) return;
    const auto now = static_cast<Nanoseconds>(state.header.stamp.toNSec());
    if (next_reading_ ? now < *next_reading_ : joy_.getNumSubscribers() < listeners_) return;
    const std::optional<ArmState> arm = arm_.read(state, /*with_velocities=*/false);
    if (!arm) {
      ROS_ERROR_STREAM_THROTTLE(kReminderPeriod, arm_.complaint(truth_.getTopic(), false));
      return;
    }
    next_reading_ = next_reading_ ? *next_reading_ + period_ : now + period_;
    publish(human_.next(now, arm_.model().forwardKinematics(arm->q)), state.header.stamp);
    if (human_.finished()) endWithTask();
  }

  void publish(const DeviceReading& reading, const ros::Time& stamp) {
    sensor_msgs::Joy joy;
    joy.header.stamp = stamp;
    joy.axes.assign(reading.axes.begin(), reading.axes.end());
    joy.buttons.assign(reading.buttons.begin(), reading.buttons.end());
    joy_.publish(joy);
  }

  SeenArm arm_;
  SimulatedHuman human_;
  std::uint32_t listeners_;
  Nanoseconds period_;
  std::optional<Nanoseconds> next_reading_;
  ros::Publisher joy_;
  ros::Subscriber truth_;
  ros::WallTimer reminder_;
};

}  // namespace
}  // namespace demo_logger

int main(int argc, char** argv) {
  return demo_logger::runNode(argc, argv, "simulated_human", [] {
    const ros::NodeHandle private_node("~");
    demo_logger::Parameters parameters = demo_logger::readParameters(private_node);
    const std::string teleoperation = "teleoperation";
    std::vector<std::string> tasks = demo_logger::handTaskNames();
    tasks.insert(tasks.begin(), teleoperation);
    const std::string task = parameters.choice("task", teleoperation, tasks);
    if (task == teleoperation) {
      demo_logger::SimulatedHumanNode human(ros::NodeHandle(),
                                            demo_logger::readSimulatedHumanParameters(parameters, private_node));
      ros::spin();
      return;
    }
    demo_logger::SimulatedHandNode hand(ros::NodeHandle(),
                                        demo_logger::readSimulatedHandParameters(parameters, private_node, task));
    hand.run();
  });
}
