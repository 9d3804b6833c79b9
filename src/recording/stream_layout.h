#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/sample.h"

namespace demo_logger {

/// What the values of a stream's messages are: one component per value.
struct StreamLayout {
  struct Component {
    std::string suffix;  // of the column: "vx"
    std::string unit;
    std::string source;  // below the topic: "linear/x"
  };

  StreamType type = StreamType::number;
  std::vector<Component> components;

  std::size_t width() const { return components.size(); }
  /// Index of the first of the four components x y z w of an orientation.
  std::optional<std::size_t> orientation() const;
};

const char* nameOf(StreamType type);

/// Whether every message of the type has the same components: all but joy and joint_command.
bool fixesLayout(StreamType type);

/// The layout of the types that fix it.
std::optional<StreamLayout> layoutOf(StreamType type);

/// The layout that a message shows. Nothing if it is malformed: values that disagree with the components or the type
/// in number, components given twice.
std::optional<StreamLayout> layoutOf(const StreamSample& sample);

/// The place of each value of `sample` in `layout`, empty if the order is the same; nothing if the components or
/// their units differ.
std::optional<std::vector<std::size_t>> orderIn(const StreamLayout& layout, const StreamSample& sample);

}  // namespace demo_logger
