#pragma once

#include <string>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// When a message says it happened, and when it reached this machine.
struct Arrival {
  Nanoseconds stamp = 0;    // of the header, ROS time; 0: the publisher gave none
  Nanoseconds receipt = 0;  // ROS time, what a bag stores
  Nanoseconds steady = 0;   // steady clock; equal to `receipt` for bags and under simulated time
  std::string publisher;    // node name, empty if unknown
  std::string frame_id;
};

/// One JointState. Each array is empty or as long as `names`; an empty `names` means joint0, joint1, …
struct JointStateSample {
  Arrival arrival;
  std::vector<std::string> names;
  std::vector<double> position;
  std::vector<double> velocity;
  std::vector<double> effort;
};

/// The kinds of messages a stream can carry. The first four fix their columns; joy and joint_command take them from
/// the first message.
enum class StreamType { twist, pose, wrench, number, joy, joint_command };

/// One message of a stream, flattened in the order of its columns.
///   twist vx vy vz wx wy wz · pose x y z qx qy qz qw · wrench fx fy fz tx ty tz · number value ·
///   joy axis0 … button0 … · joint_command: one value per name
struct StreamSample {
  Arrival arrival;
  std::string message_type;  // as the source calls it ("geometry_msgs/Twist"), for the metadata; may be empty
  StreamType type = StreamType::number;
  std::vector<std::string> components;  // joy: axis0 … button0 …; joint_command: joint names; else empty
  std::vector<std::string> units;       // as long as components, or empty
  std::vector<double> values;
};

}  // namespace demo_logger
