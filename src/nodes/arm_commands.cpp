#include "src/nodes/arm_commands.h"

namespace demo_logger {
namespace {

Eigen::VectorXd toEigen(const geometry_msgs::Twist& twist) {
  Eigen::VectorXd values(6);
  values << twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y, twist.angular.z;
  return values;
}

Eigen::VectorXd toEigen(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::string withoutSlash(const std::string& frame) {  // as some publishers of ROS's first years still put it
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

Nanoseconds toNanoseconds(const ros::Time& stamp) { return static_cast<Nanoseconds>(stamp.toNSec()); }

}  // namespace

ArmCommand toArmCommand(const geometry_msgs::Twist& message) {
  ArmCommand command;
  command.mode = ControlMode::cartesian_velocity;
  command.values = toEigen(message);
  return command;
}

ArmCommand toArmCommand(const geometry_msgs::TwistStamped& message) {
  ArmCommand command = toArmCommand(message.twist);
  command.frame = withoutSlash(message.header.frame_id);
  command.stamp = toNanoseconds(message.header.stamp);
  return command;
}

ArmCommand toArmCommand(ControlMode mode, const std_msgs::Float64MultiArray& message) {
  ArmCommand command;
  command.mode = mode;
  command.values = toEigen(message.data);
  return command;
}

ArmCommand toArmCommand(const sensor_msgs::JointState& message) {
  ArmCommand command;
  command.mode = ControlMode::position;
  command.names = message.name;
  command.values = toEigen(message.position);
  command.rates = toEigen(message.velocity);
  command.stamp = toNanoseconds(message.header.stamp);
  return command;
}

ArmCommand toArmCommand(const trajectory_msgs::JointTrajectory& message) {
  ArmCommand command;
  command.mode = ControlMode::trajectory;
  command.names = message.joint_names;
  command.stamp = toNanoseconds(message.header.stamp);
  for (const trajectory_msgs::JointTrajectoryPoint& point : message.points) {
    command.path.push_back({point.time_from_start.toSec(), toEigen(point.positions), toEigen(point.velocities),
                            toEigen(point.accelerations)});
  }
  return command;
}

}  // namespace demo_logger
