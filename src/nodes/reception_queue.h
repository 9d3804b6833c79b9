#pragma once

#include <ros/message_event.h>
#include <sensor_msgs/JointState.h>
#include <topic_tools/shape_shifter.h>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <variant>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// A message as the callback got it: a pointer, the connection it came by, and when.
struct Received {
  using JointStates = ros::MessageEvent<sensor_msgs::JointState>;
  using Stream = ros::MessageEvent<topic_tools::ShapeShifter const>;

  std::size_t source = 0;  // 0: joint states, 1 + i: stream i
  std::variant<JointStates, Stream> message;
  Nanoseconds steady = 0;  // its receipt on the steady clock
};

/// Hands messages from the callbacks to the thread that records them. Bounded: what does not fit is counted, so that a
/// recorder that cannot keep up says so instead of eating the memory.
class ReceptionQueue {
 public:
  /// Two seconds at 16 kHz.
  static constexpr std::size_t kCapacity = 32768;

  explicit ReceptionQueue(std::size_t sources, std::size_t capacity = kCapacity)
      : capacity_(capacity), lost_(sources, 0) {
    waiting_.reserve(capacity);
  }

  void push(Received received) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.size() < capacity_) {
      waiting_.push_back(std::move(received));
    } else {
      ++lost_[received.source];
    }
  }

  /// Everything that waits, oldest first; `emptied` comes back empty later, so that its memory is used again.
  void take(std::vector<Received>& emptied) {
    emptied.clear();
    emptied.reserve(capacity_);
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.swap(emptied);
  }

  /// Messages of each source that did not fit, since the beginning.
  std::vector<std::uint64_t> lost() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lost_;
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::vector<Received> waiting_;
  std::vector<std::uint64_t> lost_;
};

}  // namespace demo_logger
