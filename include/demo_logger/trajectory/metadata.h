#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// What stands beside the numbers of an episode. The field names are the keys of the JSON sidecar (doc/file_format.md).
using ParameterValue =
    std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>, std::vector<double>>;

struct RobotMetadata {
  std::string name;
  std::string urdf_sha256;
  std::string base;
  std::string tip;
  std::vector<std::string> joints;
};

/// What the effort of the joint states means; decides how the human torque is recovered from it.
struct EffortMetadata {
  std::string side = "motor";      // motor or link
  std::string timing = "instant";  // instant: a sensor at the stamp; held: a command from its tick to the next
  bool includes_gravity = true;
  double control_period = 0.0;  // [s] of the arm's controller, 0 if unknown
};

/// Throws ConfigurationError where it cannot be told from it when and on which side a torque acted: an unknown side or
/// timing, or held efforts without a control period, or with one longer than 1 s.
void validate(const EffortMetadata& effort);

/// The map from the device to the command: output = gain * input + offset.
struct TeleopMapMetadata {
  std::string mode;                       // rate or pose
  std::vector<std::string> inputs;        // device columns, length k
  std::vector<std::string> outputs;       // command columns, length m
  std::vector<std::vector<double>> gain;  // m rows of k
  std::vector<double> offset;             // length m
  double dead_zone = 0.0;                 // of the device, in its own unit
  std::vector<double> saturation;         // largest magnitude of each output, empty if none
};

struct DelaySummary {
  double min = 0.0;     // [s]
  double median = 0.0;  // [s]
  double max = 0.0;     // [s]
};

struct StreamMetadata {
  std::string name;
  std::string topic;
  std::string type;  // of its messages: "geometry_msgs/Twist"
  std::string frame_id;
  std::vector<std::string> publishers;
  bool stamped = true;
  std::string align;     // hold, linear or nearest
  double latency = 0.0;  // [s]
  std::uint64_t received = 0;
  std::uint64_t used = 0;
  std::uint64_t late = 0;
  std::uint64_t dropped = 0;
  double largest_gap = 0.0;  // [s]
  DelaySummary receipt_delay;
};

/// An error makes columns useless until someone acts; a warning does not.
enum class Severity { warning, error };

/// Something that went wrong and was not hidden.
struct Fault {
  Nanoseconds stamp = 0;  // when it was first seen, ROS time
  std::string what;       // one sentence
  std::uint64_t count = 1;
  Severity severity = Severity::warning;
};

struct Provenance {
  std::string parent;              // file this one was made from
  std::vector<std::string> steps;  // commands, oldest first
};

struct Metadata {
  std::string id;
  std::string channel = "unknown";  // teleoperation, kinesthetic, vr, unknown
  std::string task;
  std::string operator_name;        // key `operator`
  std::string outcome = "unknown";  // success, failure, unknown
  std::string notes;
  std::string status = "complete";  // complete, or "interrupted: why"
  Nanoseconds start_stamp = 0;      // of the first row, ROS time
  double duration = 0.0;            // [s]
  std::uint64_t rows = 0;
  RobotMetadata robot;
  EffortMetadata effort;
  std::optional<TeleopMapMetadata> teleop_map;
  std::vector<StreamMetadata> streams;
  std::map<std::string, std::uint64_t> counters;
  std::vector<Fault> faults;
  std::map<std::string, ParameterValue> parameters;
  std::map<std::string, std::string> original_names;  // column name -> name before it was made portable
  std::string software;
  Provenance provenance;
  std::map<std::string, std::string> other;  // keys of the sidecar that are not ours -> their JSON, kept as it is
};

}  // namespace demo_logger
