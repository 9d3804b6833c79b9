#pragma once

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/channels/teleop_map.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

struct TeleoperationConfiguration {
  TeleopMapConfiguration map;
  std::vector<int> axes;   // the device's axis behind each input of the map
  int enable_button = -1;  // held down for as long as commands shall flow; -1: they always do
  double timeout = 0.5;    // [s] without a reading, after which the arm is told to stop
};

/// One reading of the device: axes in [-1, 1] as a rule, buttons 0 or 1.
struct DeviceReading {
  Nanoseconds stamp = 0;    // when it was made
  Nanoseconds receipt = 0;  // when it arrived, on the clock that is given to expire()
  std::vector<double> axes;
  std::vector<int> buttons;
};

/// What to send: a value of the map, or in mode `rate` zero, to stop.
struct TeleopCommand {
  Nanoseconds stamp = 0;
  TeleopOutput output;
};

/// Turns readings of a device into commands. While enabled, each reading gives one command with the reading's stamp.
/// When the enable button is let go, or no reading came for the timeout, mode `rate` sends one zero command and falls
/// silent; mode `pose` just falls silent, which leaves the arm at the last pose. So nothing competes with other sources
/// of commands while the operator's hand is off.
class Teleoperation {
 public:
  /// Throws ConfigurationError as TeleopMap does, and for axes or times that cannot be.
  explicit Teleoperation(TeleoperationConfiguration configuration);

  const TeleopMap& map() const { return map_; }

  std::optional<TeleopCommand> receive(const DeviceReading& reading);
  /// To be called now and then: the stop that a silent device cannot ask for.
  std::optional<TeleopCommand> expire(Nanoseconds now);

  /// Why the last reading gave no command although it came: "joy has 2 axes, …". Empty if all is well.
  const std::string& complaint() const { return complaint_; }

 private:
  std::optional<TeleopCommand> stop(Nanoseconds stamp);

  TeleoperationConfiguration configuration_;
  TeleopMap map_;
  bool active_ = false;  // the last command was not the stop
  Nanoseconds last_receipt_ = 0;
  Nanoseconds last_stamp_ = 0;
  std::string complaint_;
};

}  // namespace demo_logger
