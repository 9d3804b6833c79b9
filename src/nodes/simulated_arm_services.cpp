// What one may ask of a simulated arm.

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/simulation/compliance.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "demo_logger/trajectory/quotation.h"
#include "src/nodes/simulated_arm_node.h"

namespace demo_logger {
namespace {

constexpr double kLongestPush = 3600.0;  // [s]
constexpr std::size_t kMostWaiting = 100;

Eigen::Vector3d toEigen(const geometry_msgs::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

/// Nothing for an empty hand.
std::optional<BodyInertia> toLoad(const geometry_msgs::Inertia& message) {
  if (message.m == 0.0) return std::nullopt;
  BodyInertia load;
  load.mass = message.m;
  load.center = toEigen(message.com);
  load.inertia << message.ixx, message.ixy, message.ixz, message.ixy, message.iyy, message.iyz, message.ixz,
      message.iyz, message.izz;
  return load;
}

}  // namespace

void SimulatedArmNode::advertiseServices(ros::NodeHandle& private_node) {
  services_.push_back(private_node.advertiseService("set_control_mode", &SimulatedArmNode::setControlMode, this));
  services_.push_back(private_node.advertiseService("set_load", &SimulatedArmNode::setLoad, this));
  services_.push_back(private_node.advertiseService("apply_wrench", &SimulatedArmNode::applyWrench, this));
  services_.push_back(private_node.advertiseService("save_state", &SimulatedArmNode::saveState, this));
  services_.push_back(private_node.advertiseService("reset_simulation", &SimulatedArmNode::reset, this));
  using Empty = std_srvs::Empty;
  for (const bool paused : {true, false}) {
    services_.push_back(private_node.advertiseService<Empty::Request, Empty::Response>(
        paused ? "pause_physics" : "unpause_physics",
        [this, paused](Empty::Request&, Empty::Response&) { return setPaused(paused); }));
  }
}

/// What an arm of this configuration may be given, judged here and not in the control loop, which it would hold up.
ImpedanceGains SimulatedArmNode::requestedGains(ControlMode mode, const SetControlMode::Request& request) {
  const bool asked = !request.stiffness.empty() || !request.damping.empty();
  if (asked && mode != ControlMode::impedance) {
    throw ConfigurationError("mode " + request.mode + " takes neither stiffness nor damping, expected both empty.");
  }
  ImpedanceGains defaults = arm_.controller().impedanceGains();  // never changes
  if (!asked) return defaults;
  Eigen::VectorXd q;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    q = report_.q;
  }
  ImpedanceGains gains = impedanceGains(parameters_.robot, request.stiffness, request.damping, defaults);
  requireStable(gains, parameters_.robot, parameters_.arm.controller.control_period, q);
  return gains;
}

bool SimulatedArmNode::setControlMode(SetControlMode::Request& request, SetControlMode::Response& response) {
  response.success = 0U;
  try {
    const ControlMode mode = toControlMode(request.mode);
    const ImpedanceGains gains = requestedGains(mode, request);
    const std::lock_guard<std::mutex> lock(mutex_);
    inbox_.mode = {mode, gains};
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

bool SimulatedArmNode::setLoad(SetLoad::Request& request, SetLoad::Response& response) {
  response.success = 0U;
  const std::optional<BodyInertia> load = toLoad(request.load);
  try {
    if (load) withLoad(parameters_.robot, *load);
  } catch (const ModelError& error) {
    response.message = error.what();
    return true;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  inbox_.load = load;
  response.success = 1U;
  response.message = load ? "the arm carries the load from the next control tick on."
                          : "the hand is empty from the next control tick on.";
  return true;
}

/// The wrench, or why there is none.
std::pair<LinkWrench, std::string> SimulatedArmNode::wrenchUpon(const std::string& link,
                                                                const geometry_msgs::Wrench& message,
                                                                bool in_link_axes) const {
  LinkWrench wrench;
  const auto found = links_.find(link);
  if (found == links_.end()) return {wrench, "a wrench acts upon " + inQuotes(link) + ", no link of this robot"};
  if (found->second.joint < 0) {
    return {wrench, "a wrench acts upon " + inQuotes(link) + ", which this arm does not move"};
  }
  const Eigen::Isometry3d& X_body_link = found->second.X_body_link;
  wrench.joint = found->second.joint;
  wrench.point = X_body_link.translation();
  wrench.force = toEigen(message.force);
  wrench.torque = toEigen(message.torque);
  wrench.in_link_axes = in_link_axes;
  if (in_link_axes) {
    wrench.force = X_body_link.linear() * wrench.force;
    wrench.torque = X_body_link.linear() * wrench.torque;
  }
  return {wrench, ""};
}

bool SimulatedArmNode::applyWrench(ApplyWrench::Request& request, ApplyWrench::Response& response) {
  response.success = 0U;
  const std::string& axes = request.wrench.header.frame_id;
  const double duration = request.duration.toSec();
  if (!axes.empty() && axes != request.link && axes != parameters_.robot.base) {
    response.message = "the wrench is in the axes of " + inQuotes(axes) + ", expected " + inQuotes(request.link) +
                       " or " + inQuotes(parameters_.robot.base) + ".";
    return true;
  }
  if (duration <= 0.0 || duration > kLongestPush) {
    response.message = "duration is " + print(duration) + " s, expected above 0, at most 3600 s.";
    return true;
  }
  const auto [wrench, why] = wrenchUpon(request.link, request.wrench.wrench, axes == request.link);
  if (!why.empty()) {
    response.message = why + ".";
    return true;
  }
  if (const std::string refusal = whyNotApplied(wrench); !refusal.empty()) {
    response.message = refusal + ".";
    return true;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (inbox_.wrenches.size() >= kMostWaiting) {
    response.message = "too many wrenches at once.";
    return true;
  }
  inbox_.wrenches.push_back({wrench, fromSeconds(duration), ""});
  response.success = 1U;
  response.message = "the wrench acts from the next control tick on.";
  return true;
}

/// Names are given by the arm, as a caller's could lead anywhere.
bool SimulatedArmNode::saveState(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
  constexpr int kMostFiles = 1'000'000;
  response.success = 0U;
  std::string state;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    state_wanted_ = true;
    if (!state_saved_.wait_for(lock, std::chrono::seconds(5), [&] { return !state_wanted_; })) {
      response.message = "the control loop stands still; nothing was saved.";
      return true;
    }
    state = state_;
  }
  const std::filesystem::path folder =
      parameters_.state_dir.empty() ? std::filesystem::current_path() : std::filesystem::path(parameters_.state_dir);
  try {
    std::filesystem::create_directories(folder);
    for (int number = 1; number < kMostFiles; ++number) {
      const std::string digits = std::to_string(number);
      const std::string name = "arm_state_" + std::string(6 - digits.size(), '0') + digits + ".json";
      if (std::filesystem::exists(folder / name)) continue;
      writeFileAtomically(folder / name, state);
      response.success = 1U;
      response.message = (folder / name).string();
      return true;
    }
    response.message = folder.string() + " is full of states.";
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

}  // namespace demo_logger
