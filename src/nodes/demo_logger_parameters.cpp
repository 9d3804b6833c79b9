#include "src/nodes/demo_logger_parameters.h"

#include <ros/master.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string_view>
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

/// Only of those whose columns are known without a message.
std::optional<StreamType> parseStreamType(Parameters& parameters) {
  if (!parameters.has("type")) return std::nullopt;
  const std::string type = parameters.choice("type", "number", {"twist", "pose", "wrench", "number"});
  return type == "twist"    ? StreamType::twist
         : type == "pose"   ? StreamType::pose
         : type == "wrench" ? StreamType::wrench
                            : StreamType::number;
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
  stream.type = parseStreamType(parameters);
  if (stream.name == "teleop_cmd") {
    if (stream.type.value_or(StreamType::twist) != StreamType::twist) {
      throw ConfigurationError(parameters.fullName("type") + " is \"" + parameters.text("type", "") +
                               "\", expected twist, as teleop_cmd always is, or none.");
    }
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

/// What `human_torque` says, before the robot is known: `true`, or a group that says more.
struct HumanTorqueRequest {
  std::optional<HumanTorqueObserverConfiguration> observer;
  std::string model;        // file
  std::string wrench;       // name of a stream
  std::string wrench_link;  // empty: the tip

  bool any() const { return observer || !wrench.empty(); }
};

HumanTorqueRequest parseHumanTorque(Parameters& parameters, const EffortMetadata& effort) {
  HumanTorqueRequest request;
  const std::optional<XmlRpc::XmlRpcValue> given = parameters.raw("human_torque");
  if (!given) return request;
  HumanTorqueObserverConfiguration observer;
  observer.effort = effort;
  bool observes = true;
  if (given->getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    Parameters group = parameters.group("human_torque");
    observes = group.flag("observe", true);
    observer.gain = group.number("gain", observer.gain, {0.1, 10000.0, "1/s"});
    observer.cutoff = group.number("cutoff", observer.cutoff, {0.1, 10000.0, "Hz"});
    observer.gravity_compensated = group.flag("gravity_compensated", observer.gravity_compensated);
    request.model = group.text("model", "");
    if (!request.model.empty()) request.model = std::filesystem::absolute(request.model);
    request.wrench = group.text("wrench", "");
    request.wrench_link = group.text("wrench_link", "");
    if (request.wrench.empty() && !request.wrench_link.empty()) {
      throw ConfigurationError(group.fullName("wrench_link") + " is \"" + request.wrench_link + "\" but " +
                               group.fullName("wrench") + " is not given, expected the name of the stream there.");
    }
    group.rejectUnknown();
  } else if (given->getType() == XmlRpc::XmlRpcValue::TypeBoolean) {
    observes = parameters.flag("human_torque", false);
  } else {
    throw ConfigurationError(parameters.fullName("human_torque") + " is " + describeGiven(*given) +
                             ", expected true, false or a group of parameters.");
  }
  if (observes) request.observer = observer;
  return request;
}

std::optional<RobotDescription> parseRobot(Parameters& parameters, const std::string& robot_description,
                                           const HumanTorqueRequest& human_torque) {
  DescriptionOptions options;
  options.base = parameters.text("base", "");
  options.tip = parameters.text("tip", "");
  if (options.base.empty() && options.tip.empty() && !human_torque.any()) {
    return std::nullopt;
  }
  if (robot_description.empty()) {
    const char* asks = human_torque.any() ? "human_torque" : options.tip.empty() ? "base" : "tip";
    throw ConfigurationError(parameters.fullName(asks) +
                             " is given but robot_description is not set, here or in a namespace above; expected the "
                             "URDF of the arm there, or neither.");
  }
  return describeRobot(robot_description, options);
}

/// Of a file that is not used it is said all the same if it could not be.
std::optional<ObservedHuman> findHumanTorque(const Parameters& parameters, const HumanTorqueRequest& request,
                                             const std::optional<RobotDescription>& robot) {
  try {
    if (request.observer) {
      const CalibratedArm arm = calibrate(robot.value(), std::filesystem::path(request.model));
      return ObservedHuman{*request.observer, arm, request.model};
    }
    if (!request.model.empty()) readModelCalibration(request.model);
  } catch (const FileError& error) {
    throw ConfigurationError(parameters.fullName("human_torque/model") + ": " + error.what());
  }
  return std::nullopt;
}

/// `wrench` has its columns from the beginning, published or not.
RecordedWrench findWrench(const Parameters& parameters, const HumanTorqueRequest& request,
                          const std::string& robot_description, const RobotDescription& robot,
                          std::vector<StreamConfiguration>& streams) {
  const auto stream = std::find_if(streams.begin(), streams.end(),
                                   [&](const StreamConfiguration& one) { return one.name == request.wrench; });
  if (stream == streams.end()) {
    throw ConfigurationError(parameters.fullName("human_torque/wrench") + " is \"" + request.wrench +
                             "\", which is no stream; expected the name of one of " + parameters.fullName("streams") +
                             ", of geometry_msgs/WrenchStamped.");
  }
  if (stream->type.value_or(StreamType::wrench) != StreamType::wrench) {
    throw ConfigurationError(parameters.fullName("human_torque/wrench") + " is \"" + request.wrench +
                             "\", a stream of another type; expected one of type wrench.");
  }
  stream->type = StreamType::wrench;
  DescriptionOptions to_sensor;
  to_sensor.base = robot.base;
  to_sensor.tip = request.wrench_link.empty() ? robot.tip : request.wrench_link;
  try {
    return {request.wrench, describeRobot(robot_description, to_sensor)};
  } catch (const ModelError& error) {
    throw ConfigurationError(parameters.fullName("human_torque/wrench_link") + ": " + error.what());
  }
}

/// Of efforts that torques are made of.
void requireMeaning(const Parameters& parameters, const DemoLoggerParameters& result) {
  if (!result.human_torque) return;
  try {
    validate(result.human_torque->observer.effort);
  } catch (const ConfigurationError& error) {
    constexpr std::string_view kGroup = "effort: ";
    std::string sentence = error.what();
    if (sentence.rfind(kGroup, 0) == 0) sentence.replace(0, kGroup.size(), "effort/");
    throw ConfigurationError(parameters.fullName(sentence));
  }
}

/// What the sidecar keeps of the configuration, so that a recording can be explained later.
std::map<std::string, ParameterValue> describeParameters(const DemoLoggerParameters& parameters) {
  const RecorderConfiguration& configuration = parameters.recorder;
  const SynchroniserConfiguration& synchroniser = configuration.synchroniser;
  std::map<std::string, ParameterValue> described = {{"max_wait", synchroniser.max_wait},
                                                     {"max_gap", synchroniser.max_gap},
                                                     {"wait_for_streams", synchroniser.wait_for_streams},
                                                     {"merge_joint_states", synchroniser.merge_joint_states},
                                                     {"correct_clock_offset", synchroniser.correct_clock_offset},
                                                     {"autostart", configuration.autostart},
                                                     {"joints", synchroniser.joints}};
  if (const auto& human = parameters.human_torque) {
    described["human_torque/gain"] = human->observer.gain;
    described["human_torque/cutoff"] = human->observer.cutoff;
    described["human_torque/gravity_compensated"] = human->observer.gravity_compensated;
    described["human_torque/delay"] = HumanTorqueObserver(human->arm, human->observer).delay();
    if (!human->model.empty()) described["human_torque/model"] = human->model;
  }
  if (parameters.wrench) {
    described["human_torque/wrench"] = parameters.wrench->stream;
    described["human_torque/wrench_link"] = parameters.wrench->arm_to_sensor.tip;
  }
  return described;
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
  const HumanTorqueRequest human_torque = parseHumanTorque(parameters, metadata.effort);
  result.robot = parseRobot(parameters, robot_description, human_torque);
  synchroniser.joints = parameters.texts("joints", {});
  result.human_torque = findHumanTorque(parameters, human_torque, result.robot);
  if (!human_torque.wrench.empty()) {
    result.wrench = findWrench(parameters, human_torque, robot_description, *result.robot, synchroniser.streams);
  }
  result.buttons = parseButtons(parameters.group("buttons"));
  parameters.rejectUnknown();
  try {  // their sentences begin with the field, which is the parameter's name
    validate(synchroniser);
    if (result.robot) recordRobot(*result.robot, recorder);
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(parameters.fullName(error.what()));
  }
  requireMeaning(parameters, result);
  metadata.parameters = describeParameters(result);
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
