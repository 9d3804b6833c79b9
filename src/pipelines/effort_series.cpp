#include "effort_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "demo_logger/trajectory/motion_smoother.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kNeighbours = 4;

/// The polynomial through the known samples among `first` … `first + kNeighbours - 1`, at `instant`.
double interpolate(const std::vector<double>& time, const Eigen::VectorXd& effort, std::size_t first, double instant) {
  const std::size_t last = std::min(first + kNeighbours, time.size());
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    if (std::isnan(effort[static_cast<Index>(i)])) continue;
    double weight = 1.0;
    for (std::size_t j = first; j < last; ++j) {
      if (j != i && !std::isnan(effort[static_cast<Index>(j)])) weight *= (instant - time[j]) / (time[i] - time[j]);
    }
    sum += weight * effort[static_cast<Index>(i)];
  }
  return sum;
}

Eigen::VectorXd shifted(const std::vector<double>& time, const Eigen::VectorXd& effort, double delay) {
  Eigen::VectorXd torque(effort.size());
  for (std::size_t k = 0; k < time.size(); ++k) {
    const auto row = static_cast<Index>(k);
    if (std::isnan(effort[row])) {
      torque[row] = effort[row];
      continue;
    }
    // Two samples before the instant and two after it, the stamp's own among them.
    const double instant = time[k] - delay;
    const auto after = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), instant) - time.begin());
    torque[row] = interpolate(time, effort, after > 2 ? after - 2 : 0, instant);
  }
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
