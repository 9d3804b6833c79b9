// paced_publisher RATE_HZ DURATION_S SUBSCRIBERS: publishes a 7-joint JointState on joint_states at RATE_HZ and a Twist
// on teleop_cmd at 100 Hz, from the moment both have SUBSCRIBERS subscribers. Says "begin" and "end JOINT_STATES TWISTS
// LATEST_MS" on stdout.
#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace {

void sleepUntil(std::int64_t nanoseconds) {
  const timespec until{nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

std::int64_t steadyNow() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "paced_publisher", ros::init_options::AnonymousName);
  if (argc != 4) {
    std::fprintf(stderr, "usage: paced_publisher RATE_HZ DURATION_S SUBSCRIBERS\n");
    return 2;
  }
  const double rate = std::atof(argv[1]);
  const auto count = static_cast<std::int64_t>(rate * std::atof(argv[2]));
  const auto subscribers = static_cast<std::uint32_t>(std::atoi(argv[3]));
  ros::NodeHandle node;
  ros::Publisher joint_states = node.advertise<sensor_msgs::JointState>("joint_states", 1000);
  ros::Publisher commands = node.advertise<geometry_msgs::Twist>("teleop_cmd", 1000);
  while (ros::ok() && (joint_states.getNumSubscribers() < subscribers || commands.getNumSubscribers() < subscribers)) {
    ros::WallDuration(0.01).sleep();
  }
  ros::WallDuration(1.0).sleep();  // let connections settle before anything is counted
  std::printf("begin\n");
  std::fflush(stdout);

  sensor_msgs::JointState message;
  for (int joint = 1; joint <= 7; ++joint) message.name.push_back("panda_joint" + std::to_string(joint));
  message.position.resize(7);
  message.velocity.resize(7);
  message.effort.resize(7);
  geometry_msgs::Twist twist;
  const auto commands_every = static_cast<std::int64_t>(std::max(1.0, std::round(rate / 100.0)));
  const auto start = steadyNow();
  std::int64_t sent_commands = 0;
  double latest = 0.0;
  for (std::int64_t i = 0; i < count && ros::ok(); ++i) {
    const auto due = start + static_cast<std::int64_t>(static_cast<double>(i) * 1e9 / rate);
    sleepUntil(due);
    latest = std::max(latest, static_cast<double>(steadyNow() - due) * 1e-6);
    const double time = static_cast<double>(i) / rate;
    message.header.stamp = ros::Time::now();
    for (std::size_t joint = 0; joint < 7; ++joint) {
      message.position[joint] = std::sin(time + static_cast<double>(joint));
      message.velocity[joint] = std::cos(time + static_cast<double>(joint));
      message.effort[joint] = 10.0 * std::sin(2.0 * time + static_cast<double>(joint));
    }
    joint_states.publish(message);
    if (i % commands_every == 0) {
      twist.linear.x = 0.1 * std::sin(time);
      commands.publish(twist);
      ++sent_commands;
    }
  }
  std::printf("end %lld %lld %.1f\n", static_cast<long long>(count), static_cast<long long>(sent_commands), latest);
  std::fflush(stdout);
  ros::WallDuration(3.0).sleep();  // queued messages still leave
  return 0;
}
