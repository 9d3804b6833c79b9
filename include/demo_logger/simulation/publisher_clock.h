#pragma once

#include <optional>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

class Snapshot;

/// How far a publisher's clock is behind this one, judged from its messages: the median of receipt − stamp over the
/// first second, and at least five of them, then frozen. Within [−20 ms, 100 ms] it is taken for transport, and the
/// clocks for equal. A constant delay on the way cannot be told from a clock that is behind; but nothing comes from the
/// future: five messages in a row that would, by more than 20 ms, show that the first second was judged wrongly (its
/// messages were stale), and it is judged anew.
class PublisherClock {
 public:
  void observe(Nanoseconds stamp, Nanoseconds receipt);

  /// Nothing until it is frozen; zero for clocks taken for equal.
  std::optional<Nanoseconds> offset() const { return offset_; }

  void exchange(Snapshot& snapshot);

 private:
  std::vector<Nanoseconds> delays_;
  Nanoseconds first_receipt_ = 0;
  std::optional<Nanoseconds> offset_;
  std::size_t from_the_future_ = 0;  // in a row
};

}  // namespace demo_logger
