#include "row_pacing.h"

#include <algorithm>

namespace demo_logger {

std::optional<Nanoseconds> RowPacing::add(Nanoseconds stamp) {
  std::optional<Nanoseconds> gap;
  if (last_) {
    const Nanoseconds interval = stamp - *last_;
    if (interval > max_gap_ || (usual_ && interval > kGapFactor * *usual_)) gap = interval;
    remember(interval);
  }
  last_ = stamp;
  return gap;
}

void RowPacing::remember(Nanoseconds interval) {
  intervals_[count_ % kRemembered] = interval;
  if (++count_ % kKnownAfter != 0) return;
  auto sorted = intervals_;
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kRemembered));
  const auto middle = sorted.begin() + (end - sorted.begin()) / 2;
  std::nth_element(sorted.begin(), middle, end);
  usual_ = *middle;
}

}  // namespace demo_logger
