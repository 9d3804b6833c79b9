#include <algorithm>
#include <cmath>

#include "check_parts.h"

namespace demo_logger {
namespace {

constexpr const char* kAge = "_age";

bool endsWith(const std::string& name, const std::string& suffix) {
  return name.size() >= suffix.size() && name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0;
}

double medianOf(std::vector<double>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  if (numbers.size() % 2 == 1) {
    return *middle;
  }
  return 0.5 * (*middle + *std::max_element(numbers.begin(), middle));
}

// "hold" as the sidecar says it; where it says nothing, as the columns do.
bool isHeld(const Demonstration& demonstration, const StreamColumns& stream) {
  const std::string name = stream.name == "u" ? "teleop_cmd" : stream.name;
  for (const StreamMetadata& metadata : demonstration.metadata.streams) {
    if (metadata.name == name && !metadata.align.empty()) {
      return metadata.align == "hold";
    }
  }
  return !stream.values.empty() && std::all_of(stream.values.begin(), stream.values.end(), [&](Eigen::Index column) {
    return demonstration.columns[static_cast<std::size_t>(column)].interpolation == Interpolation::hold;
  });
}

}  // namespace

std::vector<StreamColumns> findStreams(const Demonstration& demonstration) {
  std::vector<StreamColumns> streams;
  const auto& columns = demonstration.columns;
  for (std::size_t age = 0; age < columns.size(); ++age) {
    if (!endsWith(columns[age].name, kAge)) {
      continue;
    }
    StreamColumns stream;
    stream.age = static_cast<Eigen::Index>(age);
    stream.name = columns[age].name.substr(0, columns[age].name.size() - std::string(kAge).size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (i != age && columns[i].name.rfind(stream.name + "_", 0) == 0) {
        stream.values.push_back(static_cast<Eigen::Index>(i));
        stream.is_command = stream.is_command || columns[i].role == Role::control;
      }
    }
    stream.is_held = isHeld(demonstration, stream);
    streams.push_back(stream);
  }
  return streams;
}

std::optional<Spread> spreadOf(const Demonstration::Values& values, Eigen::Index column) {
  std::vector<double> present;
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    if (std::isfinite(values(row, column))) {
      present.push_back(values(row, column));
    }
  }
  if (present.empty()) {
    return std::nullopt;
  }
  const auto [min, max] = std::minmax_element(present.begin(), present.end());
  Spread spread{*min, 0.0, *max};
  spread.median = medianOf(present);
  return spread;
}

CheckSummary summarise(const Demonstration& demonstration) {
  CheckSummary summary;
  const std::vector<double>& time = demonstration.time;
  summary.rows = time.size();
  std::vector<double> periods;
  for (std::size_t i = 1; i < time.size(); ++i) {
    periods.push_back(time[i] - time[i - 1]);
    if (periods.back() > summary.largest_gap) {
      summary.largest_gap = periods.back();
      summary.largest_gap_at = time[i - 1];
    }
  }
  if (!periods.empty()) {
    summary.duration = time.back() - time.front();
    summary.mean_rate = static_cast<double>(periods.size()) / summary.duration;
    summary.median_period = medianOf(periods);
  }
  for (std::size_t i = 0; i < demonstration.columns.size(); ++i) {
    const std::string& name = demonstration.columns[i].name;
    const auto column = static_cast<Eigen::Index>(i);
    const auto missing = demonstration.values.col(column).array().isNaN().count();
    if (missing > 0) {
      summary.missing[name] = static_cast<double>(missing) / static_cast<double>(demonstration.values.rows());
    }
    if (name == "receipt_delay") {
      summary.receipt_delay = spreadOf(demonstration.values, column);
    } else if (endsWith(name, kAge)) {
      if (const auto spread = spreadOf(demonstration.values, column)) {
        summary.ages[name] = *spread;
      }
    }
  }
  return summary;
}

}  // namespace demo_logger
