#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/formats/demonstration_file.h"
#include "src/tool/robot_options.h"

namespace demo_logger {

/// What every verb takes that makes a recording with further columns out of each recording, by the robot's model.
struct ConversionOptions {
  std::vector<std::string> inputs;
  std::string output;
  RobotOptions robot;
  bool plain_tables = false;  // takes those too (src/tool/plain_table.h), and gives such back
  unsigned jobs = 1;
  bool force = false;
  bool json = false;
};

/// What a conversion says of one recording.
struct ConversionReport {
  std::string sentence;                                  // "with the pose of tool0 in base_link"
  std::function<void(nlohmann::ordered_json&)> figures;  // adds them to the JSON object of the recording, if given
  bool has_findings = false;
};

/// Declares IN, -o, the robot's options, --jobs, --force, --json.
void addConversionOptions(CLI::App& verb, ConversionOptions& options, const std::string& inputs);

/// What is to be done with each recording, and, if given, with all of them.
struct Conversion {
  std::string step;  // of the provenance, to which the robot's options are added
  /// Once, with all recordings read and none converted; may correct what they say. An exit code ends it all there:
  /// nothing is written.
  std::function<std::optional<int>(const RobotDescription&, std::vector<LoadedDemonstration>&)> prepare;
  /// Works on the recording, may add to its notes, and throws ConfigurationError or ModelError, which get the file's
  /// name in front.
  std::function<ConversionReport(const RobotDescription&, LoadedDemonstration&)> convert;
  std::string also_read;                    // a file beside the recordings and the URDF; empty: none
  std::string also_written;                 // a file beside the outputs; empty: none
  std::function<void(AtomicFiles&)> write;  // that file
  /// Once, when all are written. May add to the JSON object beside `recordings`, and says whether it has findings.
  std::function<bool(nlohmann::ordered_json&)> conclude;
};

/// Converts all inputs, in parallel, and writes only when all have succeeded: all outputs, or none. Returns the exit
/// code.
int convertRecordings(const ConversionOptions& options, const Conversion& conversion);

}  // namespace demo_logger
