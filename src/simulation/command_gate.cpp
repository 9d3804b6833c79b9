#include "demo_logger/simulation/command_gate.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "print.h"

namespace demo_logger {
namespace {

constexpr double kLargestValue = 1e6;     // no arm moves or pushes like that; keeps the arithmetic finite
constexpr std::size_t kMostSources = 16;  // publishers whose clocks are remembered
const char* const kTwistComponents = "vx vy vz wx wy wz";

const std::vector<std::pair<ControlMode, std::string>>& modeNames() {
  static const std::vector<std::pair<ControlMode, std::string>> names{
      {ControlMode::effort, "effort"},
      {ControlMode::velocity, "velocity"},
      {ControlMode::cartesian_velocity, "cartesian_velocity"}};
  return names;
}

std::string printDuration(Nanoseconds duration) { return print(toSeconds(duration)) + " s"; }

}  // namespace

std::string toString(ControlMode mode) {
  for (const auto& [value, name] : modeNames()) {
    if (value == mode) return name;
  }
  return "unknown";
}

ControlMode toControlMode(const std::string& name) {
  std::string known;
  for (const auto& [value, known_name] : modeNames()) {
    if (known_name == name) return value;
    known += (known.empty() ? "" : ", ") + known_name;
  }
  throw ConfigurationError("control mode \"" + name + "\" is not one of this arm, expected one of " + known + ".");
}

CommandGate::CommandGate(Configuration configuration) : configuration_(std::move(configuration)) {}

std::string CommandGate::admit(const ArmCommand& command, ControlMode mode, Nanoseconds now) {
  if (command.mode != mode) {
    return "a command for mode " + toString(command.mode) + " came while mode " + toString(mode) + " is in force";
  }
  ArmCommand sorted = command;
  std::string refusal = checkValues(command, sorted);
  if (refusal.empty()) refusal = checkStamp(command, now);
  if (!refusal.empty()) return refusal;
  command_ = std::move(sorted);
  receipt_ = now;
  return "";
}

std::string CommandGate::checkValues(const ArmCommand& command, ArmCommand& sorted) const {
  const bool is_twist = command.mode == ControlMode::cartesian_velocity;
  const std::size_t expected = is_twist ? 6 : configuration_.joints.size();
  const auto size = static_cast<std::size_t>(command.values.size());
  const std::size_t names = command.names.size();
  if (size != expected || (names != 0 && names != size)) {
    return "a " + toString(command.mode) + " command has " + std::to_string(size) + " values" +
           (names != 0 ? " for " + std::to_string(names) + " names" : "") + ", expected " +
           (is_twist ? kTwistComponents : std::to_string(expected) + ", one for each joint");
  }
  if (is_twist && !command.frame.empty() && command.frame != configuration_.base &&
      command.frame != configuration_.tip) {
    return "a twist is given in the frame \"" + command.frame + "\", expected \"" + configuration_.base + "\" or \"" +
           configuration_.tip + "\"";
  }
  for (Eigen::Index i = 0; i < command.values.size(); ++i) {
    const double value = command.values[i];
    if (!std::isfinite(value)) return "component " + std::to_string(i) + " of the command is not a number";
    if (std::abs(value) > kLargestValue) {
      return "component " + std::to_string(i) + " of the command is " + print(value) + ", beyond what any arm does";
    }
  }
  if (is_twist) return "";
  for (std::size_t i = 0; i < names; ++i) {
    const auto joint = std::find(configuration_.joints.begin(), configuration_.joints.end(), command.names[i]);
    if (joint == configuration_.joints.end())
      return "the command names \"" + command.names[i] + "\", no joint of this arm";
    if (std::count(command.names.begin(), command.names.end(), command.names[i]) > 1) {
      return "the command names \"" + command.names[i] + "\" twice";
    }
    sorted.values[joint - configuration_.joints.begin()] = command.values[static_cast<Eigen::Index>(i)];
  }
  sorted.names.clear();
  return "";
}

std::string CommandGate::checkStamp(const ArmCommand& command, Nanoseconds now) {
  if (command.stamp == 0) return "";
  if (clocks_.count(command.source) == 0 && clocks_.size() >= kMostSources) {
    return "more than " + std::to_string(kMostSources) + " publishers have commanded this arm; " + command.source +
           " is one too many";
  }
  PublisherClock& clock = clocks_[command.source];
  clock.observe(command.stamp, now);
  const Nanoseconds age = now - command.stamp - clock.offset().value_or(0);
  const Nanoseconds timeout = fromSeconds(configuration_.timeout);
  const std::string hint = clock.offset() ? "" : "; stale, or the clocks differ: judged after a second of commands";
  if (age > timeout) return "the stamp of a command is " + printDuration(age) + " old" + hint;
  if (-age > timeout) return "the stamp of a command is " + printDuration(-age) + " in the future" + hint;
  if (command_ && command_->source == command.source && command.stamp < command_->stamp) {
    return "a command is " + printDuration(command_->stamp - command.stamp) + " older than the one in force";
  }
  return "";
}

const ArmCommand* CommandGate::inForce(Nanoseconds now) {
  if (!command_) return nullptr;
  const Nanoseconds timeout = fromSeconds(configuration_.timeout);
  if (now - receipt_ > timeout) {
    clear("no command for " + print(configuration_.timeout) + " s");
    return nullptr;
  }
  if (command_->stamp != 0) {
    const Nanoseconds offset = clocks_[command_->source].offset().value_or(0);
    if (now - command_->stamp - offset > timeout) {
      clear("the last command is older than " + print(configuration_.timeout) + " s by its stamp");
      return nullptr;
    }
  }
  return &*command_;
}

void CommandGate::clear(const std::string& why) {
  command_.reset();
  why_none_ = why;
}

void CommandGate::reset() {
  clocks_.clear();
  clear("no command yet");
}

std::vector<std::string> CommandGate::clockMismatches() const {
  std::vector<std::string> mismatches;
  for (const auto& [source, clock] : clocks_) {
    const Nanoseconds offset = clock.offset().value_or(0);
    if (offset == 0) continue;
    mismatches.push_back(source + ": stamps are " + printDuration(std::abs(offset)) +
                         (offset > 0 ? " behind" : " ahead of") +
                         " this clock (transport or skew); ages are corrected");
  }
  return mismatches;
}

}  // namespace demo_logger
