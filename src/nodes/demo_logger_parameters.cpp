#include "src/nodes/demo_logger_parameters.h"

#include <ros/master.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "demo_logger/pipelines/recorded_robot.h"
#include "src/ros/stream_converter.h"
#include "src/ros/version.h"

namespace demo_logger {
namespace {

constexpr int kMostButtons = 255;

StreamConfiguration defaultTeleopCommand() {
  StreamConfiguration stream;
  stream.name = "teleop_cmd";
  stream.topic = "teleop_cmd";
  stream.type = StreamType::twist;
  return stream;
}

Alignment parseAlignment(Parameters& parameters) {
  const std::string align = parameters.choice("align", "hold", {"hold", "linear", "nearest"});
  return align == "linear" ? Alignment::linear : align == "nearest" ? Alignment::nearest : Alignment::hold;
}

StreamConfiguration parseStream(Parameters& parameters) {
  StreamConfiguration stream;
  stream.name = parameters.text("name", "");
  if (stream.name.empty()) {
    throw ConfigurationError(parameters.fullName("name") + " is missing, expected the name of the stream's columns.");
  }
  stream.topic = parameters.text("topic", stream.name);
  stream.alignment = parseAlignment(parameters);
  stream.latency = parameters.number("latency", 0.0, {-10.0, 10.0, "s"});
  stream.in_order = parameters.flag("in_order", false);
  if (stream.name == "teleop_cmd") {
    stream.type = StreamType::twist;
  }
  parameters.rejectUnknown();
  return stream;
}

/// teleop_cmd is always there; the list may describe it otherwise.
std::vector<StreamConfiguration> parseStreams(Parameters& parameters) {
  std::vector<StreamConfiguration> streams{defaultTeleopCommand()};
  for (Parameters& one : parameters.groups("streams")) {
    StreamConfiguration stream = parseStream(one);
    if (stream.name == "teleop_cmd") {
      streams.front() = stream;
    } else {
      streams.push_back(stream);
    }
  }
  return streams;
}

EffortMetadata parseEffort(Parameters parameters) {
  EffortMetadata effort;
  effort.side = parameters.choice("side", effort.side, {"motor", "link"});
  effort.timing = parameters.choice("timing", effort.timing, {"instant", "held"});
  effort.includes_gravity = parameters.flag("includes_gravity", effort.includes_gravity);
  effort.control_period = parameters.number("control_period", effort.control_period, {0.0, 1.0, "s"});
  parameters.rejectUnknown();
  return effort;
}

/// One press is one request.
void requireDistinct(const Parameters& parameters, const Buttons& buttons) {
  std::map<int, std::string> taken;
  const std::pair<const char*, int> requests[] = {{"start", buttons.start},
                                                  {"stop", buttons.stop},
                                                  {"success", buttons.success},
                                                  {"failure", buttons.failure},
                                                  {"discard", buttons.discard}};
  for (const auto& [request, button] : requests) {
    if (button < 0) continue;
    const auto [place, is_new] = taken.emplace(button, request);
    if (is_new) continue;
    throw ConfigurationError(parameters.fullName(request) + " is " + std::to_string(button) + ", which is " +
                             place->second + " already; expected a button of its own for each request.");
  }
}

Buttons parseButtons(Parameters parameters) {
  const Range range{-1, kMostButtons, ""};
  Buttons buttons;
  buttons.start = parameters.integer("start", buttons.start, range);
  buttons.stop = parameters.integer("stop", buttons.stop, range);
  buttons.success = parameters.integer("success", buttons.success, range);
  buttons.failure = parameters.integer("failure", buttons.failure, range);
  buttons.discard = parameters.integer("discard", buttons.discard, range);
  parameters.rejectUnknown();
  requireDistinct(parameters, buttons);
  return buttons;
}

std::optional<RobotDescription> parseRobot(Parameters& parameters, const std::string& robot_description) {
  DescriptionOptions options;
  options.base = parameters.text("base", "");
  options.tip = parameters.text("tip", "");
  if (options.base.empty() && options.tip.empty()) {
    return std::nullopt;
  }
  if (robot_description.empty()) {
    throw ConfigurationError(parameters.fullName(options.tip.empty() ? "base" : "tip") +
                             " is given but robot_description is not set, here or in a namespace above; expected the "
                             "URDF of the arm there, or neither.");
  }
  return describeRobot(robot_description, options);
}

/// What the sidecar keeps of the configuration, so that a recording can be explained later.
std::map<std::string, ParameterValue> describeParameters(const RecorderConfiguration& configuration) {
  const SynchroniserConfiguration& synchroniser = configuration.synchroniser;
  return {{"max_wait", synchroniser.max_wait},
          {"max_gap", synchroniser.max_gap},
          {"wait_for_streams", synchroniser.wait_for_streams},
          {"merge_joint_states", synchroniser.merge_joint_states},
          {"correct_clock_offset", synchroniser.correct_clock_offset},
          {"autostart", configuration.autostart},
          {"joints", synchroniser.joints}};
}

void takeTypesFromMaster(const ros::NodeHandle& node, std::vector<StreamConfiguration>& streams) {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  for (StreamConfiguration& stream : streams) {
    const std::string name = node.resolveName(stream.topic);
    const auto topic = std::find_if(topics.begin(), topics.end(),
                                    [&](const ros::master::TopicInfo& info) { return info.name == name; });
    if (stream.type || topic == topics.end() || topic->datatype == "*") {
      continue;
    }
    const StreamConverter* converter = findStreamConverter(topic->datatype);
    if (converter == nullptr) {
      throw ConfigurationError("stream " + stream.name + ": " + name + " is of type " + topic->datatype +
                               ", which cannot be recorded; supported are " + supportedStreamTypes());
    }
    stream.type = converter->type;
  }
}

}  // namespace

DemoLoggerParameters parseDemoLoggerParameters(Parameters& parameters, const std::string& robot_description) {
  DemoLoggerParameters result;
  RecorderConfiguration& recorder = result.recorder;
  recorder.output_directory = parameters.text("output_dir", "demos");
  if (recorder.output_directory.empty()) {
    throw ConfigurationError(parameters.fullName("output_dir") + " is empty, expected a directory.");
  }
  recorder.output_directory = std::filesystem::absolute(recorder.output_directory);
  recorder.autostart = parameters.flag("autostart", recorder.autostart);

  Metadata& metadata = recorder.metadata;
  metadata.channel = parameters.choice("channel", metadata.channel, {"teleoperation", "kinesthetic", "vr", "unknown"});
  metadata.task = parameters.text("task", "");
  metadata.operator_name = parameters.text("operator", "");
  metadata.effort = parseEffort(parameters.group("effort"));
  metadata.software = kSoftware;

  SynchroniserConfiguration& synchroniser = recorder.synchroniser;
  synchroniser.max_wait = parameters.number("max_wait", synchroniser.max_wait, {0.0, 10.0, "s"});
  synchroniser.max_gap = parameters.number("max_gap", synchroniser.max_gap, {0.0, 60.0, "s"});
  synchroniser.wait_for_streams =
      parameters.number("wait_for_streams", synchroniser.wait_for_streams, {0.0, 60.0, "s"});
  synchroniser.merge_joint_states = parameters.flag("merge_joint_states", synchroniser.merge_joint_states);
  synchroniser.correct_clock_offset = parameters.flag("correct_clock_offset", synchroniser.correct_clock_offset);
  synchroniser.streams = parseStreams(parameters);

  parameters.raw("robot_description");  // read by the usual search, which begins here
  result.robot = parseRobot(parameters, robot_description);
  synchroniser.joints = parameters.texts("joints", {});
  if (result.robot) {
    recordRobot(*result.robot, recorder);
  }
  result.buttons = parseButtons(parameters.group("buttons"));
  parameters.rejectUnknown();
  try {
    validate(synchroniser);
  } catch (const ConfigurationError& error) {  // its sentence begins with the field, which is the parameter's name
    throw ConfigurationError(parameters.fullName(error.what()));
  }
  metadata.parameters = describeParameters(recorder);
  return result;
}

DemoLoggerParameters readDemoLoggerParameters(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  Parameters parameters = readParameters(private_node);
  std::string name;
  const bool has_robot = private_node.searchParam("robot_description", name);
  DemoLoggerParameters result =
      parseDemoLoggerParameters(parameters, has_robot ? readRobotDescription(private_node) : std::string());
  takeTypesFromMaster(node, result.recorder.synchroniser.streams);
  return result;
}

}  // namespace demo_logger
