#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// The stamps of rows whose values are decided, to tell which messages came too late for them.
class DecidedRows {
 public:
  static constexpr std::size_t kCapacity = 65536;  // the newest are kept

  void add(Nanoseconds stamp);
  bool contains(Nanoseconds stamp) const;
  bool anyWithin(Nanoseconds begin, Nanoseconds end) const;  // begin included, end not
  void prune(Nanoseconds horizon);
  void clear() { stamps_.clear(); }

 private:
  std::deque<Nanoseconds> stamps_;  // ascending
};

/// A row between its joint state and its release.
struct PendingRow {
  Row row;
  Nanoseconds received = 0;  // as it counts, on the clock of `clock_setting`
  std::uint64_t clock_setting = 0;
  Nanoseconds deadline = 0;                  // what is received until then belongs to it
  bool decided = false;                      // its values no longer change
  std::vector<std::vector<double>> streams;  // values of each stream where the row was decided before the columns were
};

/// Rows that wait: decided in the order of their receipt, released in the order of their stamps.
class RowQueue {
 public:
  enum class Admission {
    admitted,
    duplicate,  // of a row that waits or was released
    late,       // a row with a later stamp was released already
  };
  Admission admit(PendingRow row);

  /// The row whose turn it is to be decided, or nullptr.
  PendingRow* nextToDecide();
  /// The row whose turn it is to be released, or nullptr.
  PendingRow* first();
  void decided(PendingRow& row);
  /// Removes first() for its release.
  PendingRow release();

  template <typename Condition>
  void removeIf(const Condition& condition) {
    for (auto row = rows_.begin(); row != rows_.end();) row = condition(row->second) ? rows_.erase(row) : ++row;
  }
  void forget(Nanoseconds horizon) { decided_.prune(horizon); }
  /// Begins anew: no row waits, none was released.
  void clear();

  const DecidedRows& decidedRows() const { return decided_; }
  std::size_t size() const { return rows_.size(); }

 private:
  std::map<Nanoseconds, PendingRow> rows_;
  std::deque<Nanoseconds> by_receipt_;  // stamps of rows to decide, and of some that are gone
  DecidedRows decided_;
  bool any_released_ = false;
  Nanoseconds last_released_ = 0;
};

}  // namespace demo_logger
