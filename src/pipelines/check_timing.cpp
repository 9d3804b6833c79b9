#include <cmath>

#include "check_parts.h"

namespace demo_logger {
namespace {

void checkGaps(const Demonstration& demonstration, const CheckSummary& summary, const CheckLimits& limits,
               Findings& findings) {
  const std::vector<double>& time = demonstration.time;
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double gap = time[i] - time[i - 1];
    if (gap > limits.gap_factor * summary.median_period) {
      findings.add("gap", gap > limits.long_gap ? Severity::error : Severity::warning,
                   "no rows for " + formatDuration(gap) + " " + formatInstant(time[i - 1]) + ", expected one every " +
                       formatDuration(summary.median_period) +
                       "; joint states were lost on the way, or the arm's driver paused.");
    }
  }
}

void checkReceiptDelay(const Demonstration& demonstration, const CheckSummary& summary, const CheckLimits& limits,
                       Findings& findings) {
  if (!summary.receipt_delay) {
    return;
  }
  const Spread& delay = *summary.receipt_delay;
  if (delay.median < -0.2 * limits.usual_receipt_delay || delay.median > limits.usual_receipt_delay) {
    findings.add("receipt_delay", Severity::warning,
                 "joint states reached the recorder " + formatDuration(std::abs(delay.median)) +
                     (delay.median < 0 ? " before" : " after") + " their stamps (median), expected from -" +
                     formatDuration(0.2 * limits.usual_receipt_delay) + " to " +
                     formatDuration(limits.usual_receipt_delay) +
                     "; the clocks of the two machines differ, or the driver stamps late or early.");
    return;
  }
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    if (demonstration.columns[i].name != "receipt_delay") {
      continue;
    }
    const auto column = demonstration.values.col(static_cast<Eigen::Index>(i));
    const auto late = (column.array() > delay.median + limits.usual_receipt_delay).count();
    if (late > 0) {
      findings.add("receipt_delay", Severity::warning,
                   formatCount(static_cast<std::size_t>(late), "joint state") + " came more than " +
                       formatDuration(limits.usual_receipt_delay) + " later than the usual " +
                       formatDuration(delay.median) + ", up to " + formatDuration(delay.max) +
                       "; the network or this machine was busy, so commands from that time may be missing.");
    }
  }
}

}  // namespace

void checkTiming(const Demonstration& demonstration, const CheckSummary& summary, const CheckLimits& limits,
                 Findings& findings) {
  if (summary.rows < 2) {
    findings.add("rate", Severity::error,
                 "the recording has " + formatCount(summary.rows, "row") +
                     ", expected at least two; was it stopped at once, or does the arm publish nothing?");
    return;
  }
  checkGaps(demonstration, summary, limits, findings);
  checkReceiptDelay(demonstration, summary, limits, findings);
}

}  // namespace demo_logger
