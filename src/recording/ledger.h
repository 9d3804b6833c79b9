#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// What is counted; the names under which the sidecar shows them stand in ledger.cpp, in this order.
enum class Counter {
  rows,
  late_rows,
  duplicate_rows,
  partial_joint_states,
  foreign_joint_states,
  malformed_joint_states,
  malformed_stream_messages,
  zero_stamps,
  non_finite_values,
  non_unit_quaternions,
  gaps,
  unbridged_gaps,
  clock_outliers,
  overflow,
  pushed_late,
};
constexpr std::size_t kCounters = static_cast<std::size_t>(Counter::pushed_late) + 1;

/// The kinds of faults. Each is told once per subject (a stream's index, or kJointStatesSubject), then only counted.
enum class FaultKind {
  clock_offset,
  distant_clock,
  clock_outlier,
  other_joints,
  partial_joint_state,
  foreign_joint_state,
  malformed_message,
  names_changed,
  frame_changed,
  two_publishers,
  unstamped,
  zero_stamp,
  non_finite_value,
  non_finite_joint,
  non_unit_quaternion,
  out_of_order,
  late_row,
  gap,
  unbridged,
  unbridged_joint,
  left_out,
  overflow,
  pushed_late,
};
constexpr std::size_t kJointStatesSubject = static_cast<std::size_t>(-1);

/// The counters and faults of one episode. Nothing that happens is left out; memory is bounded, since there are few
/// kinds and subjects.
class Ledger {
 public:
  void count(Counter counter, std::uint64_t times = 1) { counts_[static_cast<std::size_t>(counter)] += times; }

  /// `sentence` is called only the first time, so it may be costly.
  template <typename Sentence>
  void report(FaultKind kind, std::size_t subject, Nanoseconds stamp, const Sentence& sentence,
              Severity severity = Severity::warning) {
    const auto known = places_.find({kind, subject});
    if (known != places_.end()) {
      ++faults_[known->second].count;
      return;
    }
    places_.emplace(std::make_pair(kind, subject), faults_.size());
    faults_.push_back(Fault{stamp, sentence(), 1, severity});
  }

  void clear();

  std::map<std::string, std::uint64_t> counters() const;
  const std::vector<Fault>& faults() const { return faults_; }  // in the order in which they were first seen

 private:
  std::array<std::uint64_t, kCounters> counts_{};
  std::map<std::pair<FaultKind, std::size_t>, std::size_t> places_;  // in faults_
  std::vector<Fault> faults_;
};

}  // namespace demo_logger
