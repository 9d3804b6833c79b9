#pragma once

#include <string>

#include "demo_logger/channels/teleoperation.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// A joystick of six axes and ten buttons out of keys. A key holds its axis while it repeats, and for the hold time
/// after: terminals do not tell when a key is let go. Button 0, by custom the enable button, is held with any axis.
class KeyboardDevice {
 public:
  struct Configuration {
    double hold_time = 0.6;   // [s]; longer than the terminal waits before it repeats a key
    double press_time = 0.2;  // [s] that a button stays pressed
    double step = 0.1;        // of the deflection, that + and − add and take
  };

  explicit KeyboardDevice(const Configuration& configuration) : configuration_(configuration) {}

  /// A key, received at `now`. Unknown ones are ignored.
  void press(char key, Nanoseconds now);
  /// The device at `now`.
  DeviceReading read(Nanoseconds now) const;

  /// What the keys do, in lines.
  static std::string help();

 private:
  static constexpr int kAxes = 6;
  static constexpr int kButtons = 10;

  Configuration configuration_;
  double deflection_ = 0.5;
  double direction_[kAxes] = {};
  Nanoseconds axis_until_[kAxes] = {};
  Nanoseconds button_until_[kButtons] = {};
};

}  // namespace demo_logger
