#include <cmath>

#include "check_parts.h"

namespace demo_logger {
namespace {

struct AgeCounts {
  std::size_t missing = 0;
  std::size_t stale = 0;
  std::size_t future = 0;
  double first_stale = 0.0;   // [s] time of the row
  double first_future = 0.0;  // [s]
  double oldest = 0.0;        // [s] age
  double oldest_at = 0.0;
  double earliest = 0.0;  // [s] most negative age
};

AgeCounts countAges(const Demonstration& demonstration, const StreamColumns& stream, const CheckLimits& limits) {
  AgeCounts counts;
  for (std::size_t row = 0; row < demonstration.time.size(); ++row) {
    const double age = demonstration.values(static_cast<Eigen::Index>(row), stream.age);
    const double time = demonstration.time[row];
    if (std::isnan(age)) {
      ++counts.missing;
      continue;
    }
    if (age > limits.stale_command && counts.stale++ == 0) {
      counts.first_stale = time;
    }
    if (age < 0.0 && counts.future++ == 0) {
      counts.first_future = time;
    }
    if (age > counts.oldest) {
      counts.oldest = age;
      counts.oldest_at = time;
    }
    counts.earliest = std::min(counts.earliest, age);
  }
  return counts;
}

}  // namespace

void checkCommands(const Demonstration& demonstration, const CheckLimits& limits, Findings& findings) {
  const auto rows = static_cast<double>(demonstration.time.size());
  const bool by_hand = demonstration.metadata.channel == "kinesthetic";  // then the hand is the command
  for (const StreamColumns& stream : findStreams(demonstration)) {
    const AgeCounts counts = countAges(demonstration, stream, limits);
    const double missing = static_cast<double>(counts.missing) / rows;
    if (stream.is_command && counts.missing == demonstration.time.size()) {
      if (by_hand) continue;
      findings.add("no_command", Severity::error,
                   "stream " + stream.name +
                       ": no row has a command; was the device off, its topic another one, or its clock far away?");
    } else if (stream.is_command && missing > limits.rows_without_command) {
      findings.add("no_command", Severity::error,
                   "stream " + stream.name + ": " + formatShare(missing) +
                       " of the rows have no command, expected at "
                       "most " +
                       formatShare(limits.rows_without_command) +
                       " before the first; did the recording begin long before the demonstrator?");
    }
    if (stream.is_held && counts.future > 0) {
      findings.add("future_command", Severity::error,
                   "stream " + stream.name + ": a message from the future stands in " +
                       formatCount(counts.future, "row") + ", by up to " + formatDuration(-counts.earliest) +
                       ", first " + formatInstant(counts.first_future) +
                       "; expected ages of 0 s or more. Was the file changed after the recording?");
    }
    if (stream.is_command && counts.stale > 0) {
      const double share = static_cast<double>(counts.stale) / rows;
      findings.add("stale_command", share > limits.tolerated_share ? Severity::error : Severity::warning,
                   "stream " + stream.name + ": " + formatShare(share) + " of the rows hold a command older than " +
                       formatDuration(limits.stale_command) + ", first " + formatInstant(counts.first_stale) +
                       ", the oldest " + formatDuration(counts.oldest) + " " + formatInstant(counts.oldest_at) +
                       "; the device stopped sending while the arm went on.");
    }
  }
}

}  // namespace demo_logger
