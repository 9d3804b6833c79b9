#pragma once

// A synchroniser fed by hand, in milliseconds since an instant of today.

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "builders.h"

namespace demo_logger::testing_support {

constexpr Nanoseconds kToday = 1'760'000'000 * kNanosecondsPerSecond;

/// An instant `ms` milliseconds after kToday.
constexpr Nanoseconds at(double ms) { return kToday + static_cast<Nanoseconds>(ms * 1e6); }

class Timeline {
 public:
  explicit Timeline(SynchroniserConfiguration configuration) : synchroniser(std::move(configuration)) {}

  /// A joint state of joint `elbow`, received 1 ms after its stamp unless told.
  void elbow(double stamp_ms, double position, std::optional<double> receipt_ms = std::nullopt) {
    joint(stamp_ms, {"elbow"}, {position}, receipt_ms);
  }
  void joint(double stamp_ms, std::vector<std::string> names, std::vector<double> positions,
             std::optional<double> receipt_ms = std::nullopt) {
    synchroniser.push(
        makeJointState(at(stamp_ms), at(receipt_ms.value_or(stamp_ms + 1)), std::move(names), std::move(positions)));
  }
  void number(std::size_t stream, double stamp_ms, double value, std::optional<double> receipt_ms = std::nullopt) {
    synchroniser.push(stream, makeNumber(at(stamp_ms), at(receipt_ms.value_or(stamp_ms + 1)), value));
  }
  void begin(double request_ms = -1000.0) { synchroniser.begin(at(request_ms)); }
  void advance(double watermark_ms) { synchroniser.advance(at(watermark_ms), listener); }
  void end(double request_ms) { synchroniser.end(at(request_ms), listener); }

  std::uint64_t counter(const std::string& name) const { return synchroniser.counters().at(name); }
  /// The sentence that contains `part`, or "" if none does.
  std::string faultWith(const std::string& part) const {
    for (const Fault& fault : synchroniser.faults()) {
      if (fault.what.find(part) != std::string::npos) return fault.what;
    }
    return "";
  }

  Synchroniser synchroniser;
  RecordingListener listener;
};

/// Streams of one number each: s0, s1, ….
inline SynchroniserConfiguration numberStreams(const std::vector<Alignment>& alignments) {
  SynchroniserConfiguration configuration;
  for (const Alignment alignment : alignments) {
    const std::string name = "s" + std::to_string(configuration.streams.size());
    configuration.streams.push_back(makeStream(name, StreamType::number, alignment));
  }
  return configuration;
}

}  // namespace demo_logger::testing_support
