#include "src/nodes/simulated_arm_node.h"

#include <rosgraph_msgs/Clock.h>

#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "src/nodes/arm_commands.h"

namespace demo_logger {
namespace {

constexpr std::uint32_t kQueue = 2000;       // messages out, 2 s of control ticks: for a recorder that stalls
constexpr std::size_t kInbox = 1000;         // commands in, between two ticks
constexpr double kDiagnosticsPeriod = 1.0;   // [s]
constexpr double kRefusalLogPeriod = 5.0;    // [s]
constexpr double kToleratedOverruns = 0.01;  // of the ticks

ros::Time toRos(Nanoseconds stamp) { return ros::Time().fromNSec(static_cast<std::uint64_t>(stamp)); }

Nanoseconds rosNow() { return static_cast<Nanoseconds>(ros::Time::now().toNSec()); }

Nanoseconds steadyNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void sleepUntil(Nanoseconds steady) {
  std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(steady)));
}

std::vector<double> toVector(const Eigen::VectorXd& values) { return {values.begin(), values.end()}; }

}  // namespace

SimulatedArmNode::SimulatedArmNode(ros::NodeHandle node, ros::NodeHandle private_node,
                                   const SimulatedArmParameters& parameters)
    : parameters_(parameters), arm_(parameters.robot, parameters.arm), applied_message_(new AppliedCommand) {
  joint_state_message_.name = parameters_.robot.jointNames();
  joint_states_ = node.advertise<sensor_msgs::JointState>("joint_states", kQueue);
  applied_command_ = node.advertise<AppliedCommand>("applied_command", kQueue);
  ground_truth_ = node.advertise<sensor_msgs::JointState>("ground_truth/joint_states", kQueue);
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

  services_.push_back(private_node.advertiseService("set_control_mode", &SimulatedArmNode::setControlMode, this));
  services_.push_back(private_node.advertiseService("reset_simulation", &SimulatedArmNode::reset, this));
  using Empty = std_srvs::Empty;
  for (const bool paused : {true, false}) {
    services_.push_back(private_node.advertiseService<Empty::Request, Empty::Response>(
        paused ? "pause_physics" : "unpause_physics",
        [this, paused](Empty::Request&, Empty::Response&) { return setPaused(paused); }));
  }

  diagnostics_.setHardwareID("simulated " + parameters_.robot.name);
  diagnostics_.add("control loop", this, &SimulatedArmNode::diagnoseLoop);
  diagnostics_.add("commands", this, &SimulatedArmNode::diagnoseCommands);
  diagnostics_timer_ = node.createWallTimer(ros::WallDuration(kDiagnosticsPeriod),
                                            [this](const ros::WallTimerEvent&) { diagnostics_.force_update(); });
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

void SimulatedArmNode::put(ArmCommand command, const std::string& source) {
  command.source = source;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (inbox_.commands.size() >= kInbox) {
    inbox_.commands.erase(inbox_.commands.begin());
    ++inbox_.dropped;
  }
  inbox_.commands.push_back(std::move(command));
}

bool SimulatedArmNode::setControlMode(SetControlMode::Request& request, SetControlMode::Response& response) {
  response.success = 0U;
  try {
    const ControlMode mode = toControlMode(request.mode);
    if (!request.stiffness.empty() || !request.damping.empty()) {
      response.message = "mode " + request.mode + " takes neither stiffness nor damping, expected both empty.";
      return true;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    inbox_.mode = mode;
  } catch (const ConfigurationError& error) {
    response.message = error.what();
    return true;
  }
  response.success = 1U;
  response.message = "mode " + request.mode + " is in force from the next control tick on.";
  return true;
}

bool SimulatedArmNode::reset(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  const std::lock_guard<std::mutex> lock(mutex_);
  inbox_.reset = true;
  response.success = 1U;
  response.message = "the arm is back in its initial position from the next control tick on.";
  return true;
}

bool SimulatedArmNode::setPaused(bool paused) {
  const std::lock_guard<std::mutex> lock(mutex_);
  paused_ = paused;
  report_.paused = paused;
  return true;
}

void SimulatedArmNode::run() {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  TickClock clock(parameters_.clock, steadyNow(), rosNow());
  bool was_paused = false;
  while (ros::ok()) {
    bool paused = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      paused = paused_;
    }
    if (paused) {
      was_paused = true;
      sleepUntil(steadyNow() + parameters_.clock.period);
      continue;
    }
    if (std::exchange(was_paused, false)) clock.resume(steadyNow(), rosNow());
    sleepUntil(clock.due());
    tick(clock);
  }
  spinner.stop();
}

SimulatedArmNode::Inbox SimulatedArmNode::takeInbox() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(inbox_, {});
}

void SimulatedArmNode::tick(TickClock& clock) {
  const Inbox inbox = takeInbox();
  if (inbox.mode) arm_.setMode(*inbox.mode);
  if (inbox.reset) arm_.reset();
  const std::uint64_t refused = arm_.controller().refusedCommands();
  const ArmTick tick = arm_.tick(clock.stamp(), inbox.commands);
  if (arm_.controller().refusedCommands() != refused) {
    ROS_WARN_STREAM_THROTTLE(kRefusalLogPeriod, tick.applied.reason);
  }
  publish(tick);
  clock.advance(steadyNow(), rosNow());
  report(clock, tick, inbox.dropped);
}

void SimulatedArmNode::publish(const ArmTick& tick) {
  const ros::Time stamp = toRos(tick.stamp);
  if (tick.index % static_cast<std::uint64_t>(parameters_.ticks_per_joint_state) == 0) {
    if (clock_) {
      rosgraph_msgs::Clock now;
      now.clock = stamp;
      clock_.publish(now);
    }
    joint_state_message_.header.stamp = stamp;
    joint_state_message_.position = toVector(tick.reading.q);
    joint_state_message_.velocity = toVector(tick.reading.dq);
    joint_state_message_.effort = toVector(tick.reading.effort);
    joint_states_.publish(joint_state_message_);
    joint_state_message_.position = toVector(tick.truth.q);
    joint_state_message_.velocity = toVector(tick.truth.dq);
    joint_state_message_.effort = toVector(tick.applied.torque);
    ground_truth_.publish(joint_state_message_);
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

void SimulatedArmNode::report(TickClock& clock, const ArmTick& tick, std::uint64_t dropped) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.ticks = tick.index + 1;
  report_.overruns = clock.overruns();
  report_.jumps = clock.jumps();
  report_.largest_delay = std::max(report_.largest_delay, clock.largestDelay());
  clock.forgetLargestDelay();
  report_.refused = arm_.controller().refusedCommands();
  report_.dropped += dropped;
  report_.mode = toString(tick.applied.mode);
  report_.reason = tick.applied.reason;
  report_.clock_mismatches = arm_.controller().clockMismatches();
}

void SimulatedArmNode::diagnoseLoop(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::uint64_t ticks = report_.ticks - last_report_.ticks;
  const std::uint64_t overruns = report_.overruns - last_report_.overruns;
  if (report_.paused) {
    status.summary(Status::OK, "paused");
  } else if (static_cast<double>(overruns) > kToleratedOverruns * static_cast<double>(ticks)) {
    status.summaryf(Status::WARN, "%lu of the last %lu control ticks started more than a period late", overruns, ticks);
  } else if (report_.jumps != last_report_.jumps) {
    status.summary(Status::WARN, "the loop stalled or its clock jumped; simulated time went on from now");
  } else {
    status.summary(Status::OK, "in time");
  }
  status.add("ticks", report_.ticks);
  status.add("overruns", report_.overruns);
  status.add("stalls and clock jumps", report_.jumps);
  status.add("largest delay of a tick [ms]", toSeconds(report_.largest_delay) * 1e3);
  report_.largest_delay = 0;
  last_report_ = report_;
}

void SimulatedArmNode::diagnoseCommands(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (report_.clock_mismatches.empty()) {
    status.summary(Status::OK, report_.reason.empty() ? "as asked" : report_.reason);
  } else {
    status.summary(Status::WARN, report_.clock_mismatches.front());
  }
  status.add("control mode", report_.mode);
  status.add("refused", report_.refused);
  status.add("dropped, more than a tick can take", report_.dropped);
  for (const std::string& mismatch : report_.clock_mismatches) status.add("clock", mismatch);
}

}  // namespace demo_logger
