#include <gtest/gtest.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>
#include <sensor_msgs/JointState.h>

#include "test/nodes/waiting.h"

namespace demo_logger {
namespace {

TEST(SimulatedClockTest, TheArmIsTheClockOfAllAndJointStatesAreOnIt) {
  ros::NodeHandle node;
  Listener<rosgraph_msgs::Clock> clock(node, "/clock");
  Listener<sensor_msgs::JointState> joint_states(node, "joint_states");
  ASSERT_TRUE(clock.wait(500));
  ASSERT_TRUE(joint_states.wait(500));
  for (std::size_t i = 1; i < clock.messages().size(); ++i) {
    ASSERT_EQ((clock.messages()[i].clock - clock.messages()[i - 1].clock).toNSec(), 2'000'000) << "never a gap";
  }
  EXPECT_GE(joint_states.messages().front().header.stamp, ros::Time(1)) << "a zero stamp would mean none";
  EXPECT_LT(joint_states.last().header.stamp, ros::Time(1000)) << "simulated, not the wall's time";
  EXPECT_TRUE(ros::Time::isSimTime());
  EXPECT_GT(ros::Time::now(), ros::Time(1));
}

}  // namespace
}  // namespace demo_logger
