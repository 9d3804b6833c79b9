#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// By how much this machine's clock is ahead of the joint states' stamps, transport included: the median of
/// receipt − stamp over the first second of joint states, then frozen.
class ClockOffset {
 public:
  static constexpr Nanoseconds kWindow = kNanosecondsPerSecond;
  static constexpr std::size_t kSamples = 65536;  // at most; later ones of the window are not looked at

  /// Ignored once frozen, and beyond the window.
  void add(Nanoseconds receipt, Nanoseconds receipt_minus_stamp);
  /// The receipt at which the window ends; nothing before the first sample.
  std::optional<Nanoseconds> windowEnd() const;
  /// Ignored without samples.
  void freeze();
  /// Nothing until frozen.
  std::optional<Nanoseconds> value() const { return value_; }

 private:
  std::optional<Nanoseconds> first_receipt_;
  std::vector<Nanoseconds> samples_;
  std::optional<Nanoseconds> value_;
};

/// The middle one, or the mean of the two in the middle. Changes the order; `values` must not be empty.
Nanoseconds median(std::vector<Nanoseconds>& values);

}  // namespace demo_logger
