#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// Tells a gap between two rows from the pace of the joint states. An interval is a gap if it is longer than `max_gap`,
/// or longer than kGapFactor times the usual interval: the median of the last kRemembered ones (as it stood after the
/// last multiple of kKnownAfter rows), once kKnownAfter are known.
class RowPacing {
 public:
  static constexpr std::size_t kRemembered = 64;
  static constexpr std::size_t kKnownAfter = 8;
  static constexpr Nanoseconds kGapFactor = 5;

  explicit RowPacing(Nanoseconds max_gap) : max_gap_(max_gap) {}

  /// The stamps of an episode's rows, increasing. Returns the length of the gap that ends at `stamp`, if one does.
  std::optional<Nanoseconds> add(Nanoseconds stamp);
  std::optional<Nanoseconds> last() const { return last_; }  // stamp
  std::optional<Nanoseconds> usualInterval() const { return usual_; }
  void clear() { *this = RowPacing(max_gap_); }

 private:
  void remember(Nanoseconds interval);

  Nanoseconds max_gap_;
  std::optional<Nanoseconds> last_;
  std::optional<Nanoseconds> usual_;
  std::array<Nanoseconds, kRemembered> intervals_{};
  std::size_t count_ = 0;
};

}  // namespace demo_logger
