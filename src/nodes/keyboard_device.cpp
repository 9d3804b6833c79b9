#include "src/nodes/keyboard_device.h"

#include <algorithm>
#include <array>

namespace demo_logger {
namespace {

struct AxisKey {
  char key;
  int axis;
  double direction;
};

// x forward, y left, z up; then rotations about them: one hand slides the tool, the other one turns it.
constexpr std::array<AxisKey, 12> kAxisKeys{{{'w', 0, 1.0},
                                             {'s', 0, -1.0},
                                             {'a', 1, 1.0},
                                             {'d', 1, -1.0},
                                             {'r', 2, 1.0},
                                             {'f', 2, -1.0},
                                             {'l', 3, 1.0},
                                             {'j', 3, -1.0},
                                             {'i', 4, 1.0},
                                             {'k', 4, -1.0},
                                             {'u', 5, 1.0},
                                             {'o', 5, -1.0}}};

}  // namespace

void KeyboardDevice::press(char key, Nanoseconds now) {
  if (key == ' ') std::fill(std::begin(axis_until_), std::end(axis_until_), now);
  if (key == '+') deflection_ = std::min(1.0, deflection_ + configuration_.step);
  if (key == '-') deflection_ = std::max(configuration_.step, deflection_ - configuration_.step);
  if (key >= '1' && key <= '9') button_until_[key - '0'] = now + fromSeconds(configuration_.press_time);
  for (const AxisKey& axis_key : kAxisKeys) {
    if (axis_key.key != key) continue;
    direction_[axis_key.axis] = axis_key.direction;
    axis_until_[axis_key.axis] = now + fromSeconds(configuration_.hold_time);
  }
}

DeviceReading KeyboardDevice::read(Nanoseconds now) const {
  DeviceReading reading{now, now, std::vector<double>(kAxes, 0.0), std::vector<int>(kButtons, 0)};
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (now >= axis_until_[i]) continue;
    reading.axes[i] = deflection_ * direction_[i];
    reading.buttons[0] = 1;
  }
  for (std::size_t i = 1; i < kButtons; ++i) reading.buttons[i] = now < button_until_[i] ? 1 : 0;
  return reading;
}

std::string KeyboardDevice::help() {
  return "  w/s  x forward, back      i/k  pitch       + -    faster, slower\n"
         "  a/d  y left, right        j/l  roll        space  stop\n"
         "  r/f  z up, down           u/o  yaw         1 … 9  buttons of joy\n"
         "  Hold a key to move; button 0 (enable) is held with it. Ctrl-C ends.\n";
}

}  // namespace demo_logger
