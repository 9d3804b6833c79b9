#include "src/nodes/demo_logger_node.h"

#include <ros/console.h>

#include <cstdlib>
#include <utility>

#include "demo_logger/pipelines/human_torque_columns.h"
#include "demo_logger/pipelines/tool_pose.h"
#include "src/ros/message_conversion.h"
#include "src/ros/teleop_map_parameter.h"

namespace demo_logger {
namespace {

constexpr double kStatusCheckPeriod = 0.1;  // [s]
constexpr double kStatusPeriod = 1.0;       // [s] at least, while recording

std::vector<std::unique_ptr<DerivedColumns>> makeDerivedColumns(const DemoLoggerParameters& parameters) {
  std::vector<std::unique_ptr<DerivedColumns>> derived;
  if (parameters.robot) {
    derived.push_back(std::make_unique<ToolPose>(*parameters.robot));
  }
  if (parameters.human_torque) {
    derived.push_back(
        std::make_unique<HumanTorqueColumns>(parameters.human_torque->arm, parameters.human_torque->observer));
  }
  if (parameters.wrench) {
    derived.push_back(
        std::make_unique<WrenchTorqueColumns>(parameters.wrench->arm_to_sensor, parameters.wrench->stream));
  }
  return derived;
}

std::optional<HumanTorquePublisher> makeHumanTorquePublisher(const ros::NodeHandle& private_node,
                                                             const DemoLoggerParameters& parameters) {
  if (!parameters.human_torque) return std::nullopt;
  return HumanTorquePublisher(private_node, parameters.human_torque->arm, parameters.human_torque->observer);
}

std::string stateName(RecorderState state) {
  switch (state) {
    case RecorderState::recording:
      return Status::RECORDING;
    case RecorderState::saving:
      return Status::SAVING;
    case RecorderState::idle:
      break;
  }
  return Status::IDLE;
}

Status toMessage(const RecorderStatus& status) {
  Status message;
  message.header.stamp = ros::Time::now();
  message.state = stateName(status.state);
  message.id = status.id;
  message.file = status.file.string();
  message.rows = status.rows;
  message.duration = status.duration;
  message.rate = status.rate;
  message.minutes_left = status.minutes_left;
  for (const Fault& fault : status.faults) {
    StatusFault one;
    one.stamp = toRosTime(fault.stamp);
    one.what = fault.what;
    one.count = fault.count;
    message.faults.push_back(one);
  }
  return message;
}

bool sameButNumbers(const Status& left, const Status& right) {
  return left.state == right.state && left.id == right.id && left.file == right.file &&
         left.faults.size() == right.faults.size();
}

void log(const Reply& reply) {
  if (reply.success) {
    ROS_INFO_STREAM(reply.message);
  } else {
    ROS_WARN_STREAM(reply.message);
  }
}

}  // namespace

DemoLoggerNode::DemoLoggerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                               const DemoLoggerParameters& parameters)
    : node_(node),
      buttons_(parameters.buttons),
      human_torque_(makeHumanTorquePublisher(private_node, parameters)),
      recorder_(node, parameters.recorder, makeDerivedColumns(parameters),
                human_torque_ ? [this](const JointStateSample& sample) { human_torque_->onJointState(sample); }
                              : LiveRecorder::JointStateListener()),
      diagnostics_(node, private_node, recorder_, parameters.recorder.synchroniser.correct_clock_offset) {
  ros::NodeHandle names(private_node);
  status_publisher_ = names.advertise<Status>("status", 10, /*latch=*/true);
  services_ = {names.advertiseService("start", &DemoLoggerNode::onStart, this),
               names.advertiseService("stop", &DemoLoggerNode::onStop, this),
               names.advertiseService("discard", &DemoLoggerNode::onDiscard, this),
               names.advertiseService("label", &DemoLoggerNode::onLabel, this)};
  listenToButtons();
  // By the steady clock: a step of the system's, or a simulation that stands still, must not silence the node.
  timers_ = {node_.createSteadyTimer(ros::WallDuration(kStatusCheckPeriod),
                                     [this](const ros::SteadyTimerEvent&) {
                                       listenToButtons();
                                       publishStatusIfChanged();
                                     }),
             node_.createSteadyTimer(ros::WallDuration(kStatusPeriod),
                                     [this](const ros::SteadyTimerEvent&) { everySecond(); })};
  for (const Recovered& left : recorder_.recovered()) {
    ROS_WARN_STREAM("saved what a killed recorder had left: " << left.file.string() << ", " << left.rows << " rows");
  }
  for (const TopicStatus& topic : recorder_.topics()) {
    ROS_INFO_STREAM(topic.name << " from " << topic.topic);
  }
  ROS_INFO_STREAM("recording into " << parameters.recorder.output_directory.string()
                                    << (parameters.recorder.autostart
                                            ? ", from the first joint state on"
                                            : ", when " + names.resolveName("start") + " is called"));
  everySecond();
}

Reply DemoLoggerNode::close() {
  readTeleopMap();
  sayFaults(recorder_.status());
  Reply reply = recorder_.close();
  if (reply.success && !reply.id.empty()) {
    log(reply);
  }
  publishStatusIfChanged();
  return reply;
}

bool DemoLoggerNode::onStart(Start::Request& request, Start::Response& response) {
  const Reply reply = start(request);
  response.success = static_cast<std::uint8_t>(reply.success);
  response.message = reply.message;
  response.id = reply.id;
  return true;
}

bool DemoLoggerNode::onStop(Stop::Request& request, Stop::Response& response) {
  const Reply reply = stop(request.outcome, request.notes);
  response.success = static_cast<std::uint8_t>(reply.success);
  response.message = reply.message;
  response.id = reply.id;
  response.file = reply.file.string();
  response.rows = reply.rows;
  return true;
}

bool DemoLoggerNode::onDiscard(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  const Reply reply = recorder_.discard();
  log(reply);
  publishStatusIfChanged();
  response.success = static_cast<std::uint8_t>(reply.success);
  response.message = reply.message;
  return true;
}

bool DemoLoggerNode::onLabel(Label::Request& request, Label::Response& response) {
  const Reply reply = recorder_.label(request.id, request.outcome, request.task, request.operator_name, request.notes);
  log(reply);
  response.success = static_cast<std::uint8_t>(reply.success);
  response.message = reply.message;
  return true;
}

/// Once ROS time has begun: before, nothing could be started, and a button is pressed only once.
void DemoLoggerNode::listenToButtons() {
  if (!buttons_.any() || joy_subscriber_ || ros::Time::now().isZero()) return;
  joy_subscriber_ = node_.subscribe("joy", 100, &DemoLoggerNode::onJoy, this);
}

void DemoLoggerNode::onJoy(const sensor_msgs::Joy& joy) {
  const auto justPressed = [&](int button) {
    const auto i = static_cast<std::size_t>(button);
    return button >= 0 && i < joy.buttons.size() && joy.buttons[i] != 0 && (i >= pressed_.size() || pressed_[i] == 0);
  };
  const bool starts = justPressed(buttons_.start);
  const bool stops = justPressed(buttons_.stop);
  const bool succeeds = justPressed(buttons_.success);
  const bool fails = justPressed(buttons_.failure);
  const bool discards = justPressed(buttons_.discard);
  pressed_.assign(joy.buttons.begin(), joy.buttons.end());
  if (discards) {
    log(recorder_.discard());
  } else if (succeeds) {
    judge("success");
  } else if (fails) {
    judge("failure");
  } else if (stops) {
    stop("", "");
  } else if (starts) {
    start({});
  }
  publishStatusIfChanged();
}

Reply DemoLoggerNode::start(const Start::Request& request) {
  readTeleopMap();
  Reply reply = recorder_.start(request.channel, request.task, request.operator_name, request.notes);
  log(reply);
  publishStatusIfChanged();
  return reply;
}

Reply DemoLoggerNode::stop(const std::string& outcome, const std::string& notes) {
  readTeleopMap();
  RecorderStatus saving = recorder_.status();
  if (saving.state == RecorderState::recording) {
    saving.state = RecorderState::saving;
    publishStatus(saving);
  }
  Reply reply = recorder_.stop(outcome, notes);
  log(reply);
  publishStatusIfChanged();
  return reply;
}

Reply DemoLoggerNode::judge(const std::string& outcome) {
  if (recorder_.status().state != RecorderState::idle) {
    return stop(outcome, "");
  }
  Reply reply = recorder_.label("", outcome, "", "", "");
  log(reply);
  return reply;
}

void DemoLoggerNode::readTeleopMap() {
  if (!ros::ok()) {
    return;
  }
  std::string problem;
  try {
    if (const std::optional<TeleopMapMetadata> map = demo_logger::readTeleopMap(node_)) {
      recorder_.setTeleopMap(*map);
    }
  } catch (const Error& error) {
    problem = error.what();
  }
  if (!problem.empty() && problem != teleop_map_problem_) {
    ROS_WARN_STREAM("the recording will not explain its commands: " << problem);
  }
  teleop_map_problem_ = problem;
}

void DemoLoggerNode::publishStatus(const RecorderStatus& status) {
  const bool begun = status.state == RecorderState::recording &&
                     (!published_ || published_->state != Status::RECORDING || published_->id != status.id);
  if (begun) {
    if (published_ && published_->state == Status::RECORDING) {
      ROS_WARN_STREAM(published_->id << " was interrupted and saved: the joint states' clock jumped.");
    }
    ROS_INFO_STREAM("Recording " << status.id << ".");
  }
  sayFaults(status);
  published_ = toMessage(status);
  status_publisher_.publish(*published_);
}

void DemoLoggerNode::sayFaults(const RecorderStatus& status) {
  if (status.id != episode_of_faults_) {
    episode_of_faults_ = status.id;
    said_faults_.clear();
  }
  for (const Fault& fault : status.faults) {
    if (said_faults_.insert(fault.what).second) {
      if (fault.severity == Severity::error) {
        ROS_ERROR_STREAM(fault.what);
      } else {
        ROS_WARN_STREAM(fault.what);
      }
    }
  }
  const std::string problem = recorder_.problem();
  if (!problem.empty() && problem != problem_) {
    ROS_ERROR_STREAM(problem);
  }
  problem_ = problem;
}

void DemoLoggerNode::publishStatusIfChanged() {
  const RecorderStatus status = recorder_.status();
  if (!published_ || !sameButNumbers(*published_, toMessage(status))) {
    publishStatus(status);
  }
}

void DemoLoggerNode::everySecond() {
  readTeleopMap();
  publishStatus(recorder_.status());
  diagnostics_.publish();
}

}  // namespace demo_logger
