#include "stream_layout.h"

#include <algorithm>
#include <set>

namespace demo_logger {
namespace {

constexpr std::size_t kOrientationOfPose = 3;

StreamLayout twistLayout() {
  return {StreamType::twist,
          {{"vx", "m/s", "linear/x"},
           {"vy", "m/s", "linear/y"},
           {"vz", "m/s", "linear/z"},
           {"wx", "rad/s", "angular/x"},
           {"wy", "rad/s", "angular/y"},
           {"wz", "rad/s", "angular/z"}}};
}

StreamLayout poseLayout() {
  return {StreamType::pose,
          {{"x", "m", "position/x"},
           {"y", "m", "position/y"},
           {"z", "m", "position/z"},
           {"qx", "", "orientation/x"},
           {"qy", "", "orientation/y"},
           {"qz", "", "orientation/z"},
           {"qw", "", "orientation/w"}}};
}

StreamLayout wrenchLayout() {
  return {StreamType::wrench,
          {{"fx", "N", "force/x"},
           {"fy", "N", "force/y"},
           {"fz", "N", "force/z"},
           {"tx", "N m", "torque/x"},
           {"ty", "N m", "torque/y"},
           {"tz", "N m", "torque/z"}}};
}

/// Whether value `i` of `sample` is the component, in the same unit where the message tells it.
bool matches(const StreamLayout::Component& component, const StreamSample& sample, std::size_t i) {
  return component.source == sample.components[i] && (i >= sample.units.size() || component.unit == sample.units[i]);
}

}  // namespace

std::optional<std::size_t> StreamLayout::orientation() const {
  if (type != StreamType::pose) return std::nullopt;
  return kOrientationOfPose;
}

const char* nameOf(StreamType type) {
  switch (type) {
    case StreamType::twist:
      return "twist";
    case StreamType::pose:
      return "pose";
    case StreamType::wrench:
      return "wrench";
    case StreamType::number:
      return "number";
    case StreamType::joy:
      return "joy";
    case StreamType::joint_command:
      return "joint_command";
  }
  return "unknown";
}

bool fixesLayout(StreamType type) { return type != StreamType::joy && type != StreamType::joint_command; }

std::optional<StreamLayout> layoutOf(StreamType type) {
  switch (type) {
    case StreamType::twist:
      return twistLayout();
    case StreamType::pose:
      return poseLayout();
    case StreamType::wrench:
      return wrenchLayout();
    case StreamType::number:
      return StreamLayout{StreamType::number, {{"value", "", "value"}}};
    case StreamType::joy:
    case StreamType::joint_command:
      break;
  }
  return std::nullopt;
}

std::optional<StreamLayout> layoutOf(const StreamSample& sample) {
  if (auto fixed = layoutOf(sample.type)) {
    if (sample.values.size() != fixed->width()) return std::nullopt;
    return fixed;
  }
  const std::set<std::string> distinct(sample.components.begin(), sample.components.end());
  if (sample.components.empty() || sample.components.size() != sample.values.size() ||
      distinct.size() != sample.components.size()) {
    return std::nullopt;
  }
  StreamLayout layout{sample.type, {}};
  for (std::size_t i = 0; i < sample.components.size(); ++i) {
    const std::string unit = i < sample.units.size() ? sample.units[i] : std::string();
    layout.components.push_back({sample.components[i], unit, sample.components[i]});
  }
  return layout;
}

std::optional<std::vector<std::size_t>> orderIn(const StreamLayout& layout, const StreamSample& sample) {
  const std::size_t width = layout.width();
  if (sample.type != layout.type || sample.values.size() != width) return std::nullopt;
  std::vector<std::size_t> order;
  if (fixesLayout(layout.type)) return order;
  if (sample.components.size() != width) return std::nullopt;

  std::size_t same = 0;
  while (same < width && matches(layout.components[same], sample, same)) ++same;
  if (same == width) return order;

  std::vector<bool> taken(width, false);
  for (std::size_t i = 0; i < width; ++i) {
    std::size_t place = 0;
    while (place < width && !matches(layout.components[place], sample, i)) ++place;
    if (place == width || taken[place]) return std::nullopt;
    taken[place] = true;
    order.push_back(place);
  }
  return order;
}

}  // namespace demo_logger
