#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <cmath>

#include "test/nodes/waiting.h"

namespace demo_logger {
namespace {

sensor_msgs::Joy makeJoy(const std::vector<float>& axes, bool enabled) {
  sensor_msgs::Joy joy;
  joy.header.stamp = ros::Time::now();
  joy.axes = axes;
  joy.buttons = {enabled ? 1 : 0};
  return joy;
}

/// A teleop_node in a namespace, with ears on what it publishes.
template <typename Message>
struct Teleop {
  Teleop(const std::string& name, const std::string& topic)
      : node(name), output(node, topic), joy(node.advertise<sensor_msgs::Joy>("joy", 10)) {
    connected = waitFor([this] { return joy.getNumSubscribers() > 0 && output.publishers() > 0; });
  }

  ros::NodeHandle node;
  Listener<Message> output;
  ros::Publisher joy;
  bool connected = false;
};

TEST(TeleopNodeTest, EachReadingGivesOneStampedTwistWithTheStampOfTheReading) {
  Teleop<geometry_msgs::TwistStamped> teleop("", "teleop_cmd");
  ASSERT_TRUE(teleop.connected);
  const sensor_msgs::Joy joy = makeJoy({0.5F, 0.0F, -1.0F, 0.0F, 0.0F, 0.25F}, true);
  teleop.joy.publish(joy);
  ASSERT_TRUE(teleop.output.waitUntil([&](const auto& twist) { return twist.header.stamp == joy.header.stamp; }));
  const geometry_msgs::TwistStamped& twist = teleop.output.messages().front();
  EXPECT_EQ(twist.header.frame_id, "tool_tip");
  EXPECT_DOUBLE_EQ(twist.twist.linear.x, 0.125);
  EXPECT_DOUBLE_EQ(twist.twist.linear.z, -0.25);
  EXPECT_DOUBLE_EQ(twist.twist.angular.z, 0.2);
}

TEST(TeleopNodeTest, WhenTheDeviceFallsSilentOneZeroIsSentAndNoMore) {
  Teleop<geometry_msgs::TwistStamped> teleop("", "teleop_cmd");
  ASSERT_TRUE(teleop.connected);
  const auto isZero = [](const geometry_msgs::TwistStamped& twist) { return twist.twist.linear.x == 0.0; };
  teleop.joy.publish(makeJoy({0.5F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, true));
  ASSERT_TRUE(teleop.output.waitUntil(isZero));
  EXPECT_EQ(teleop.output.messages().size(), 2U);
  EXPECT_GE((teleop.output.messages()[1].header.stamp - teleop.output.messages()[0].header.stamp).toSec(), 0.5);

  teleop.joy.publish(makeJoy({1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, true));
  ASSERT_TRUE(teleop.output.waitUntil([](const auto& twist) { return twist.twist.linear.x == 0.25; }));
  EXPECT_EQ(teleop.output.messages().size(), 3U) << "a second zero came";
}

TEST(TeleopNodeTest, LettingTheEnableButtonGoSendsAZero) {
  Teleop<geometry_msgs::TwistStamped> teleop("", "teleop_cmd");
  ASSERT_TRUE(teleop.connected);
  teleop.joy.publish(makeJoy({0.5F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, true));
  const sensor_msgs::Joy released = makeJoy({0.5F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, false);
  teleop.joy.publish(released);
  ASSERT_TRUE(teleop.output.waitUntil([&](const auto& twist) { return twist.header.stamp == released.header.stamp; }));
  EXPECT_EQ(teleop.output.last().twist.linear.x, 0.0);
}

TEST(TeleopNodeTest, PlainTwistsComeByParameter) {
  Teleop<geometry_msgs::Twist> teleop("plain", "teleop_cmd");
  ASSERT_TRUE(teleop.connected);
  teleop.joy.publish(makeJoy({0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F}, true));
  EXPECT_TRUE(teleop.output.waitUntil([](const auto& twist) { return twist.linear.y == 0.25; }));
}

TEST(TeleopNodeTest, AWholeMatrixWithOffsetDeadZoneAndSaturationIsUsedAsGiven) {
  Teleop<geometry_msgs::TwistStamped> teleop("matrix", "teleop_cmd");
  ASSERT_TRUE(teleop.connected);
  const sensor_msgs::Joy joy = makeJoy({0.0625F, 1.0F}, false);
  teleop.joy.publish(joy);
  ASSERT_TRUE(teleop.output.waitUntil([&](const auto& twist) { return twist.header.stamp == joy.header.stamp; }));
  const geometry_msgs::Twist& twist = teleop.output.messages().front().twist;
  EXPECT_DOUBLE_EQ(twist.linear.x, 0.2) << "0.5 of axis 1, saturated";
  EXPECT_DOUBLE_EQ(twist.linear.y, 0.0) << "axis 0 is in its dead zone";
  EXPECT_DOUBLE_EQ(twist.linear.z, 0.1) << "the offset";
}

TEST(TeleopNodeTest, InModePoseTheDeviceIsAPose) {
  Teleop<geometry_msgs::PoseStamped> teleop("pose", "target_pose");
  ASSERT_TRUE(teleop.connected);
  const sensor_msgs::Joy joy = makeJoy({0.5F, 1.0F}, true);
  teleop.joy.publish(joy);
  ASSERT_TRUE(teleop.output.waitUntil([&](const auto& pose) { return pose.header.stamp == joy.header.stamp; }));
  const geometry_msgs::PoseStamped& target = teleop.output.messages().front();
  EXPECT_EQ(target.header.frame_id, "base_link");
  EXPECT_DOUBLE_EQ(target.pose.position.x, 0.65);
  EXPECT_DOUBLE_EQ(target.pose.position.z, 0.3);
  EXPECT_NEAR(target.pose.orientation.z, std::sqrt(0.5), 1e-7) << "a quarter turn about z";
  EXPECT_NEAR(target.pose.orientation.w, std::sqrt(0.5), 1e-7);
}

TEST(TeleopNodeTest, TheMapStandsOnTheParameterServerForTheRecorder) {
  Teleop<geometry_msgs::TwistStamped> teleop("matrix", "teleop_cmd");
  ASSERT_TRUE(teleop.connected);
  XmlRpc::XmlRpcValue map;
  ASSERT_TRUE(teleop.node.getParam("teleop_map", map));
  EXPECT_EQ(static_cast<std::string>(map["mode"]), "rate");
  EXPECT_EQ(static_cast<std::string>(map["inputs"][0]), "h_axis1");
  EXPECT_EQ(static_cast<std::string>(map["outputs"][5]), "u_wz");
  ASSERT_EQ(map["gain"].size(), 6);
  EXPECT_EQ(static_cast<double>(map["gain"][5][1]), 2.0);
  EXPECT_EQ(static_cast<double>(map["offset"][2]), 0.1);
  EXPECT_EQ(static_cast<double>(map["dead_zone"]), 0.1);
  EXPECT_EQ(static_cast<double>(map["saturation"][0]), 0.2);
}

}  // namespace
}  // namespace demo_logger
