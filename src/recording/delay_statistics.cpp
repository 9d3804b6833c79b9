#include "delay_statistics.h"

#include <algorithm>

#include "clock_offset.h"

namespace demo_logger {

void DelayStatistics::add(Nanoseconds delay) {
  least_ = count_ == 0 ? delay : std::min(least_, delay);
  largest_ = count_ == 0 ? delay : std::max(largest_, delay);
  if (count_ % stride_ == 0) {
    if (kept_.size() == kKept) {
      for (std::size_t i = 0; i < kKept / 2; ++i) kept_[i] = kept_[2 * i];
      kept_.resize(kKept / 2);
      stride_ *= 2;
    }
    // Here the count is a multiple of kKept times the old stride, so of the new one too.
    kept_.push_back(delay);
  }
  ++count_;
}

DelaySummary DelayStatistics::summary() const {
  if (count_ == 0) return {};
  std::vector<Nanoseconds> kept = kept_;
  return {toSeconds(least_), toSeconds(median(kept)), toSeconds(largest_)};
}

}  // namespace demo_logger
