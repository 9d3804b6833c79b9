#include "src/ros/stream_converter.h"

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float32.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int16.h>
#include <std_msgs/Int32.h>
#include <std_msgs/Int64.h>
#include <std_msgs/Int8.h>
#include <std_msgs/UInt16.h>
#include <std_msgs/UInt32.h>
#include <std_msgs/UInt64.h>
#include <std_msgs/UInt8.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "demo_logger/trajectory/error.h"
#include "src/ros/message_conversion.h"

namespace demo_logger {
namespace {

template <class Message>
Message deserialise(const RawMessage& raw) {
  if (raw.md5sum != ros::message_traits::md5sum<Message>()) {
    throw Error(raw.datatype + ": written with another definition of this type (md5 " + raw.md5sum + ", expected " +
                ros::message_traits::md5sum<Message>() + "); convert the bag with `rosbag fix`");
  }
  // IStream wants a pointer to non-const bytes but only reads them.
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(raw.bytes), raw.size);
  Message message;
  try {
    ros::serialization::deserialize(stream, message);
  } catch (const std::exception&) {  // StreamOverrunException, or bad_alloc and length_error of a wild array size
    throw Error(raw.datatype + ": a message of " + std::to_string(raw.size) + " bytes ends before its content does");
  }
  return message;
}

template <class Message>
StreamSample convertMessage(const RawMessage& raw, Arrival arrival) {
  return toStreamSample(deserialise<Message>(raw), std::move(arrival));
}

template <class Message>
StreamSample convertNumber(const RawMessage& raw, Arrival arrival) {
  StreamSample sample;
  sample.type = StreamType::number;
  sample.arrival = std::move(arrival);
  sample.values = {static_cast<double>(deserialise<Message>(raw).data)};
  return sample;
}

template <class Message>
StreamConverter converter(StreamType type) {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(), type,
          &convertMessage<Message>};
}

template <class Message>
StreamConverter numberConverter() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(), StreamType::number,
          &convertNumber<Message>};
}

const std::vector<StreamConverter>& converters() {
  static const std::vector<StreamConverter> table = {
      converter<AppliedCommand>(StreamType::joint_command),
      converter<geometry_msgs::Pose>(StreamType::pose),
      converter<geometry_msgs::PoseStamped>(StreamType::pose),
      converter<geometry_msgs::Transform>(StreamType::pose),
      converter<geometry_msgs::TransformStamped>(StreamType::pose),
      converter<geometry_msgs::Twist>(StreamType::twist),
      converter<geometry_msgs::TwistStamped>(StreamType::twist),
      converter<geometry_msgs::Wrench>(StreamType::wrench),
      converter<geometry_msgs::WrenchStamped>(StreamType::wrench),
      converter<sensor_msgs::JointState>(StreamType::joint_command),
      converter<sensor_msgs::Joy>(StreamType::joy),
      numberConverter<std_msgs::Bool>(),
      numberConverter<std_msgs::Float32>(),
      converter<std_msgs::Float32MultiArray>(StreamType::joint_command),
      numberConverter<std_msgs::Float64>(),
      converter<std_msgs::Float64MultiArray>(StreamType::joint_command),
      numberConverter<std_msgs::Int8>(),
      numberConverter<std_msgs::Int16>(),
      numberConverter<std_msgs::Int32>(),
      numberConverter<std_msgs::Int64>(),
      numberConverter<std_msgs::UInt8>(),
      numberConverter<std_msgs::UInt16>(),
      numberConverter<std_msgs::UInt32>(),
      numberConverter<std_msgs::UInt64>(),
  };
  return table;
}

}  // namespace

const StreamConverter* findStreamConverter(const std::string& datatype) {
  const auto& table = converters();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const StreamConverter& one) { return one.datatype == datatype; });
  return found == table.end() ? nullptr : &*found;
}

std::string supportedStreamTypes() {
  std::string list;
  for (const StreamConverter& one : converters()) {
    list += (list.empty() ? "" : ", ") + one.datatype;
  }
  return list;
}

StreamSample toStreamSample(const RawMessage& message, Arrival arrival) {
  const StreamConverter* converter = findStreamConverter(message.datatype);
  if (converter == nullptr) {
    throw Error(message.datatype + ": cannot be recorded as a stream; supported are " + supportedStreamTypes());
  }
  StreamSample sample = converter->convert(message, std::move(arrival));
  sample.message_type = converter->datatype;
  return sample;
}

JointStateSample toJointStateSample(const RawMessage& message, Arrival arrival) {
  return toJointStateSample(deserialise<sensor_msgs::JointState>(message), std::move(arrival));
}

}  // namespace demo_logger
