#include "src/ros/message_conversion.h"

#include <utility>

namespace demo_logger {
namespace {

Arrival withHeader(Arrival arrival, const std_msgs::Header& header) {
  arrival.stamp = toNanoseconds(header.stamp);
  arrival.frame_id = header.frame_id;
  return arrival;
}

StreamSample makeSample(StreamType type, Arrival arrival, std::vector<double> values) {
  StreamSample sample;
  sample.type = type;
  sample.arrival = std::move(arrival);
  sample.values = std::move(values);
  return sample;
}

StreamSample makePose(Arrival arrival, double x, double y, double z, const geometry_msgs::Quaternion& orientation) {
  return makeSample(StreamType::pose, std::move(arrival),
                    {x, y, z, orientation.x, orientation.y, orientation.z, orientation.w});
}

std::vector<std::string> numbered(const char* prefix, std::size_t count) {
  std::vector<std::string> names;
  names.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    names.push_back(prefix + std::to_string(i));
  }
  return names;
}

template <class Array>
StreamSample makeUnnamedCommand(Arrival arrival, const Array& data) {
  StreamSample sample =
      makeSample(StreamType::joint_command, std::move(arrival), std::vector<double>(data.begin(), data.end()));
  sample.components = numbered("joint", sample.values.size());
  return sample;
}

/// Unit of one component of a command in a control mode of the arm.
std::string commandUnit(const std::string& mode, const std::string& component) {
  if (mode == "cartesian_velocity") {
    return component.rfind('w', 0) == 0 ? "rad/s" : "m/s";
  }
  if (mode == "velocity") {
    return "rad/s";
  }
  return mode == "position" || mode == "trajectory" || mode == "impedance" ? "rad" : "N m";
}

}  // namespace

Nanoseconds toNanoseconds(const ros::Time& time) {
  return static_cast<Nanoseconds>(time.sec) * kNanosecondsPerSecond + static_cast<Nanoseconds>(time.nsec);
}

ros::Time toRosTime(Nanoseconds stamp) {
  ros::Time time;
  if (stamp > 0) {
    time.sec = static_cast<std::uint32_t>(stamp / kNanosecondsPerSecond);
    time.nsec = static_cast<std::uint32_t>(stamp % kNanosecondsPerSecond);
  }
  return time;
}

JointStateSample toJointStateSample(sensor_msgs::JointState message, Arrival arrival) {
  JointStateSample sample;
  sample.arrival = std::move(arrival);
  sample.arrival.stamp = toNanoseconds(message.header.stamp);
  sample.arrival.frame_id = std::move(message.header.frame_id);
  sample.names = std::move(message.name);
  sample.position = std::move(message.position);
  sample.velocity = std::move(message.velocity);
  sample.effort = std::move(message.effort);
  return sample;
}

StreamSample toStreamSample(const geometry_msgs::Twist& message, Arrival arrival) {
  const auto& v = message.linear;
  const auto& w = message.angular;
  return makeSample(StreamType::twist, std::move(arrival), {v.x, v.y, v.z, w.x, w.y, w.z});
}

StreamSample toStreamSample(const geometry_msgs::TwistStamped& message, Arrival arrival) {
  return toStreamSample(message.twist, withHeader(std::move(arrival), message.header));
}

StreamSample toStreamSample(const geometry_msgs::Pose& message, Arrival arrival) {
  const auto& p = message.position;
  return makePose(std::move(arrival), p.x, p.y, p.z, message.orientation);
}

StreamSample toStreamSample(const geometry_msgs::PoseStamped& message, Arrival arrival) {
  return toStreamSample(message.pose, withHeader(std::move(arrival), message.header));
}

StreamSample toStreamSample(const geometry_msgs::Transform& message, Arrival arrival) {
  const auto& p = message.translation;
  return makePose(std::move(arrival), p.x, p.y, p.z, message.rotation);
}

StreamSample toStreamSample(const geometry_msgs::TransformStamped& message, Arrival arrival) {
  return toStreamSample(message.transform, withHeader(std::move(arrival), message.header));
}

StreamSample toStreamSample(const geometry_msgs::Wrench& message, Arrival arrival) {
  const auto& f = message.force;
  const auto& t = message.torque;
  return makeSample(StreamType::wrench, std::move(arrival), {f.x, f.y, f.z, t.x, t.y, t.z});
}

StreamSample toStreamSample(const geometry_msgs::WrenchStamped& message, Arrival arrival) {
  return toStreamSample(message.wrench, withHeader(std::move(arrival), message.header));
}

StreamSample toStreamSample(const sensor_msgs::Joy& message, Arrival arrival) {
  StreamSample sample = makeSample(StreamType::joy, withHeader(std::move(arrival), message.header), {});
  sample.components = numbered("axis", message.axes.size());
  const std::vector<std::string> buttons = numbered("button", message.buttons.size());
  sample.components.insert(sample.components.end(), buttons.begin(), buttons.end());
  sample.values.assign(message.axes.begin(), message.axes.end());
  sample.values.insert(sample.values.end(), message.buttons.begin(), message.buttons.end());
  return sample;
}

StreamSample toStreamSample(const sensor_msgs::JointState& message, Arrival arrival) {
  const bool positions = !message.position.empty();
  const bool velocities = !positions && !message.velocity.empty();
  StreamSample sample = makeSample(StreamType::joint_command, withHeader(std::move(arrival), message.header),
                                   positions    ? message.position
                                   : velocities ? message.velocity
                                                : message.effort);
  sample.components = message.name.empty() ? numbered("joint", sample.values.size()) : message.name;
  sample.units.assign(sample.components.size(), positions ? "rad" : velocities ? "rad/s" : "N m");
  return sample;
}

StreamSample toStreamSample(const AppliedCommand& message, Arrival arrival) {
  StreamSample sample =
      makeSample(StreamType::joint_command, withHeader(std::move(arrival), message.header), message.command);
  sample.components = message.name;
  for (const std::string& component : sample.components) {
    sample.units.push_back(commandUnit(message.mode, component));
  }
  return sample;
}

StreamSample toStreamSample(const std_msgs::Float64MultiArray& message, Arrival arrival) {
  return makeUnnamedCommand(std::move(arrival), message.data);
}

StreamSample toStreamSample(const std_msgs::Float32MultiArray& message, Arrival arrival) {
  return makeUnnamedCommand(std::move(arrival), message.data);
}

}  // namespace demo_logger
