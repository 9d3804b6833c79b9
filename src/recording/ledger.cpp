#include "ledger.h"

namespace demo_logger {
namespace {

constexpr std::array<const char*, kCounters> kCounterNames = {"rows",
                                                              "late_rows",
                                                              "duplicate_rows",
                                                              "partial_joint_states",
                                                              "foreign_joint_states",
                                                              "malformed_joint_states",
                                                              "malformed_stream_messages",
                                                              "zero_stamps",
                                                              "non_finite_values",
                                                              "non_unit_quaternions",
                                                              "gaps",
                                                              "unbridged_gaps",
                                                              "clock_outliers",
                                                              "overflow",
                                                              "pushed_late"};

}  // namespace

void Ledger::clear() {
  counts_.fill(0);
  places_.clear();
  faults_.clear();
}

std::map<std::string, std::uint64_t> Ledger::counters() const {
  std::map<std::string, std::uint64_t> counters;
  for (std::size_t i = 0; i < kCounters; ++i) counters[kCounterNames[i]] = counts_[i];
  return counters;
}

}  // namespace demo_logger
