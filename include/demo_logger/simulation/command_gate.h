#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/simulation/arm_command.h"
#include "demo_logger/simulation/publisher_clock.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

class Snapshot;

/// Lets a sound command in and keeps it in force until it is replaced or too old. It is too old when either its age
/// since receipt or its age by stamp, corrected by the offset of its publisher's clock, exceeds the timeout: the first
/// guards against a publisher that died, the second against one whose messages are stuck on the way. What bounds itself
/// is in force until it is replaced: a path, which has a duration of its own, and a position to go to, where the arm
/// comes to rest. A position that moves by itself does not.
class CommandGate {
 public:
  struct Configuration {
    std::vector<std::string> joints;
    std::string base;
    std::string tip;
    double timeout = 0.5;      // [s]
    std::vector<bool> slides;  // joints whose units are those of lengths; empty: none
  };

  explicit CommandGate(Configuration configuration);

  /// Takes `command`, received at `now`. Returns why it was refused, empty if it is in force from now on. What was in
  /// force before a refused one stays in force. Refused are: another mode than `mode`, a wrong number of values,
  /// unknown or missing joints, another frame than base or tip, values that are not finite or absurdly large, stamps
  /// too old, too far ahead, or earlier than that of the command in force.
  std::string admit(const ArmCommand& command, ControlMode mode, Nanoseconds now);

  /// The command in force, values in the arm's joint order; null if there is none, and then whyNone() says why.
  const ArmCommand* inForce(Nanoseconds now);
  const std::string& whyNone() const { return why_none_; }
  /// Whether the command in force is for another mode.
  bool holdsAnother(ControlMode mode) const { return command_ && command_->mode != mode; }
  /// When the command in force came in.
  Nanoseconds receipt() const { return receipt_; }

  /// Forgets the command in force, not the clocks.
  void clear(const std::string& why);

  /// As it was when it was made.
  void reset();

  void exchange(Snapshot& snapshot);

  /// Publishers whose clock differs from this one: "/teleop: stamps are 5 s behind this clock (transport or skew)".
  std::vector<std::string> clockMismatches() const;

 private:
  std::string checkValues(const ArmCommand& command, ArmCommand& sorted) const;
  struct Units;
  std::string checkTwist(const ArmCommand& command) const;
  std::string checkNames(const std::vector<std::string>& names, std::vector<Eigen::Index>& order) const;
  std::string checkSize(const std::string& what, const Eigen::VectorXd& values, std::size_t names) const;
  std::string sort(const std::string& what, const Units& units, const std::vector<Eigen::Index>& order,
                   Eigen::VectorXd& values) const;
  std::string checkStamp(const ArmCommand& command, Nanoseconds now);
  static std::string checkStart(const ArmCommand& command, Nanoseconds now);

  Configuration configuration_;
  std::map<std::string, PublisherClock> clocks_;  // by source
  std::optional<ArmCommand> command_;
  Nanoseconds receipt_ = 0;
  std::string why_none_ = "no command yet";
};

}  // namespace demo_logger
