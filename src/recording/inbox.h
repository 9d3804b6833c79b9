#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <variant>

#include "demo_logger/recording/sample.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// The source of a message is the index of its stream, or this.
constexpr std::size_t kJointStates = static_cast<std::size_t>(-1);

struct Message {
  std::size_t source = kJointStates;
  Nanoseconds received = 0;  // when it counts as received, ROS time
  std::variant<JointStateSample, StreamSample> sample;
  const char* rejected = nullptr;  // why it cannot be believed; its arrays were not kept then

  const Arrival& arrival() const;
};

/// Puts messages into the one order in which they are looked at, whatever the order of the calls to push:
///   by receipt, then by source (streams in configured order, joint states last), by stamp, and by the order of arrival
///   from that source.
/// The watermark is the receipt up to which everything has arrived. A message that comes behind it counts as received
/// just after it. Behind it by more than kSetBack, either the message is very late or the clock of the receipts has
/// been set back; the next watermark tells which, and such messages wait for it.
class Inbox {
 public:
  /// Messages held at most; beyond, the oldest are lost.
  static constexpr std::size_t kCapacity = 65536;
  static constexpr Nanoseconds kSetBack = kNanosecondsPerSecond;

  /// What happened to others when a message was pushed.
  struct Pushed {
    bool late = false;        // it came behind the watermark
    bool overflowed = false;  // one message was lost
  };
  Pushed push(Message message);

  /// Whether `watermark` tells that the clock of the receipts was set back.
  bool isSetBack(Nanoseconds watermark) const;
  /// Begins the receipts that follow a clock set back. Take what was received before it first.
  void restartAt(Nanoseconds watermark);
  /// Raises the watermark; a lower one changes nothing. Returns the messages that turned out to be very late.
  std::size_t raise(Nanoseconds watermark);

  Nanoseconds watermark() const { return *watermark_; }

  /// The first message received at or before the watermark (`all`: the first one), or nothing.
  const Message* next(bool all = false) const;
  Message take();

  /// Calls visit(message) for what waits, in order, while it returns true.
  template <typename Visit>
  void peek(const Visit& visit) const {
    for (const auto& [key, message] : messages_) {
      if (!visit(message)) return;
    }
  }

  std::size_t size() const { return messages_.size() + behind_.size(); }

 private:
  using Key = std::tuple<Nanoseconds, std::size_t, Nanoseconds, std::uint64_t>;  // receipt, source, stamp, arrival
  using Messages = std::map<Key, Message>;

  void insert(Messages& messages, Message message);

  Messages messages_;
  Messages behind_;  // behind the watermark by more than kSetBack
  std::optional<Nanoseconds> watermark_;
  std::uint64_t arrivals_ = 0;
};

}  // namespace demo_logger
