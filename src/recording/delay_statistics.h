#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "demo_logger/trajectory/metadata.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// Least, median and largest of any number of delays in bounded memory. The median is exact for the first kKept
/// delays; of more, it is that of every second, fourth, eighth, … one, so it stays the same in every run.
class DelayStatistics {
 public:
  static constexpr std::size_t kKept = 4096;

  void add(Nanoseconds delay);
  /// Zeros without any.
  DelaySummary summary() const;

 private:
  std::uint64_t count_ = 0;
  std::uint64_t stride_ = 1;
  Nanoseconds least_ = 0;
  Nanoseconds largest_ = 0;
  std::vector<Nanoseconds> kept_;
};

}  // namespace demo_logger
