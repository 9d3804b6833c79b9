// counting_subscriber: the floor that no recorder can be below. Receives joint_states and teleop_cmd, counts, does
// nothing else; says the counts on SIGINT.
#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <cstdio>

int main(int argc, char** argv) {
  ros::init(argc, argv, "counting_subscriber");
  ros::NodeHandle node;
  long joint_states = 0;
  long commands = 0;
  const ros::Subscriber joint_state_subscriber = node.subscribe<sensor_msgs::JointState>(
      "joint_states", 1000, [&](const sensor_msgs::JointState::ConstPtr&) { ++joint_states; });
  const ros::Subscriber command_subscriber = node.subscribe<geometry_msgs::Twist>(
      "teleop_cmd", 1000, [&](const geometry_msgs::Twist::ConstPtr&) { ++commands; });
  ros::spin();
  std::printf("%ld %ld\n", joint_states, commands);
  return 0;
}
