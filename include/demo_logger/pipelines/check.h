#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// What counts as worth a finding. The defaults suit arms recorded at 10 Hz to 1 kHz.
struct CheckLimits {
  double gap_factor = 5.0;            // a gap: this many median periods between two rows
  double long_gap = 0.1;              // [s] a gap beyond this is an error
  double stale_command = 0.5;         // [s] a command older than this may no longer be meant
  double tolerated_share = 0.01;      // of rows: below it a defect is a warning, above it an error
  double rows_without_command = 0.1;  // share that is usual before a demonstrator begins
  double usual_receipt_delay = 0.1;   // [s] from stamp to receipt
  double frozen = 0.1;                // [s] equal positions for longer, in motion, are a stuck sensor
  double still_speed = 0.01;          // [rad/s, m/s] below it a joint counts as standing
  double joint_speed = 0.5;           // [rad/s, m/s] by which a joint may exceed twice its stated velocity
  double stamp_slack = 0.005;         // [s] by which samples may be older than their stamps
  double quaternion_length = 1e-3;    // by which it may differ from 1
  std::size_t shown = 3;              // findings of one kind told one by one
};

struct Spread {
  double min = 0.0;
  double median = 0.0;
  double max = 0.0;
};

/// The figures of a recording.
struct CheckSummary {
  std::size_t rows = 0;
  double duration = 0.0;                  // [s]
  double mean_rate = 0.0;                 // [Hz]
  double median_period = 0.0;             // [s]
  double largest_gap = 0.0;               // [s]
  double largest_gap_at = 0.0;            // [s] the row before it
  std::map<std::string, Spread> ages;     // [s] per `<stream>_age` that has values
  std::optional<Spread> receipt_delay;    // [s]
  std::map<std::string, double> missing;  // share of NaN, per column that has any
};

/// Something wrong or remarkable, as a sentence: which column or stream, when [s], how much, what was expected, and
/// the likely cause. An error should keep the demonstration from being learnt from until someone has looked.
struct Finding {
  std::string kind;  // gap, rate, receipt_delay, no_command, stale_command, future_command, missing_values, no_values,
                     // no_velocity, repeated_rows, frozen, jump, quaternion, interrupted, counter, stream, fault
  Severity severity = Severity::warning;
  std::string sentence;
};

struct CheckResult {
  CheckSummary summary;
  std::vector<Finding> findings;  // in the order of the kinds above, the first few of each
};

/// Looks at a recording as one should before anybody learns from it.
CheckResult check(const Demonstration& demonstration, const CheckLimits& limits = {});

/// Whether any finding is an error.
bool hasErrors(const CheckResult& result);

}  // namespace demo_logger
