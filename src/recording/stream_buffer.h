#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// One message of a stream, in the order of its columns.
struct StreamMessage {
  std::vector<double> values;
  std::uint64_t sequence = 0;     // its place in the order of all messages
  std::uint64_t received_in = 0;  // the episode in which it was received
  std::uint64_t used_in = 0;      // the last episode in which it entered a row
  std::size_t publisher = 0;
};

/// The messages of one stream by effective stamp, as many as rows to come may ask for.
class StreamBuffer {
 public:
  /// Messages held at most; beyond, the oldest are lost.
  static constexpr std::size_t kCapacity = 65536;

  using Messages = std::map<Nanoseconds, StreamMessage>;

  /// Of equal stamps the last replaces. False if a message (this one, or an older one) was lost to the capacity.
  bool insert(Nanoseconds effective, StreamMessage message);

  struct Neighbours {
    Messages::value_type* at_or_before = nullptr;
    Messages::value_type* after = nullptr;
  };
  Neighbours around(Nanoseconds instant);

  /// Forgets what no row at or after `horizon` can ask for.
  void prune(Nanoseconds horizon);
  void clear();
  /// Removes the messages whose sequence is at least `first`, and returns them.
  Messages extractSince(std::uint64_t first);

  /// The longest time between neighbours both received in `episode`.
  Nanoseconds largestGapIn(std::uint64_t episode) const;

  const Messages& messages() const { return messages_; }
  std::size_t size() const { return messages_.size(); }

 private:
  void forgetFirst();

  Messages messages_;
  std::uint64_t gap_episode_ = 0;  // to which largest_forgotten_gap_ belongs
  Nanoseconds largest_forgotten_gap_ = 0;
};

}  // namespace demo_logger
