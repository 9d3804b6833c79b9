#pragma once

#include <cmath>
#include <cstdint>

namespace demo_logger {

/// An instant or a duration in integer nanoseconds. Instants count from the Unix epoch, or from the
/// start of a simulation. Doubles would round an epoch instant to 238 ns; integers do not.
using Nanoseconds = std::int64_t;

constexpr Nanoseconds kNanosecondsPerSecond = 1'000'000'000;

/// Durations only: an instant since the epoch loses its nanoseconds in a double.
constexpr double toSeconds(Nanoseconds duration) {
  return static_cast<double>(duration) / static_cast<double>(kNanosecondsPerSecond);
}

/// Nearest nanosecond. `seconds` must be finite and below 292 years.
inline Nanoseconds fromSeconds(double seconds) {
  return static_cast<Nanoseconds>(std::llround(seconds * static_cast<double>(kNanosecondsPerSecond)));
}

}  // namespace demo_logger
