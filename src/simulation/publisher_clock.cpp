#include "demo_logger/simulation/publisher_clock.h"

#include <algorithm>

#include "snapshot.h"

namespace demo_logger {
namespace {

constexpr std::size_t kFewest = 5;
constexpr std::size_t kMost = 1000;  // of a fast publisher; bounds the memory
constexpr Nanoseconds kWindow = kNanosecondsPerSecond;
constexpr Nanoseconds kShortestTransport = -20'000'000;
constexpr Nanoseconds kLongestTransport = 100'000'000;

}  // namespace

void PublisherClock::observe(Nanoseconds stamp, Nanoseconds receipt) {
  if (offset_) {
    const bool from_the_future = receipt - stamp < *offset_ + kShortestTransport;
    from_the_future_ = from_the_future ? from_the_future_ + 1 : 0;
    if (from_the_future_ < kFewest) return;
    offset_.reset();
    from_the_future_ = 0;
  }
  if (delays_.empty()) first_receipt_ = receipt;
  if (delays_.size() < kMost) delays_.push_back(receipt - stamp);
  if (delays_.size() < kFewest || receipt - first_receipt_ < kWindow) return;

  const auto middle = delays_.begin() + static_cast<std::ptrdiff_t>(delays_.size() / 2);
  std::nth_element(delays_.begin(), middle, delays_.end());
  const bool is_transport = *middle >= kShortestTransport && *middle <= kLongestTransport;
  offset_ = is_transport ? 0 : *middle;
  delays_.clear();
}

/// Stamps and receipts of later messages are both by a moved clock, so that delays stay as they are.
void PublisherClock::exchange(Snapshot& snapshot) {
  snapshot.value("delays", delays_);
  snapshot.stamp("first_receipt", first_receipt_);
  snapshot.optional("offset", offset_, [](Snapshot& inside, Nanoseconds& offset) { inside.duration("ns", offset); });
  snapshot.count("from_the_future", from_the_future_, kFewest);
}

}  // namespace demo_logger
