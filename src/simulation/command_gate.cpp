#include "demo_logger/simulation/command_gate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/quotation.h"
#include "print.h"
#include "snapshot.h"

namespace demo_logger {
namespace {

constexpr double kLargestValue = 1e6;  // no arm moves or pushes like that; keeps the arithmetic finite
constexpr std::size_t kMostPoints = 10000;
constexpr std::size_t kMostSources = 16;  // publishers whose clocks are remembered
constexpr std::array<const char*, 6> kTwistComponents = {"vx", "vy", "vz", "wx", "wy", "wz"};

const std::vector<std::pair<ControlMode, std::string>>& modeNames() {
  static const std::vector<std::pair<ControlMode, std::string>> names{
      {ControlMode::effort, "effort"},
      {ControlMode::velocity, "velocity"},
      {ControlMode::position, "position"},
      {ControlMode::trajectory, "trajectory"},
      {ControlMode::cartesian_velocity, "cartesian_velocity"},
      {ControlMode::gravity_compensation, "gravity_compensation"},
      {ControlMode::impedance, "impedance"}};
  return names;
}

/// Empty if `value` is one that an arm may be told.
std::string checkNumber(const std::string& name, const std::string& what, double value, const std::string& unit) {
  if (std::abs(value) <= kLargestValue) return "";
  return name + " in " + what + " is " + print(value) + " " + unit + ", expected at most " + print(kLargestValue) +
         " " + unit + " either way";
}

/// A command that is no danger when it is old: it says where the arm comes to rest.
bool boundsItself(const ArmCommand& command) {
  if (command.mode == ControlMode::trajectory) return true;
  return command.mode == ControlMode::position && (command.rates.size() == 0 || command.rates.isZero(0.0));
}

std::string printDuration(Nanoseconds duration) { return print(toSeconds(duration)) + " s"; }

}  // namespace

/// Of a joint that turns and of one that slides.
struct CommandGate::Units {
  const char* turning;
  const char* sliding;

  static Units of(ControlMode mode) {
    if (mode == ControlMode::effort) return {"N m", "N"};
    return mode == ControlMode::velocity ? velocity() : position();
  }
  static Units position() { return {"rad", "m"}; }
  static Units velocity() { return {"rad/s", "m/s"}; }
  static Units acceleration() { return {"rad/s2", "m/s2"}; }
};

std::string toString(ControlMode mode) {
  for (const auto& [value, name] : modeNames()) {
    if (value == mode) return name;
  }
  return "unknown";
}

std::vector<std::string> controlModeNames() {
  std::vector<std::string> names;
  for (const auto& mode : modeNames()) names.push_back(mode.second);
  return names;
}

ControlMode toControlMode(const std::string& name) {
  std::string known;
  for (const auto& [value, known_name] : modeNames()) {
    if (known_name == name) return value;
    known += (known.empty() ? "" : ", ") + known_name;
  }
  throw ConfigurationError("control mode " + inQuotes(name) + " is not one of this arm, expected one of " + known +
                           ".");
}

CommandGate::CommandGate(Configuration configuration) : configuration_(std::move(configuration)) {}

std::string CommandGate::admit(const ArmCommand& command, ControlMode mode, Nanoseconds now) {
  if (command.mode != mode) {
    return "a command for mode " + toString(command.mode) + " came while mode " + toString(mode) + " is in force";
  }
  ArmCommand sorted = command;
  std::string refusal = checkValues(command, sorted);
  if (refusal.empty()) refusal = mode == ControlMode::trajectory ? checkStart(command, now) : checkStamp(command, now);
  if (!refusal.empty()) return refusal;
  command_ = std::move(sorted);
  receipt_ = now;
  return "";
}

std::string CommandGate::checkValues(const ArmCommand& command, ArmCommand& sorted) const {
  if (command.mode == ControlMode::cartesian_velocity) return checkTwist(command);
  const std::string what = (command.mode == ControlMode::effort ? "an " : "a ") + toString(command.mode) + " command";
  std::string refusal;
  if (command.mode != ControlMode::trajectory) refusal = checkSize(what, command.values, command.names.size());
  std::vector<Eigen::Index> order;
  if (refusal.empty() && !command.names.empty()) refusal = checkNames(command.names, order);
  if (!refusal.empty()) return refusal;
  sorted.names.clear();
  if (command.mode != ControlMode::trajectory) {
    refusal = sort(what, Units::of(command.mode), order, sorted.values);
    if (!refusal.empty() || command.rates.size() == 0) return refusal;
    return sort("the velocity of " + what, Units::velocity(), order, sorted.rates);
  }
  if (command.path.size() > kMostPoints) {
    return "a path has " + std::to_string(command.path.size()) + " points, expected at most " +
           std::to_string(kMostPoints);
  }
  for (std::size_t i = 0; i < sorted.path.size(); ++i) {
    PathPoint& point = sorted.path[i];
    const std::string where = "point " + std::to_string(i + 1) + " of a path";
    refusal = sort(where, Units::position(), order, point.q);
    if (refusal.empty() && point.dq.size() > 0) {
      refusal = sort("the velocity at " + where, Units::velocity(), order, point.dq);
    }
    if (refusal.empty() && point.ddq.size() > 0) {
      refusal = sort("the acceleration at " + where, Units::acceleration(), order, point.ddq);
    }
    if (!refusal.empty()) return refusal;
  }
  return "";
}

std::string CommandGate::checkTwist(const ArmCommand& command) const {
  if (command.values.size() != 6 || (!command.names.empty() && command.names.size() != 6)) {
    return "a cartesian_velocity command has " + std::to_string(command.values.size()) +
           " values, expected vx vy vz wx wy wz";
  }
  if (!command.frame.empty() && command.frame != configuration_.base && command.frame != configuration_.tip) {
    return "a twist is given in the frame " + inQuotes(command.frame) + ", expected \"" + configuration_.base +
           "\" or \"" + configuration_.tip + "\"";
  }
  for (std::size_t i = 0; i < kTwistComponents.size(); ++i) {
    std::string refusal = checkNumber(kTwistComponents.at(i), "a cartesian_velocity command",
                                      command.values[static_cast<Eigen::Index>(i)], i < 3 ? "m/s" : "rad/s");
    if (!refusal.empty()) return refusal;
  }
  return "";
}

/// Fills `order`: where each named value belongs in the arm.
std::string CommandGate::checkNames(const std::vector<std::string>& names, std::vector<Eigen::Index>& order) const {
  const std::vector<std::string>& joints = configuration_.joints;
  for (const std::string& name : names) {
    const auto joint = std::find(joints.begin(), joints.end(), name);
    if (joint == joints.end()) return "the command names " + inQuotes(name) + ", no joint of this arm";
    const Eigen::Index place = joint - joints.begin();
    if (std::find(order.begin(), order.end(), place) != order.end()) {
      return "the command names " + inQuotes(name) + " twice";
    }
    order.push_back(place);
  }
  if (names.size() == joints.size()) return "";
  return "the command names " + std::to_string(names.size()) + " joints, expected all " + std::to_string(joints.size());
}

std::string CommandGate::checkSize(const std::string& what, const Eigen::VectorXd& values, std::size_t names) const {
  const std::size_t expected = configuration_.joints.size();
  const auto size = static_cast<std::size_t>(values.size());
  if (size == expected && (names == 0 || names == size)) return "";
  return what + " has " + std::to_string(size) + " values" +
         (names == 0 ? "" : " for " + std::to_string(names) + " names") + ", expected " + std::to_string(expected) +
         ", one for each joint";
}

/// Brings `values` into the arm's order, if they are sound.
std::string CommandGate::sort(const std::string& what, const Units& units, const std::vector<Eigen::Index>& order,
                              Eigen::VectorXd& values) const {
  std::string refusal = checkSize(what, values, order.size());
  for (Eigen::Index i = 0; refusal.empty() && i < values.size(); ++i) {
    const auto joint = static_cast<std::size_t>(order.empty() ? i : order[static_cast<std::size_t>(i)]);
    const bool slides = joint < configuration_.slides.size() && configuration_.slides[joint];
    refusal = checkNumber(configuration_.joints[joint], what, values[i], slides ? units.sliding : units.turning);
  }
  if (!refusal.empty() || order.empty()) return refusal;
  const Eigen::VectorXd given = values;
  for (std::size_t i = 0; i < order.size(); ++i) values[order[i]] = given[static_cast<Eigen::Index>(i)];
  return "";
}

/// A start that lies in the past is no fault as long as the path has not ended; its follower judges that.
std::string CommandGate::checkStart(const ArmCommand& command, Nanoseconds now) {
  constexpr double kLongestWait = 60.0;  // [s]
  if (command.stamp == 0) return "";
  const double wait = toSeconds(command.stamp - now);
  if (wait <= kLongestWait) return "";
  return "a path would start in " + print(wait) + " s, expected within " + print(kLongestWait) +
         " s; do the clocks differ?";
}

std::string CommandGate::checkStamp(const ArmCommand& command, Nanoseconds now) {
  if (command.stamp == 0) return "";
  if (clocks_.count(command.source) == 0 && clocks_.size() >= kMostSources) {
    return "more than " + std::to_string(kMostSources) + " publishers have commanded this arm; " +
           shortened(command.source) + " is one too many";
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
  if (boundsItself(*command_)) return &*command_;
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

void CommandGate::exchange(Snapshot& snapshot) {
  std::vector<std::string> sources;
  for (const auto& clock : clocks_) sources.push_back(clock.first);
  snapshot.value("sources", sources);
  if (sources.size() > kMostSources) Snapshot::refuse("sources", "are more than an arm remembers");
  snapshot.part("clocks", [&](Snapshot& inside) {
    if (inside.reading()) clocks_.clear();
    for (const std::string& source : sources) {
      inside.part(source, [&](Snapshot& clock) { clocks_[source].exchange(clock); });
    }
  });
  snapshot.optional("command", command_,
                    [](Snapshot& inside, ArmCommand& command) { inside.command("in_force", command); });
  snapshot.stamp("receipt", receipt_);
  snapshot.value("why_none", why_none_);
}

std::vector<std::string> CommandGate::clockMismatches() const {
  std::vector<std::string> mismatches;
  for (const auto& [source, clock] : clocks_) {
    const Nanoseconds offset = clock.offset().value_or(0);
    if (offset == 0) continue;
    mismatches.push_back(shortened(source) + ": stamps are " + printDuration(std::abs(offset)) +
                         (offset > 0 ? " behind" : " ahead of") +
                         " this clock (transport or skew); ages are corrected");
  }
  return mismatches;
}

}  // namespace demo_logger
