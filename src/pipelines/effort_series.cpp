#include "effort_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kNeighbours = 4;

/// The samples of a series that are known.
struct KnownSamples {
  std::vector<double> time;
  std::vector<double> effort;
  std::vector<std::size_t> row;
};

KnownSamples knownOf(const std::vector<double>& time, const Eigen::VectorXd& effort) {
  KnownSamples known;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double value = effort[static_cast<Index>(k)];
    if (std::isnan(value)) continue;
    known.time.push_back(time[k]);
    known.effort.push_back(value);
    known.row.push_back(k);
  }
  return known;
}

/// The polynomial through the samples [first, last), at `instant`.
double polynomial(const KnownSamples& known, std::size_t first, std::size_t last, double instant) {
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < last; ++j) {
      if (j != i) weight *= (instant - known.time[j]) / (known.time[i] - known.time[j]);
    }
    sum += weight * known.effort[i];
  }
  return sum;
}

/// At an instant that is not after the last of them.
double interpolate(const KnownSamples& known, double instant) {
  const auto found = std::upper_bound(known.time.begin(), known.time.end(), instant);
  const auto after = static_cast<std::size_t>(found - known.time.begin());
  if (after == 0) return known.effort.front();
  if (after == known.time.size()) return known.effort.back();
  if (known.row[after] > known.row[after - 1] + 1) return polynomial(known, after - 1, after + 1, instant);
  const std::size_t first = after > 2 ? after - 2 : 0;
  return polynomial(known, first, std::min(first + kNeighbours, known.time.size()), instant);
}

Eigen::VectorXd shifted(const std::vector<double>& time, const Eigen::VectorXd& effort, double delay) {
  const KnownSamples known = knownOf(time, effort);
  Eigen::VectorXd torque = effort;  // NaN where that is
  for (const std::size_t row : known.row) torque[static_cast<Index>(row)] = interpolate(known, time[row] - delay);
  return torque;
}

}  // namespace

EffortSeries torqueAtStamps(const std::vector<double>& time, const Eigen::VectorXd& effort,
                            const EffortMetadata& meaning) {
  if (meaning.timing == "held") {
    return {shifted(time, effort, 0.5 * meaning.control_period), Eigen::VectorXd::Zero(effort.size())};
  }
  EffortSeries series{effort, Eigen::VectorXd::Zero(effort.size())};
  const Index known = (effort.array() == effort.array()).count();
  if (known < kFewestSamples) return series;
  const SmoothedMotion smooth = smoothMotion(time, effort);
  for (Index k = 0; k < effort.size(); ++k) {
    if (std::isnan(effort[k])) continue;
    series.torque[k] = smooth.position[k];
    series.variance[k] = smooth.covariance[static_cast<std::size_t>(k)](0, 0);
  }
  return series;
}

}  // namespace demo_logger
