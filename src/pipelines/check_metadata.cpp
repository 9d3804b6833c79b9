#include <map>
#include <set>

#include "check_parts.h"

namespace demo_logger {
namespace {

struct Loss {
  const char* what;  // after "counter … is 3, expected 0: "
  Severity severity;
};

// What the recorder's counters mean to those who learn from the file.
const std::map<std::string, Loss>& losses() {
  static const std::map<std::string, Loss> kLosses = {
      {"late_rows",
       {"joint states came after later ones had become rows and are lost; a longer max_wait gives them time.",
        Severity::warning}},
      {"duplicate_rows",
       {"joint states repeated the stamp of another and were left out; does the driver publish each twice?",
        Severity::warning}},
      {"malformed_joint_states",
       {"joint states had arrays that do not fit their names and were dropped.", Severity::warning}},
      {"malformed_stream_messages",
       {"messages of streams did not fit their columns and were dropped.", Severity::warning}},
      {"zero_stamps",
       {"messages lacked the stamp that others of their publisher have, and were dropped.", Severity::warning}},
      {"non_finite_values", {"values were not finite when they came and are NaN.", Severity::warning}},
      {"non_unit_quaternions", {"orientations came with a length other than 1.", Severity::warning}},
      {"unbridged_gaps",
       {"values could not be interpolated, for want of a later message in time, and are NaN.", Severity::warning}},
      {"clock_outliers", {"joint states had a stamp far from their neighbours' and were dropped.", Severity::warning}},
      {"overflow",
       {"messages found the recorder's queue full and are lost; was the machine overloaded?", Severity::error}},
      {"pushed_late", {"messages reached the synchroniser after the rows they belong to.", Severity::warning}},
      {"rows_not_written", {"rows could not be written to the disk and are lost; was it full?", Severity::error}},
      {"infinities_written_as_nan", {"infinite values were written as NaN.", Severity::warning}},
  };
  return kLosses;
}

// No harm in these: the rows themselves, and messages of others on the same topic.
const std::set<std::string>& harmless() {
  static const std::set<std::string> kHarmless = {"rows", "foreign_joint_states", "partial_joint_states"};
  return kHarmless;
}

void checkCounters(const Metadata& metadata, Findings& findings) {
  for (const auto& [name, count] : metadata.counters) {
    if (count == 0 || harmless().count(name) > 0) {
      continue;
    }
    const auto known = losses().find(name);
    const std::string is = "counter " + name + " is " + std::to_string(count);
    if (known == losses().end()) {
      findings.add("counter", Severity::warning, is + ", expected 0.");
    } else {
      findings.add("counter", known->second.severity, is + ", expected 0: " + known->second.what);
    }
  }
}

/// Faults carry the recorder's time, rows that of the joint states. Where the two clocks differ, no instant is better
/// than a wrong one.
std::string instantOf(const Fault& fault, const Metadata& metadata) {
  constexpr double kMargin = 2.0;  // [s] a fault may be noted before the first row and after the last
  const double instant = toSeconds(fault.stamp - metadata.start_stamp);
  const bool during =
      fault.stamp != 0 && metadata.start_stamp != 0 && instant > -kMargin && instant < metadata.duration + kMargin;
  return during ? formatInstant(instant) : "during the recording";
}

void checkStream(const StreamMetadata& stream, Findings& findings) {
  const std::string title = "stream " + stream.name + (stream.topic.empty() ? "" : " (" + stream.topic + ")") + ": ";
  const std::string of = " of " + std::to_string(stream.received) + " messages ";
  if (stream.late > 0) {
    findings.add("stream", Severity::warning,
                 title + std::to_string(stream.late) + of +
                     "came too late for the rows they belong to; a longer max_wait gives them time.");
  }
  if (stream.dropped > 0) {
    findings.add("stream", Severity::warning,
                 title + std::to_string(stream.dropped) + of + "were dropped; the faults say why.");
  }
}

}  // namespace

void checkMetadata(const Metadata& metadata, Findings& findings) {
  if (metadata.status != "complete") {
    findings.add("interrupted", Severity::error,
                 "the recording is " + metadata.status +
                     "; its last moments may be missing, so the task may not have been finished.");
  }
  checkCounters(metadata, findings);
  for (const StreamMetadata& stream : metadata.streams) {
    checkStream(stream, findings);
  }
  for (const Fault& fault : metadata.faults) {
    const bool ends = !fault.what.empty() && (fault.what.back() == '.' || fault.what.back() == '?');
    findings.add("fault", fault.severity,
                 "the recorder noted " + instantOf(fault, metadata) +
                     (fault.count > 1 ? " and " + std::to_string(fault.count - 1) + " times more" : "") + ": " +
                     fault.what + (ends ? "" : "."));
  }
}

}  // namespace demo_logger
