#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>

#include <cmath>

#include "test/nodes/waiting.h"

namespace demo_logger {
namespace {

/// An arm that does not move, whose time goes on as fast as the human answers.
TEST(SimulatedHumanNodeTest, AnswersEachReadingPeriodOfTheArmsTimePlaysItsTaskAndEnds) {
  ros::NodeHandle node;
  Listener<sensor_msgs::Joy> joy(node, "joy");
  ros::Publisher truth = node.advertise<sensor_msgs::JointState>("ground_truth/joint_states", 10);
  ASSERT_TRUE(waitFor([&] { return truth.getNumSubscribers() > 0 && joy.publishers() > 0; }));

  sensor_msgs::JointState state;
  // Another order than the URDF's, and a joint that is not the arm's.
  state.name = {"joint_7", "joint_6", "joint_5", "joint_4", "gripper", "joint_3", "joint_2", "joint_1"};
  state.position = {0.0, 1.44, 0.0, 1.4, 0.02, 0.0, 0.3, 0.0};
  state.header.stamp = ros::Time(100);
  while (joy.publishers() > 0 && joy.messages().size() < 2000) {
    const std::size_t answered = joy.messages().size();
    truth.publish(state);
    ASSERT_TRUE(waitFor([&] { return joy.messages().size() > answered || joy.publishers() == 0; }));
    if (joy.messages().size() > answered) {
      EXPECT_EQ(joy.last().header.stamp, state.header.stamp);
    }
    state.header.stamp += ros::Duration(0.02);
  }
  EXPECT_EQ(joy.publishers(), 0U) << "the node ends with its task";

  const double seconds = static_cast<double>(joy.messages().size()) * 0.02;
  EXPECT_NEAR(seconds, 20.5, 2.0);
  bool started = false;
  bool moved = false;
  bool stopped = false;
  for (const sensor_msgs::Joy& reading : joy.messages()) {
    started = started || reading.buttons[1] == 1;
    for (const float axis : reading.axes) moved = moved || (started && reading.buttons[0] == 1 && std::abs(axis) > 0.1);
    stopped = stopped || (moved && reading.buttons[2] == 1);
  }
  EXPECT_TRUE(started);
  EXPECT_TRUE(moved);
  EXPECT_TRUE(stopped);
}

}  // namespace
}  // namespace demo_logger
