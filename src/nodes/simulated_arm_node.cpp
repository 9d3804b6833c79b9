#include "src/nodes/simulated_arm_node.h"

#include <rosgraph_msgs/Clock.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>
#include <thread>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/regular_file.h"
#include "src/nodes/arm_commands.h"

namespace demo_logger {
namespace {

constexpr std::uint32_t kQueue = 2000;     // messages out, 2 s of control ticks: for a recorder that stalls
constexpr std::size_t kInbox = 1000;       // commands in, between two ticks
constexpr double kRefusalLogPeriod = 5.0;  // [s]

ros::Time toRos(Nanoseconds stamp) { return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp)); }

Nanoseconds rosNow() { return static_cast<Nanoseconds>(ros::Time::now().toNSec()); }

Nanoseconds steadyNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void sleepUntil(Nanoseconds steady) {
  std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(steady)));
}

std::string readFile(const std::string& path) {
  requireRegularFile(path, "what ~save_state wrote, as initial_state names it.");
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) throw FileError(path + " cannot be read; initial_state names a file that ~save_state wrote.");
  return text.str();
}

std::vector<double> toVector(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

}  // namespace

SimulatedArmNode::SimulatedArmNode(ros::NodeHandle node, ros::NodeHandle private_node,
                                   const SimulatedArmParameters& parameters)
    : parameters_(parameters),
      arm_(parameters.robot, parameters.arm),
      faults_(parameters.faults, parameters.robot.jointNames()),
      applied_message_(new AppliedCommand) {
  for (const AttachedLink& link : parameters_.links) links_[link.name] = link;
  if (parameters_.load) arm_.setLoad(parameters_.load);
  restoreState(std::nullopt);
  overlaps_ = arm_.overlaps();
  for (const std::string& overlap : overlaps_) ROS_WARN_STREAM("At the start " << overlap);
  truth_message_.name = parameters_.robot.jointNames();
  joint_states_ = node.advertise<sensor_msgs::JointState>("joint_states", kQueue);
  applied_command_ = node.advertise<AppliedCommand>("applied_command", kQueue);
  ground_truth_ = node.advertise<sensor_msgs::JointState>("ground_truth/joint_states", kQueue);
  external_torque_ = node.advertise<sensor_msgs::JointState>("ground_truth/human_torque", kQueue);
  if (parameters_.clock.own_time) clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", kQueue);

  subscribers_.push_back(node.subscribe<topic_tools::ShapeShifter>(
      "teleop_cmd", kQueue,
      boost::function<void(const TwistEvent&)>([this](const TwistEvent& e) { receiveTwist(e); })));
  for (const ControlMode mode : {ControlMode::effort, ControlMode::velocity, ControlMode::position}) {
    subscribe<std_msgs::Float64MultiArray>(
        node, "joint_group_" + toString(mode) + "_controller/command",
        [mode](const std_msgs::Float64MultiArray& message) { return toArmCommand(mode, message); });
  }
  subscribe<sensor_msgs::JointState>(node, "joint_target",
                                     [](const sensor_msgs::JointState& message) { return toArmCommand(message); });
  subscribe<trajectory_msgs::JointTrajectory>(
      node, "joint_trajectory", [](const trajectory_msgs::JointTrajectory& message) { return toArmCommand(message); });

  subscribers_.push_back(node.subscribe<geometry_msgs::WrenchStamped>(
      "human_wrench", kQueue,
      boost::function<void(const WrenchEvent&)>([this](const WrenchEvent& e) { receiveWrench(e); }),
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));

  advertiseServices(private_node);
  startDiagnostics(node);
}

template <typename Message>
void SimulatedArmNode::subscribe(ros::NodeHandle& node, const std::string& topic,
                                 std::function<ArmCommand(const Message&)> convert) {
  using Event = ros::MessageEvent<Message const>;
  subscribers_.push_back(node.subscribe<Message>(
      topic, kQueue, boost::function<void(const Event&)>([this, convert = std::move(convert)](const Event& event) {
        put(convert(*event.getMessage()), event.getPublisherName());
      })));
}

void SimulatedArmNode::receiveTwist(const TwistEvent& event) {
  const topic_tools::ShapeShifter& message = *event.getMessage();
  if (message.getDataType() == "geometry_msgs/TwistStamped") {
    put(toArmCommand(*message.instantiate<geometry_msgs::TwistStamped>()), event.getPublisherName());
  } else if (message.getDataType() == "geometry_msgs/Twist") {
    put(toArmCommand(*message.instantiate<geometry_msgs::Twist>()), event.getPublisherName());
  } else {
    ROS_ERROR_STREAM_THROTTLE(kRefusalLogPeriod, event.getPublisherName()
                                                     << " sends " << message.getDataType()
                                                     << " as teleop_cmd, expected geometry_msgs/Twist or "
                                                        "geometry_msgs/TwistStamped.");
  }
}

/// A wrench at the origin of its frame, in its axes; without a frame, of the tip.
void SimulatedArmNode::receiveWrench(const WrenchEvent& event) {
  const geometry_msgs::WrenchStamped& message = *event.getMessage();
  const std::string& frame = message.header.frame_id;
  SentWrench sent;
  sent.source = event.getPublisherName();
  sent.duration = fromSeconds(parameters_.wrench_timeout);
  const auto [wrench, why] = wrenchUpon(frame.empty() ? parameters_.robot.tip : frame, message.wrench, true);
  sent.wrench = wrench;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (inbox_.wrenches.size() + inbox_.refusals.size() >= kInbox) {
    ++inbox_.dropped;
  } else if (!why.empty()) {
    inbox_.refusals.emplace_back(sent.source, why);
  } else {
    inbox_.wrenches.push_back(std::move(sent));
  }
}

void SimulatedArmNode::put(ArmCommand command, const std::string& source) {
  command.source = source;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (inbox_.commands.size() >= kInbox) {
    inbox_.commands.erase(inbox_.commands.begin());
    ++inbox_.dropped;
  }
  inbox_.commands.push_back(std::move(command));
}

/// A clock of its own goes on from the saved state too; the ROS clock shows another time, to which the state is moved
/// once the first tick's stamp is known.
void SimulatedArmNode::restoreState(std::optional<Nanoseconds> next) {
  if (parameters_.initial_state.empty()) return;
  try {
    arm_.restoreState(readFile(parameters_.initial_state), next);
  } catch (const ConfigurationError& error) {
    throw ConfigurationError(parameters_.initial_state + ": " + error.what());
  }
  if (parameters_.clock.own_time) parameters_.clock.first_stamp = arm_.nextTick();
}

void SimulatedArmNode::run() {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  TickClock clock(parameters_.clock, steadyNow(), rosNow());
  if (!parameters_.clock.own_time) restoreState(clock.stamp());
  bool was_paused = false;
  while (ros::ok()) {
    bool paused = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      paused = paused_;
    }
    if (paused) {
      was_paused = true;
      answerStateRequests();
      sleepUntil(steadyNow() + parameters_.clock.period);
      continue;
    }
    if (std::exchange(was_paused, false)) clock.resume(steadyNow(), rosNow());
    sleepUntil(clock.due());
    tick(clock);
  }
  spinner.stop();
  // ROS says nothing any more.
  std::cout << "simulated arm: " << report_.ticks << " control ticks, " << clock.overruns()
            << " of them started more than a period late; " << clock.jumps() << " stalls or clock jumps" << std::endl;
}

SimulatedArmNode::Inbox SimulatedArmNode::takeInbox() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(inbox_, {});
}

void SimulatedArmNode::tick(TickClock& clock) {
  answerStateRequests();
  const Inbox inbox = takeInbox();
  if (inbox.mode) arm_.setMode(inbox.mode->first, inbox.mode->second);
  if (inbox.load) arm_.setLoad(*inbox.load);
  if (inbox.reset) arm_.reset();
  const std::uint64_t refused = arm_.refused();
  for (const auto& [source, why] : inbox.refusals) arm_.refuse(source, why);
  for (const SentWrench& sent : inbox.wrenches) {
    const std::string why = arm_.applyWrench(sent.wrench, clock.stamp() + sent.duration, sent.source);
    if (!why.empty()) arm_.refuse(sent.source, why);
  }
  const ArmTick tick = arm_.tick(clock.stamp(), inbox.commands);
  if (arm_.refused() != refused) {
    ROS_WARN_STREAM_THROTTLE(kRefusalLogPeriod, tick.applied.reason);
    const std::lock_guard<std::mutex> lock(mutex_);
    report_.last_refusal = tick.applied.reason;
  }
  publish(tick);
  clock.advance(steadyNow(), rosNow());
  report(clock, tick, inbox.dropped);
}

void SimulatedArmNode::answerStateRequests() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!state_wanted_) return;
  state_wanted_ = false;
  state_ = arm_.saveState();
  state_saved_.notify_all();
}

void SimulatedArmNode::publish(const ArmTick& tick) {
  const ros::Time stamp = toRos(tick.stamp);
  if (tick.index % static_cast<std::uint64_t>(parameters_.ticks_per_joint_state) == 0) {
    if (clock_) {
      rosgraph_msgs::Clock now;
      now.clock = stamp;
      clock_.publish(now);
    }
    faults_.offer(tick.stamp, tick.reading);
    truth_message_.header.stamp = stamp;
    truth_message_.position = toVector(tick.truth.q);
    truth_message_.velocity = toVector(tick.truth.dq);
    truth_message_.effort = toVector(tick.applied.torque);
    ground_truth_.publish(truth_message_);
    sensor_msgs::JointState external;
    external.header.stamp = stamp;
    external.name = truth_message_.name;
    external.effort = toVector(tick.external_torque);
    external_torque_.publish(external);
  }
  for (const JointStateMessage& due : faults_.take(tick.stamp)) {
    sensor_msgs::JointState message;
    message.header.stamp = toRos(due.stamp);
    message.name = due.names;
    message.position = toVector(due.reading.q);
    message.velocity = toVector(due.reading.dq);
    message.effort = toVector(due.reading.effort);
    joint_states_.publish(message);
  }
  applied_message_->header.stamp = stamp;
  applied_message_->header.frame_id = parameters_.robot.base;
  applied_message_->tick = tick.index;
  applied_message_->mode = toString(tick.applied.mode);
  applied_message_->name = tick.applied.names;
  applied_message_->command = toVector(tick.applied.command);
  applied_message_->torque = toVector(tick.applied.torque);
  applied_message_->reason = tick.applied.reason;
  applied_command_.publish(*applied_message_);
}

}  // namespace demo_logger
