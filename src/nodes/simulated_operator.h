#pragma once

#include <ros/ros.h>
#include <sensor_msgs/Joy.h>

#include <cstdint>
#include <functional>
#include <string>

#include "src/ros/parameters.h"

namespace demo_logger {

// What whoever operates a simulated arm does alike, at a device or by hand: press the recorder's buttons, wait for
// those who listen, and end with the task.

constexpr std::uint32_t kOperatorQueue = 100;
constexpr double kReminderPeriod = 10.0;  // [s] between words about a missing arm

struct OperatorButtons {
  int start = -1;  // of joy, pressed for the recorder at the beginning and at the end; -1: none
  int stop = -1;

  bool any() const { return start >= 0 || stop >= 0; }
};

/// start_button and stop_button.
OperatorButtons readOperatorButtons(Parameters& parameters);

/// Nodes that must listen to joy before the operator begins, lest a button is not heard.
std::uint32_t readListeners(Parameters& parameters, std::uint32_t fallback);

/// Warns each kReminderPeriod, as long as it is kept and `waits` says so, of what the operator waits for: `for_what`,
/// and so many listeners to `joy`.
ros::WallTimer remindOfWaiting(const ros::NodeHandle& node, const ros::Publisher& joy, std::uint32_t listeners,
                               const std::string& for_what, const std::function<bool()>& waits);

/// Messages that have come already are still handled after it: whoever calls it looks whether the task is done.
void endWithTask();

}  // namespace demo_logger
