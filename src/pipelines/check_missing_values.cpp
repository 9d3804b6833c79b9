#include <cmath>

#include "check_parts.h"

namespace demo_logger {
namespace {

// Rows of a stream's column count only where the stream had a message: before the first there is nothing to miss.
std::vector<Eigen::Index> ageOfEachColumn(const Demonstration& demonstration) {
  std::vector<Eigen::Index> age(demonstration.columns.size(), -1);
  for (const StreamColumns& stream : findStreams(demonstration)) {
    age[static_cast<std::size_t>(stream.age)] = stream.age;
    for (const Eigen::Index column : stream.values) {
      age[static_cast<std::size_t>(column)] = stream.age;
    }
  }
  return age;
}

/// The first row with a value that could be there: an observer has to settle.
std::size_t firstRow(const Demonstration& demonstration, std::size_t column) {
  if (demonstration.columns[column].name.rfind("tau_h_", 0) != 0) return 0;
  std::size_t row = 0;
  const auto isMissing = [&](std::size_t at) {
    return std::isnan(demonstration.values(static_cast<Eigen::Index>(at), static_cast<Eigen::Index>(column)));
  };
  while (row < demonstration.time.size() && isMissing(row)) ++row;
  return row < demonstration.time.size() ? row : 0;
}

}  // namespace

void checkMissingValues(const Demonstration& demonstration, const CheckLimits& limits, Findings& findings) {
  const std::vector<Eigen::Index> age = ageOfEachColumn(demonstration);
  std::vector<std::string> without_values;
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    const Column& column = demonstration.columns[i];
    std::size_t expected = 0;
    std::size_t missing = 0;
    double first = 0.0;
    for (std::size_t row = firstRow(demonstration, i); row < demonstration.time.size(); ++row) {
      const auto index = static_cast<Eigen::Index>(row);
      if (age[i] >= 0 && std::isnan(demonstration.values(index, age[i]))) {
        continue;
      }
      ++expected;
      if (std::isnan(demonstration.values(index, static_cast<Eigen::Index>(i))) && missing++ == 0) {
        first = demonstration.time[row];
      }
    }
    if (missing == 0) {
      continue;
    }
    const bool is_needed = column.role != Role::auxiliary;
    if (missing == expected) {
      if (is_needed) {  // an arm without torque sensors is no finding
        without_values.push_back(column.name);
      }
      continue;
    }
    const double share = static_cast<double>(missing) / static_cast<double>(expected);
    findings.add("missing_values", is_needed && share > limits.tolerated_share ? Severity::error : Severity::warning,
                 "column " + column.name + " is missing in " + formatCount(missing, "row") + " (" + formatShare(share) +
                     "), first " + formatInstant(first) +
                     ", expected a value in each; messages were lost, came too late, or carried NaN.");
  }
  if (!without_values.empty()) {
    findings.add("no_values", Severity::warning,
                 "no row has a value of " + formatNames(without_values) +
                     ", expected some in a state or control; the robot or device does not send them. Leave the columns "
                     "out, or derive them.");
  }
}

}  // namespace demo_logger
