#include <cmath>
#include <set>
#include <string>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/recording/stream_configuration.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr double kLargestLatency = 10.0;  // [s]
constexpr double kLongestWait = 1e9;      // [s] keeps instants within 64 bits

void checkWait(const std::string& name, double value) {
  if (value >= 0.0 && value <= kLongestWait) return;  // not NaN
  throw ConfigurationError(name + " is " + print(value) + " s, expected a finite time of at least 0 s");
}

void checkJoints(const SynchroniserConfiguration& configuration) {
  std::set<std::string> known;
  for (const std::string& joint : configuration.joints) {
    if (joint.empty()) throw ConfigurationError("joints has an empty name, expected the name of a joint");
    if (!known.insert(joint).second) {
      throw ConfigurationError("joints names '" + joint + "' twice, expected each joint once");
    }
  }
  if (configuration.merge_joint_states && configuration.joints.empty()) {
    throw ConfigurationError(
        "merge_joint_states is set, but joints is empty: which message makes a row follows from the first joint. List "
        "the arm's joints, or give a robot description with base and tip");
  }
}

void checkStream(const StreamConfiguration& stream, std::set<std::string>& prefixes) {
  if (stream.name.empty())
    throw ConfigurationError("streams has one without a name, expected a prefix for its columns");
  const std::string where = "streams: " + stream.name;
  if (!isPortable(stream.name)) {
    throw ConfigurationError("streams: the name '" + stream.name +
                             "' cannot begin a column, expected a letter or _, then letters, digits and _, at most " +
                             std::to_string(kLongestColumnName) + " characters");
  }
  if (!prefixes.insert(stream.name == "teleop_cmd" ? "u" : stream.name).second) {
    throw ConfigurationError(where + " is given twice (teleop_cmd is written as u), expected each name once");
  }
  if (stream.topic.empty()) throw ConfigurationError(where + " has an empty topic, expected the topic to record");
  if (!(std::abs(stream.latency) <= kLargestLatency)) {
    throw ConfigurationError(where + " has a latency of " + print(stream.latency) +
                             " s"
                             ", expected one from -10 s to 10 s");
  }
  if (stream.type == StreamType::joy && stream.alignment == Alignment::linear) {
    throw ConfigurationError(where +
                             " is a joystick aligned linear, but there is nothing between a button's 0 and 1; "
                             "expected hold or nearest");
  }
}

}  // namespace

void validate(const SynchroniserConfiguration& configuration) {
  checkWait("max_wait", configuration.max_wait);
  checkWait("max_gap", configuration.max_gap);
  checkWait("wait_for_streams", configuration.wait_for_streams);
  checkJoints(configuration);
  std::set<std::string> prefixes;
  for (const StreamConfiguration& stream : configuration.streams) checkStream(stream, prefixes);
}

}  // namespace demo_logger
