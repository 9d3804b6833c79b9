#include "src/ros/stream_converter.h"

#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int32.h>
#include <std_msgs/UInt8.h>

#include <vector>

#include "demo_logger/trajectory/error.h"
#include "src/ros/message_conversion.h"

namespace demo_logger {
namespace {

/// A message as it travels, with the memory it lives in.
struct Wire {
  std::vector<std::uint8_t> bytes;
  RawMessage raw;
};

template <class Message>
Wire serialise(const Message& message) {
  Wire wire;
  wire.bytes.resize(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(wire.bytes.data(), static_cast<std::uint32_t>(wire.bytes.size()));
  ros::serialization::serialize(stream, message);
  wire.raw = {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(), wire.bytes.data(),
              static_cast<std::uint32_t>(wire.bytes.size())};
  return wire;
}

template <class Message>
double numberOf(double value) {
  Message message;
  message.data = static_cast<decltype(message.data)>(value);
  const Wire wire = serialise(message);
  const StreamSample sample = toStreamSample(wire.raw, {});
  EXPECT_EQ(sample.type, StreamType::number);
  return sample.values.at(0);
}

std::string messageOf(const RawMessage& raw) {
  try {
    toStreamSample(raw, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(StreamConverterTest, ATwistFromTheWireIsTheTwistThatWasSent) {
  geometry_msgs::TwistStamped message;
  message.header.stamp = ros::Time(12, 34);
  message.twist.linear.x = 0.25;
  message.twist.angular.z = -1.5;
  const Wire wire = serialise(message);
  const StreamSample sample = toStreamSample(wire.raw, {});
  EXPECT_EQ(sample.arrival.stamp, 12'000'000'034);
  EXPECT_EQ(sample.values, (std::vector<double>{0.25, 0, 0, 0, 0, -1.5}));
}

TEST(StreamConverterTest, EveryListedTypeSaysWhichStreamItMakes) {
  EXPECT_EQ(findStreamConverter("geometry_msgs/Twist")->type, StreamType::twist);
  EXPECT_EQ(findStreamConverter("geometry_msgs/TransformStamped")->type, StreamType::pose);
  EXPECT_EQ(findStreamConverter("geometry_msgs/WrenchStamped")->type, StreamType::wrench);
  EXPECT_EQ(findStreamConverter("sensor_msgs/Joy")->type, StreamType::joy);
  EXPECT_EQ(findStreamConverter("sensor_msgs/JointState")->type, StreamType::joint_command);
  EXPECT_EQ(findStreamConverter("demo_logger/AppliedCommand")->type, StreamType::joint_command);
  EXPECT_EQ(findStreamConverter("std_msgs/Float32")->type, StreamType::number);
  EXPECT_EQ(findStreamConverter("sensor_msgs/Image"), nullptr);
}

TEST(StreamConverterTest, NumbersOfEveryWidthBecomeDoubles) {
  EXPECT_EQ(numberOf<std_msgs::Float64>(-0.1), -0.1);
  EXPECT_EQ(numberOf<std_msgs::Int32>(-2147483648.0), -2147483648.0);
  EXPECT_EQ(numberOf<std_msgs::UInt8>(255.0), 255.0);
  EXPECT_EQ(numberOf<std_msgs::Bool>(1.0), 1.0);
}

TEST(StreamConverterTest, AnUnknownTypeIsRefusedWithTheListOfKnownOnes) {
  const Wire wire = serialise(sensor_msgs::Image());
  const std::string message = messageOf(wire.raw);
  EXPECT_EQ(message.rfind("sensor_msgs/Image: cannot be recorded as a stream; supported are "
                          "demo_logger/AppliedCommand, geometry_msgs/Pose, ",
                          0),
            0U)
      << message;
  EXPECT_NE(message.find("std_msgs/Float64MultiArray"), std::string::npos) << message;
}

TEST(StreamConverterTest, AnotherDefinitionOfAKnownTypeIsRefusedRatherThanMisread) {
  Wire wire = serialise(geometry_msgs::Twist());
  wire.raw.md5sum = "0123456789abcdef0123456789abcdef";
  EXPECT_EQ(
      messageOf(wire.raw),
      "geometry_msgs/Twist: written with another definition of this type (md5 "
      "0123456789abcdef0123456789abcdef, expected 9f195f881246fdfa2798d1d3eebca84a); convert the bag with `rosbag "
      "fix`");
}

TEST(StreamConverterTest, AMessageCutShortIsRefused) {
  Wire wire = serialise(geometry_msgs::Twist());
  wire.raw.size -= 1;
  EXPECT_EQ(messageOf(wire.raw), "geometry_msgs/Twist: a message of 47 bytes ends before its content does");
}

TEST(StreamConverterTest, AJointStateFromTheWireKeepsEmptyArraysEmpty) {
  sensor_msgs::JointState message;
  message.name = {"elbow"};
  message.position = {0.5};
  const Wire wire = serialise(message);
  const JointStateSample sample = toJointStateSample(wire.raw, {});
  EXPECT_EQ(sample.names, std::vector<std::string>{"elbow"});
  EXPECT_EQ(sample.position, std::vector<double>{0.5});
  EXPECT_TRUE(sample.velocity.empty());
  EXPECT_TRUE(sample.effort.empty());
}

}  // namespace
}  // namespace demo_logger
