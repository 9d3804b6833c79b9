#include "clock_offset.h"

#include <algorithm>

namespace demo_logger {

void ClockOffset::add(Nanoseconds receipt, Nanoseconds receipt_minus_stamp) {
  if (value_ || samples_.size() == kSamples) return;
  if (!first_receipt_) first_receipt_ = receipt;
  if (receipt <= *windowEnd()) samples_.push_back(receipt_minus_stamp);
}

std::optional<Nanoseconds> ClockOffset::windowEnd() const {
  if (!first_receipt_) return std::nullopt;
  return *first_receipt_ + kWindow;
}

void ClockOffset::freeze() {
  if (value_ || samples_.empty()) return;
  value_ = median(samples_);
  samples_ = {};
}

Nanoseconds median(std::vector<Nanoseconds>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  const Nanoseconds below = *std::max_element(values.begin(), middle);
  return below + (*middle - below) / 2;
}

}  // namespace demo_logger
