#pragma once

#include <cstdint>
#include <string>

#include "demo_logger/recording/sample.h"

namespace demo_logger {

/// A serialised ROS message as it came from the wire or from a bag. Borrows its bytes.
struct RawMessage {
  std::string datatype;  // "geometry_msgs/Twist"
  std::string md5sum;    // of the definition it was written with
  const std::uint8_t* bytes = nullptr;
  std::uint32_t size = 0;
};

/// How one message type becomes a stream. Live topics and bags use the same table.
struct StreamConverter {
  std::string datatype;
  std::string md5sum;
  StreamType type;
  StreamSample (*convert)(const RawMessage& message, Arrival arrival);
};

/// Null if the type cannot be recorded.
const StreamConverter* findStreamConverter(const std::string& datatype);

/// "geometry_msgs/Pose, geometry_msgs/PoseStamped, …", for error messages.
std::string supportedStreamTypes();

/// Throws Error in one sentence: a type that is not supported, another version of its definition, too few bytes.
StreamSample toStreamSample(const RawMessage& message, Arrival arrival);

/// As above for the joint states themselves.
JointStateSample toJointStateSample(const RawMessage& message, Arrival arrival);

}  // namespace demo_logger
