#pragma once

// For tests of clocks: joint states whose clocks are chosen apart, and a listener that begins anew after a jump.

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>

#include "timeline.h"

namespace demo_logger::testing_support {

/// Begins the next episode from within clockJumped(), as a recorder with autostart does.
class RestartingListener : public RecordingListener {
 public:
  explicit RestartingListener(Synchroniser& synchroniser) : synchroniser_(synchroniser) {}
  void clockJumped(Nanoseconds stamp, double seconds) override {
    RecordingListener::clockJumped(stamp, seconds);
    rows_before = synchroniser_.counters().at("rows");
    offset_before = synchroniser_.clockOffset();
    received_before = synchroniser_.streams().at(0).received;
    synchroniser_.begin(0);
  }

  // Of the episode that the jump ended.
  std::size_t rows_before = 0;
  std::optional<double> offset_before;
  std::size_t received_before = 0;

 private:
  Synchroniser& synchroniser_;
};

/// Joint states every 10 ms whose stamps, receipts and steady clock are chosen apart. The position counts them.
class ClockTest : public ::testing::Test {
 protected:
  /// `stamp_ms` and `receipt_ms` since kToday, `steady_ms` since the machine was started a day ago.
  void joint(double stamp_ms, double receipt_ms, double steady_ms) {
    JointStateSample sample = makeJointState(at(stamp_ms), at(receipt_ms), {"elbow"}, {static_cast<double>(sent_++)});
    sample.arrival.steady = 86'400 * kNanosecondsPerSecond + static_cast<Nanoseconds>(steady_ms * 1e6);
    timeline_.synchroniser.push(sample);
  }
  void joint(double stamp_ms, double receipt_ms) { joint(stamp_ms, receipt_ms, receipt_ms); }

  std::size_t rows() const {
    std::size_t rows = 0;
    for (const auto& episode : timeline_.listener.episodes) rows += episode.rows.size();
    return rows;
  }

  Timeline timeline_{numberStreams({Alignment::hold})};
  int sent_ = 0;
};

}  // namespace demo_logger::testing_support
