#include "demo_logger/trajectory/motion_smoother.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "random_snap_filter.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kBlocks = 8;           // of a long record, spread over it, tell where T lies
constexpr std::size_t kCoarseBlocks = 4;     // about where
constexpr std::size_t kBlockSamples = 2048;  // each
constexpr double kCoarseStep = 1.6;          // between the T looked at first
constexpr double kFineStep = 1.02;           // to which T is then determined

void require(const std::vector<double>& time, const Eigen::VectorXd& position) {
  if (position.size() != static_cast<Index>(time.size())) {
    throw Error("smoothing: there are " + std::to_string(time.size()) + " times for " +
                std::to_string(position.size()) + " positions, expected as many.");
  }
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (std::isfinite(time[k]) && (k == 0 || time[k] > time[k - 1])) continue;
    throw Error("smoothing: time " + print(time[k], 6) + " s of sample " + std::to_string(k) +
                " is not finite or does not follow the one before, expected increasing times.");
  }
  Index measured = 0;
  for (Index k = 0; k < position.size(); ++k) {
    if (std::isinf(position[k])) {
      throw Error("smoothing: position " + std::to_string(k) +
                  " is infinite, expected a number, or NaN where it is "
                  "missing.");
    }
    if (!std::isnan(position[k])) ++measured;
  }
  if (measured < kFewestSamples) {
    throw Error("smoothing: " + std::to_string(measured) + " positions were measured, expected at least " +
                std::to_string(kFewestSamples) + " to tell an acceleration from noise.");
  }
}

double usualInterval(const std::vector<double>& time) {
  std::vector<double> intervals;
  intervals.reserve(time.size());
  for (std::size_t k = 1; k < time.size(); ++k) intervals.push_back(time[k] - time[k - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// Finds the T that makes the record most likely.
class TimeConstantSearch {
 public:
  TimeConstantSearch(const std::vector<double>& time, const Eigen::VectorXd& position, double interval)
      : time_(time), position_(position), interval_(interval) {}

  double search() const {
    // Faster than the samples nothing can be told from noise; slower than the record it is a cubic.
    const double shortest = 0.5 * interval_;
    const double longest = std::max(2.0 * (time_.back() - time_.front()), 2.0 * shortest);
    double best = shortest;
    double most = -std::numeric_limits<double>::infinity();
    const int last = static_cast<int>(std::log(longest / shortest) / std::log(kCoarseStep));
    for (int i = 0; i <= last; ++i) {
      const double T = shortest * std::pow(kCoarseStep, i);
      const double likelihood = logLikelihood(T, kCoarseBlocks);
      if (likelihood > most) {
        most = likelihood;
        best = T;
      }
    }
    return refine(std::max(shortest, best / kCoarseStep), best * kCoarseStep);
  }

 private:
  double logLikelihood(double T, std::size_t blocks) const {
    RandomSnapFilter filter(time_, position_, interval_, T);
    const std::size_t count = time_.size();
    if (count <= blocks * kBlockSamples) {
      filter.run(0, count);
    } else {
      for (std::size_t block = 0; block < blocks; ++block) {
        const std::size_t first = block * (count - kBlockSamples) / (blocks - 1);
        filter.run(first, first + kBlockSamples);
      }
    }
    const double likelihood = filter.logLikelihood();
    return std::isnan(likelihood) ? -std::numeric_limits<double>::infinity() : likelihood;
  }

  /// The golden section of ln T.
  double refine(double lower, double upper) const {
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double a = std::log(lower);
    double b = std::log(upper);
    double c = b - golden * (b - a);
    double d = a + golden * (b - a);
    double at_c = logLikelihood(std::exp(c), kBlocks);
    double at_d = logLikelihood(std::exp(d), kBlocks);
    while (b - a > std::log(kFineStep)) {
      if (at_c >= at_d) {
        b = d;
        d = c;
        at_d = at_c;
        c = b - golden * (b - a);
        at_c = logLikelihood(std::exp(c), kBlocks);
      } else {
        a = c;
        c = d;
        at_c = at_d;
        d = a + golden * (b - a);
        at_d = logLikelihood(std::exp(d), kBlocks);
      }
    }
    return std::exp(0.5 * (a + b));
  }

  const std::vector<double>& time_;
  const Eigen::VectorXd& position_;
  const double interval_;
};

}  // namespace

SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position) {
  require(time, position);
  const double interval = usualInterval(time);
  const double T = TimeConstantSearch(time, position, interval).search();
  return RandomSnapFilter(time, position, interval, T).smooth();
}

SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position, double time_constant) {
  require(time, position);
  if (!(time_constant > 0.0) || !std::isfinite(time_constant)) {
    throw ConfigurationError("smoothing: the time constant is " + print(time_constant) +
                             " s, expected a positive number.");
  }
  return RandomSnapFilter(time, position, usualInterval(time), time_constant).smooth();
}

}  // namespace demo_logger
