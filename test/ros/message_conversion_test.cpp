#include "src/ros/message_conversion.h"

#include <gtest/gtest.h>

#include <limits>

namespace demo_logger {
namespace {

using Names = std::vector<std::string>;
using Values = std::vector<double>;

Arrival makeArrival() {
  Arrival arrival;
  arrival.receipt = 5'000'000'007;
  arrival.steady = 77;
  arrival.publisher = "/driver";
  return arrival;
}

std_msgs::Header makeHeader() {
  std_msgs::Header header;
  header.stamp = ros::Time(1498489272, 909257840);
  header.frame_id = "base_link";
  return header;
}

geometry_msgs::Quaternion makeQuaternion() {
  geometry_msgs::Quaternion quaternion;
  quaternion.x = 0.5;
  quaternion.y = -0.5;
  quaternion.z = 0.25;
  quaternion.w = 0.75;
  return quaternion;
}

void expectStamped(const Arrival& arrival) {
  EXPECT_EQ(arrival.stamp, 1498489272909257840) << "a double would have rounded it by up to 238 ns";
  EXPECT_EQ(arrival.frame_id, "base_link");
  EXPECT_EQ(arrival.receipt, 5'000'000'007);
  EXPECT_EQ(arrival.steady, 77);
  EXPECT_EQ(arrival.publisher, "/driver");
}

void expectUnstamped(const Arrival& arrival) {
  EXPECT_EQ(arrival.stamp, 0);
  EXPECT_EQ(arrival.receipt, 5'000'000'007);
  EXPECT_EQ(arrival.publisher, "/driver");
}

TEST(MessageConversionTest, StampsKeepTheirNanoseconds) {
  const ros::Time latest(std::numeric_limits<std::uint32_t>::max(), 999'999'999);
  EXPECT_EQ(toNanoseconds(ros::Time(0, 0)), 0);
  EXPECT_EQ(toNanoseconds(ros::Time(1, 1)), 1'000'000'001);
  EXPECT_EQ(toNanoseconds(latest), 4'294'967'295'999'999'999);
  EXPECT_EQ(toRosTime(toNanoseconds(latest)), latest);
  EXPECT_EQ(toRosTime(-1), ros::Time(0, 0)) << "ROS has no time before its epoch";
}

TEST(MessageConversionTest, AJointStateKeepsNamesArraysAndHeader) {
  sensor_msgs::JointState message;
  message.header = makeHeader();
  message.name = {"elbow", "wrist"};
  message.position = {0.1, 0.2};
  message.velocity = {1.0, 2.0};
  const JointStateSample sample = toJointStateSample(message, makeArrival());
  expectStamped(sample.arrival);
  EXPECT_EQ(sample.names, (Names{"elbow", "wrist"}));
  EXPECT_EQ(sample.position, (Values{0.1, 0.2}));
  EXPECT_EQ(sample.velocity, (Values{1.0, 2.0}));
  EXPECT_TRUE(sample.effort.empty()) << "what the robot does not send is not filled in";
}

TEST(MessageConversionTest, ATwistIsVelocityThenRotationAndHasNoStampOfItsOwn) {
  geometry_msgs::TwistStamped message;
  message.header = makeHeader();
  message.twist.linear.x = 1.0;
  message.twist.linear.y = 2.0;
  message.twist.linear.z = 3.0;
  message.twist.angular.x = 4.0;
  message.twist.angular.y = 5.0;
  message.twist.angular.z = 6.0;

  const StreamSample stamped = toStreamSample(message, makeArrival());
  expectStamped(stamped.arrival);
  EXPECT_EQ(stamped.type, StreamType::twist);
  EXPECT_EQ(stamped.values, (Values{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(stamped.components.empty());

  const StreamSample plain = toStreamSample(message.twist, makeArrival());
  expectUnstamped(plain.arrival);
  EXPECT_EQ(plain.values, stamped.values);
}

TEST(MessageConversionTest, PosesAndTransformsArePositionThenQuaternionXyzw) {
  const Values expected{1, 2, 3, 0.5, -0.5, 0.25, 0.75};
  geometry_msgs::PoseStamped pose;
  pose.header = makeHeader();
  pose.pose.position.x = 1;
  pose.pose.position.y = 2;
  pose.pose.position.z = 3;
  pose.pose.orientation = makeQuaternion();
  geometry_msgs::TransformStamped transform;
  transform.header = makeHeader();
  transform.transform.translation.x = 1;
  transform.transform.translation.y = 2;
  transform.transform.translation.z = 3;
  transform.transform.rotation = makeQuaternion();

  for (const StreamSample& sample : {toStreamSample(pose, makeArrival()), toStreamSample(transform, makeArrival())}) {
    expectStamped(sample.arrival);
    EXPECT_EQ(sample.type, StreamType::pose);
    EXPECT_EQ(sample.values, expected);
  }
  for (const StreamSample& sample :
       {toStreamSample(pose.pose, makeArrival()), toStreamSample(transform.transform, makeArrival())}) {
    expectUnstamped(sample.arrival);
    EXPECT_EQ(sample.values, expected);
  }
}

TEST(MessageConversionTest, AWrenchIsForceThenTorque) {
  geometry_msgs::WrenchStamped message;
  message.header = makeHeader();
  message.wrench.force.x = 1;
  message.wrench.force.y = 2;
  message.wrench.force.z = 3;
  message.wrench.torque.x = 4;
  message.wrench.torque.y = 5;
  message.wrench.torque.z = 6;
  const StreamSample stamped = toStreamSample(message, makeArrival());
  expectStamped(stamped.arrival);
  EXPECT_EQ(stamped.type, StreamType::wrench);
  EXPECT_EQ(stamped.values, (Values{1, 2, 3, 4, 5, 6}));
  expectUnstamped(toStreamSample(message.wrench, makeArrival()).arrival);
}

TEST(MessageConversionTest, AJoyIsItsAxesThenItsButtons) {
  sensor_msgs::Joy message;
  message.header = makeHeader();
  message.axes = {0.5F, -1.0F};
  message.buttons = {0, 1, 0};
  const StreamSample sample = toStreamSample(message, makeArrival());
  expectStamped(sample.arrival);
  EXPECT_EQ(sample.type, StreamType::joy);
  EXPECT_EQ(sample.components, (Names{"axis0", "axis1", "button0", "button1", "button2"}));
  EXPECT_EQ(sample.values, (Values{0.5, -1.0, 0.0, 1.0, 0.0}));
}

TEST(MessageConversionTest, AJointCommandIsThePositionsElseTheVelocitiesElseTheEfforts) {
  sensor_msgs::JointState message;
  message.header = makeHeader();
  message.name = {"elbow", "wrist"};
  message.effort = {7, 8};
  StreamSample sample = toStreamSample(message, makeArrival());
  expectStamped(sample.arrival);
  EXPECT_EQ(sample.type, StreamType::joint_command);
  EXPECT_EQ(sample.components, message.name);
  EXPECT_EQ(sample.values, (Values{7, 8}));
  EXPECT_EQ(sample.units, (Names{"N m", "N m"}));

  message.velocity = {3, 4};
  sample = toStreamSample(message, makeArrival());
  EXPECT_EQ(sample.values, (Values{3, 4}));
  EXPECT_EQ(sample.units, (Names{"rad/s", "rad/s"}));

  message.position = {1, 2};
  sample = toStreamSample(message, makeArrival());
  EXPECT_EQ(sample.values, (Values{1, 2}));
  EXPECT_EQ(sample.units, (Names{"rad", "rad"}));
}

TEST(MessageConversionTest, AnArrayWithoutNamesIsNumberedLikeAJointStateWithoutNames) {
  std_msgs::Float64MultiArray doubles;
  doubles.data = {0.1, 0.2};
  const StreamSample sample = toStreamSample(doubles, makeArrival());
  expectUnstamped(sample.arrival);
  EXPECT_EQ(sample.type, StreamType::joint_command);
  EXPECT_EQ(sample.components, (Names{"joint0", "joint1"}));
  EXPECT_EQ(sample.values, (Values{0.1, 0.2}));

  std_msgs::Float32MultiArray floats;
  floats.data = {0.5F};
  EXPECT_EQ(toStreamSample(floats, makeArrival()).values, Values{0.5});
}

TEST(MessageConversionTest, AnAppliedCommandTakesItsUnitsFromTheControlMode) {
  AppliedCommand message;
  message.header = makeHeader();
  message.mode = "cartesian_velocity";
  message.name = {"vx", "wz"};
  message.command = {0.1, 0.2};
  message.torque = {9, 9, 9};
  StreamSample sample = toStreamSample(message, makeArrival());
  expectStamped(sample.arrival);
  EXPECT_EQ(sample.type, StreamType::joint_command);
  EXPECT_EQ(sample.components, message.name);
  EXPECT_EQ(sample.values, (Values{0.1, 0.2}));
  EXPECT_EQ(sample.units, (Names{"m/s", "rad/s"}));

  message.name = {"elbow", "wrist"};
  const std::vector<std::pair<std::string, std::string>> units = {
      {"velocity", "rad/s"}, {"position", "rad"}, {"trajectory", "rad"}, {"effort", "N m"}, {"impedance", "rad"}};
  for (const auto& [mode, unit] : units) {
    message.mode = mode;
    EXPECT_EQ(toStreamSample(message, makeArrival()).units, (Names{unit, unit})) << mode;
  }

  message.mode = "gravity_compensation";  // commands nothing
  message.name.clear();
  message.command.clear();
  EXPECT_TRUE(toStreamSample(message, makeArrival()).values.empty());
}

}  // namespace
}  // namespace demo_logger
