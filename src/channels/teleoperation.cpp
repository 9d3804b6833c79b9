#include "demo_logger/channels/teleoperation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

void validate(const TeleoperationConfiguration& configuration) {
  const auto inputs = static_cast<std::size_t>(configuration.map.gain.cols());
  if (configuration.axes.size() != inputs) {
    throw ConfigurationError("teleoperation: " + std::to_string(configuration.axes.size()) +
                             " axes are listed, expected " + std::to_string(inputs) + " as the map has inputs.");
  }
  for (const int axis : configuration.axes) {
    if (axis < 0) {
      throw ConfigurationError("teleoperation: axis " + std::to_string(axis) +
                               " is listed, expected numbers from 0 as the device counts them.");
    }
  }
  if (configuration.enable_button < -1) {
    throw ConfigurationError("teleoperation: enable_button is " + std::to_string(configuration.enable_button) +
                             ", expected a button from 0, or -1 for none.");
  }
  if (!std::isfinite(configuration.timeout) || configuration.timeout <= 0.0) {
    throw ConfigurationError("teleoperation: timeout is " + print(configuration.timeout) +
                             " s, expected a positive time.");
  }
}

}  // namespace

Teleoperation::Teleoperation(TeleoperationConfiguration configuration)
    : configuration_(std::move(configuration)), map_(configuration_.map) {
  validate(configuration_);
}

std::optional<TeleopCommand> Teleoperation::receive(const DeviceReading& reading) {
  complaint_.clear();
  last_receipt_ = reading.receipt;
  last_stamp_ = reading.stamp;

  const auto highest_axis =
      static_cast<std::size_t>(*std::max_element(configuration_.axes.begin(), configuration_.axes.end()));
  if (reading.axes.size() <= highest_axis) {
    complaint_ = "the device has " + std::to_string(reading.axes.size()) + " axes, but axis " +
                 std::to_string(highest_axis) + " is asked for (they count from 0); nothing moves.";
    return stop(reading.stamp);
  }
  if (configuration_.enable_button >= 0) {
    const auto button = static_cast<std::size_t>(configuration_.enable_button);
    if (button >= reading.buttons.size()) {
      complaint_ = "the device has " + std::to_string(reading.buttons.size()) + " buttons, but enable_button is " +
                   std::to_string(button) + " (they count from 0); nothing moves.";
      return stop(reading.stamp);
    }
    if (reading.buttons[button] == 0) return stop(reading.stamp);
  }

  Eigen::VectorXd h(map_.inputs());
  for (int i = 0; i < map_.inputs(); ++i) {
    h[i] = reading.axes[static_cast<std::size_t>(configuration_.axes[static_cast<std::size_t>(i)])];
  }
  active_ = true;
  return TeleopCommand{reading.stamp, map_.map(h)};
}

std::optional<TeleopCommand> Teleoperation::expire(Nanoseconds now) {
  const Nanoseconds silence = now - last_receipt_;
  if (!active_ || silence < fromSeconds(configuration_.timeout)) return std::nullopt;
  return stop(last_stamp_ + silence);
}

std::optional<TeleopCommand> Teleoperation::stop(Nanoseconds stamp) {
  const bool was_active = std::exchange(active_, false);
  if (!was_active || configuration_.map.mode == TeleopMode::pose) return std::nullopt;
  // A stop is no image of any reading: the offset of the map does not belong into it.
  return TeleopCommand{stamp, {Eigen::VectorXd::Zero(configuration_.map.gain.rows()), false}};
}

}  // namespace demo_logger
