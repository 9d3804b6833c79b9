#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clock_offset.h"
#include "demo_logger/recording/clock_watch.h"
#include "demo_logger/recording/synchroniser.h"
#include "inbox.h"
#include "joint_states.h"
#include "ledger.h"
#include "recorded_stream.h"
#include "row_pacing.h"
#include "row_queue.h"

namespace demo_logger {

/// Looks at the messages one by one in the order of the inbox, and makes the rows. It knows no other time than that of
/// the messages and of passTime().
///
/// An episode is begun (begin), started (its request lies in the past), opened (its columns are fixed), and ended.
class Sequencer {
 public:
  /// Rows that wait at most; beyond, the oldest is decided with what is there.
  static constexpr std::size_t kMostPendingRows = 65536;

  explicit Sequencer(const SynchroniserConfiguration& configuration);

  void process(Message message, RowListener& listener);
  /// Everything received at or before `now` has been processed.
  void passTime(Nanoseconds now, RowListener& listener);
  /// The clock of the receipts was set back: what waits for receipts of the old setting has waited enough.
  void restartReceiptClock(RowListener& listener);

  void begin(Nanoseconds request);
  bool isBegun() const { return request_.has_value(); }
  /// Everything received until `request` has been processed.
  void end(Nanoseconds request, RowListener& listener);

  /// Messages must not be processed before the clock offset is known.
  bool needsClockOffset() const { return configuration_.correct_clock_offset && !offset_.value(); }
  const ClockOffset& offset() const { return offset_; }
  /// Freezes `offset`, the present one with samples of what is yet to be processed.
  void setOffset(ClockOffset offset, Nanoseconds now);

  const Ledger& ledger() const { return ledger_; }
  const JointStates& jointStates() const { return joint_states_; }
  std::vector<StreamMetadata> streams() const;
  std::vector<Fault> faults() const;
  const std::map<std::string, std::string>& originalNames() const { return original_names_; }
  std::size_t size() const;

 private:
  struct Request {
    Nanoseconds receipt;
    std::uint64_t clock_setting;
  };

  void freezeOffset(Nanoseconds now);
  void startIfReached(Nanoseconds now);
  void resetEpisode();

  void processStream(Message& message, const Reception& reception);
  void processJointState(Message& message, const Reception& reception, RowListener& listener);
  void accept(JointRow row, RowListener& listener);
  void admit(JointRow row, RowListener& listener);
  void dropSuspect();
  void followJump(JointRow row, RowListener& listener);

  void decide(PendingRow& row);
  void decideAll();
  void decideEarly();
  /// Gives the listener what is final; `open_now` without waiting for the columns of further streams.
  void release(RowListener& listener, bool open_now = false);
  bool mayOpen() const;
  void open(RowListener& listener);
  void close();
  void appendStreams(PendingRow& row) const;
  void prune();

  const SynchroniserConfiguration configuration_;
  const Nanoseconds wait_;  // after the receipt of a joint state, for the messages of its row
  const Nanoseconds wait_for_streams_;
  bool all_in_order_;

  Ledger ledger_;
  JointStates joint_states_;
  std::vector<RecordedStream> streams_;
  ClockWatch clock_watch_;
  ClockOffset offset_;
  Nanoseconds offset_frozen_at_ = 0;
  std::optional<JointRow> suspect_;
  RowQueue rows_;
  RowPacing pacing_;  // of the rows that were released

  std::uint64_t sequence_ = 0;
  std::uint64_t clock_setting_ = 0;  // of the receipts
  std::uint64_t episode_ = 0;
  Nanoseconds now_ = 0;
  Nanoseconds pruned_to_;

  std::optional<Request> request_;
  bool started_ = false;
  bool opened_ = false;
  std::optional<Nanoseconds> open_at_;  // at the latest; set by the first row
  std::size_t width_ = 0;               // of a row
  std::map<std::string, std::string> original_names_;
};

}  // namespace demo_logger
