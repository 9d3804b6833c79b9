// teleop_node: wires a joystick to commands. joy → teleop_cmd in mode rate, target_pose in mode pose. The map it uses
// stands in the parameter `teleop_map`, where the recorder finds it.
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <optional>

#include "demo_logger/channels/teleoperation.h"
#include "src/nodes/teleop_parameters.h"
#include "src/ros/node_main.h"

namespace demo_logger {
namespace {

constexpr std::uint32_t kQueue = 100;
constexpr double kComplaintPeriod = 5.0;  // [s]
constexpr double kExpiryPeriod = 0.02;    // [s] between looks at a silent device

struct TeleopNodeParameters {
  TeleoperationConfiguration teleoperation;
  bool publish_stamped = true;
  std::string frame;
};

TeleopNodeParameters readTeleopNodeParameters(const ros::NodeHandle& private_node) {
  Parameters parameters = readParameters(private_node);
  TeleopNodeParameters result;
  result.teleoperation = readTeleoperation(parameters);
  result.publish_stamped = parameters.flag("publish_stamped_twist", result.publish_stamped);
  result.frame = parameters.text("frame", result.frame);
  parameters.rejectUnknown();
  return result;
}

geometry_msgs::Twist toTwist(const Eigen::VectorXd& u) {
  geometry_msgs::Twist twist;
  twist.linear.x = u[0];
  twist.linear.y = u[1];
  twist.linear.z = u[2];
  twist.angular.x = u[3];
  twist.angular.y = u[4];
  twist.angular.z = u[5];
  return twist;
}

geometry_msgs::Pose toMessage(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Pose message;
  message.position.x = pose.translation().x();
  message.position.y = pose.translation().y();
  message.position.z = pose.translation().z();
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

Nanoseconds nanoseconds(const ros::Time& time) { return static_cast<Nanoseconds>(time.toNSec()); }

class TeleopNode {
 public:
  TeleopNode(ros::NodeHandle node, const TeleopNodeParameters& parameters)
      : parameters_(parameters), teleoperation_(parameters.teleoperation) {
    node.setParam("teleop_map", toParameter(teleoperation_.map().metadata()));
    if (parameters_.teleoperation.map.mode == TeleopMode::pose) {
      publisher_ = node.advertise<geometry_msgs::PoseStamped>("target_pose", kQueue);
    } else if (parameters_.publish_stamped) {
      publisher_ = node.advertise<geometry_msgs::TwistStamped>("teleop_cmd", kQueue);
    } else {
      publisher_ = node.advertise<geometry_msgs::Twist>("teleop_cmd", kQueue);
    }
    joy_ = node.subscribe("joy", kQueue, &TeleopNode::receive, this);
    expiry_ = node.createTimer(ros::Duration(kExpiryPeriod), [this](const ros::TimerEvent&) {
      publish(teleoperation_.expire(nanoseconds(ros::Time::now())));
    });
  }

 private:
  void receive(const sensor_msgs::Joy& joy) {
    DeviceReading reading;
    const ros::Time now = ros::Time::now();
    reading.receipt = nanoseconds(now);
    reading.stamp = joy.header.stamp.isZero() ? reading.receipt : nanoseconds(joy.header.stamp);
    reading.axes.assign(joy.axes.begin(), joy.axes.end());
    reading.buttons.assign(joy.buttons.begin(), joy.buttons.end());
    publish(teleoperation_.receive(reading));
    if (!teleoperation_.complaint().empty()) {
      ROS_WARN_STREAM_THROTTLE(kComplaintPeriod, "joy: " << teleoperation_.complaint());
    }
  }

  void publish(const std::optional<TeleopCommand>& command) {
    if (!command) return;
    std_msgs::Header header;
    header.stamp.fromNSec(static_cast<std::uint64_t>(command->stamp));
    header.frame_id = parameters_.frame;
    if (parameters_.teleoperation.map.mode == TeleopMode::pose) {
      geometry_msgs::PoseStamped target;
      target.header = header;
      target.pose = toMessage(toPose(command->output.value));
      publisher_.publish(target);
    } else if (parameters_.publish_stamped) {
      geometry_msgs::TwistStamped twist;
      twist.header = header;
      twist.twist = toTwist(command->output.value);
      publisher_.publish(twist);
    } else {
      publisher_.publish(toTwist(command->output.value));
    }
  }

  TeleopNodeParameters parameters_;
  Teleoperation teleoperation_;
  ros::Publisher publisher_;
  ros::Subscriber joy_;
  ros::Timer expiry_;
};

}  // namespace
}  // namespace demo_logger

int main(int argc, char** argv) {
  return demo_logger::runNode(argc, argv, "teleop", [] {
    demo_logger::TeleopNode teleop(ros::NodeHandle(), demo_logger::readTeleopNodeParameters(ros::NodeHandle("~")));
    ros::spin();
  });
}
