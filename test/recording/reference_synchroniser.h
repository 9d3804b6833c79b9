#pragma once

// The rules of synchronisation written a second time, as plainly as they can be said: no buffers that forget, no
// incremental state. For every row all messages are scanned. Shares no code with the recorder.

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "demo_logger/recording/stream_configuration.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger::testing_support {

struct ReferenceMessage {
  Nanoseconds effective = 0;
  Nanoseconds receipt = 0;
  double value = 0.0;
};

struct ReferenceRow {
  Nanoseconds stamp = 0;
  Nanoseconds receipt = 0;
  double position = 0.0;
  std::vector<double> streams;  // value and age of each stream
};

struct ReferenceResult {
  std::vector<ReferenceRow> rows;  // in the order of their stamps
  std::size_t late = 0;
  std::size_t duplicates = 0;
};

/// Joint states and streams in the order of their receipts, equal receipts in the order of their stamps.
struct ReferenceSynchroniser {
  Nanoseconds wait = 0;  // max_wait and the largest latency
  Nanoseconds max_gap = 0;
  std::vector<Alignment> alignments;
  std::vector<std::vector<ReferenceMessage>> streams;

  /// Which joint states become rows: those that wait are released in the order of their stamps, each when its wait is
  /// over and no earlier one waits.
  ReferenceResult run(const std::vector<ReferenceMessage>& joint_states) const {
    ReferenceResult result;
    std::vector<ReferenceMessage> waiting;
    const auto releaseUntil = [&](Nanoseconds now) {
      while (!waiting.empty()) {
        std::size_t earliest = 0;
        for (std::size_t i = 1; i < waiting.size(); ++i) {
          if (waiting[i].effective < waiting[earliest].effective) earliest = i;
        }
        if (waiting[earliest].receipt + wait >= now) return;
        result.rows.push_back(fill(waiting[earliest]));
        waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(earliest));
      }
    };
    for (const ReferenceMessage& joint_state : joint_states) {
      releaseUntil(joint_state.receipt);
      bool duplicate = false;
      for (const ReferenceMessage& other : waiting) duplicate = duplicate || other.effective == joint_state.effective;
      for (const ReferenceRow& row : result.rows) duplicate = duplicate || row.stamp == joint_state.effective;
      if (duplicate) {
        ++result.duplicates;
      } else if (!result.rows.empty() && joint_state.effective < result.rows.back().stamp) {
        ++result.late;
      } else {
        waiting.push_back(joint_state);
      }
    }
    releaseUntil(std::numeric_limits<Nanoseconds>::max());
    return result;
  }

  /// How many messages of a stream came after the wait of a row that they would have changed.
  std::size_t countLate(std::size_t stream, const std::vector<ReferenceRow>& rows) const {
    std::size_t late = 0;
    std::map<Nanoseconds, double> known;
    for (const ReferenceMessage& message : streams[stream]) {
      std::map<Nanoseconds, double> with = known;
      with[message.effective] = message.value;
      bool changes = false;
      for (const ReferenceRow& row : rows) {
        if (row.receipt + wait >= message.receipt) continue;
        const Aligned before = align(known, alignments[stream], row.stamp);
        const Aligned after = align(with, alignments[stream], row.stamp);
        changes = changes || differ(before.value, after.value) || differ(before.age, after.age);
      }
      if (changes) ++late;
      known = with;
    }
    return late;
  }

 private:
  ReferenceRow fill(const ReferenceMessage& joint_state) const {
    ReferenceRow row{joint_state.effective, joint_state.receipt, joint_state.value, {}};
    for (std::size_t i = 0; i < streams.size(); ++i) {
      std::map<Nanoseconds, double> counting;  // of equal stamps the last received
      for (const ReferenceMessage& message : streams[i]) {
        if (message.receipt <= joint_state.receipt + wait) counting[message.effective] = message.value;
      }
      const auto [value, age] = align(counting, alignments[i], row.stamp);
      row.streams.push_back(value);
      row.streams.push_back(age);
    }
    return row;
  }

  static bool differ(double one, double other) { return !(one == other || (std::isnan(one) && std::isnan(other))); }

  struct Aligned {
    double value = std::numeric_limits<double>::quiet_NaN();
    double age = std::numeric_limits<double>::quiet_NaN();
  };

  Aligned align(const std::map<Nanoseconds, double>& messages, Alignment alignment, Nanoseconds instant) const {
    const std::pair<const Nanoseconds, double>* before = nullptr;  // the last at or before the instant
    const std::pair<const Nanoseconds, double>* after = nullptr;   // the first after it
    for (const auto& message : messages) {
      if (message.first <= instant) before = &message;
      if (message.first > instant && after == nullptr) after = &message;
    }
    const auto age = [instant](const std::pair<const Nanoseconds, double>* message) {
      return static_cast<double>(instant - message->first) / 1e9;
    };
    Aligned aligned;
    if (alignment == Alignment::hold && before != nullptr) aligned = {before->second, age(before)};
    if (alignment == Alignment::nearest) {
      const auto* closest = before;
      if (before == nullptr || (after != nullptr && after->first - instant < instant - before->first)) closest = after;
      if (closest != nullptr) aligned = {closest->second, age(closest)};
    }
    if (alignment == Alignment::linear && before != nullptr) {
      aligned.age = age(before);
      if (before->first == instant) {
        aligned.value = before->second;
      } else if (after != nullptr && after->first - before->first <= max_gap) {
        const auto whole = static_cast<double>(after->first - before->first);
        const auto part = static_cast<double>(instant - before->first);
        aligned.value = before->second + (after->second - before->second) * part / whole;
      }
    }
    return aligned;
  }
};

}  // namespace demo_logger::testing_support
