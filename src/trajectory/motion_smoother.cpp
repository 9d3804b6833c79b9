#include "demo_logger/trajectory/motion_smoother.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "random_snap_filter.h"
#include "removed_motion.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kBlocks = 8;           // of a long record, spread over it, tell where T lies
constexpr std::size_t kCoarseBlocks = 4;     // about where
constexpr std::size_t kBlockSamples = 2048;  // each
constexpr double kCoarseStep = 1.6;          // between the T looked at first
constexpr double kFineStep = 1.1;            // to which T is then determined

// How calm the motion is, piece by piece. The T of the whole is that of its lively parts; a shorter one is not looked
// for, as the steps of an encoder in a slow part would be taken for life.
constexpr double kLivelyStep = 1.5;        // between the T looked at
constexpr int kCalmest = 4;                // the last of them, relative to T
constexpr double kPieceTimes = 40.0;       // T, at least, that a piece lasts
constexpr std::size_t kPieceSamples = 64;  // ditto
constexpr double kChange = 1.0;            // of ln T from piece to piece: a usual one

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

/// Finds how T changes along a record: by the likelihood of each piece for some T, and by changes from piece to piece
/// not being large.
class LivelinessSearch {
 public:
  /// `r`: variance of the measurements; `jumps`: that of the acceleration's, over r, or empty.
  LivelinessSearch(const std::vector<double>& time, const Eigen::VectorXd& position, double interval, double T,
                   double r, const Eigen::VectorXd& jumps)
      : time_(time), position_(position), interval_(interval), T_(T), r_(r), jumps_(jumps) {}

  /// The factor on the snap density before each sample; empty: the record is too short, or free of noise.
  std::vector<double> search() const {
    const auto lasting = static_cast<std::size_t>(kPieceTimes * T_ / interval_);
    const std::size_t samples = std::max(kPieceSamples, lasting);
    const std::size_t count = (time_.size() + samples - 1) / samples;
    if (count < 3 || !(r_ > 0.0)) return {};
    Eigen::MatrixXd likelihood(kSteps, count);
    for (int step = 0; step < kSteps; ++step) {
      const double T = T_ * std::pow(kLivelyStep, step);
      RandomSnapFilter filter(time_, position_, interval_, T);
      filter.setJumps(std::pow(T, 4) * jumps_);
      const std::vector<double> pieces = filter.pieceLogLikelihoods(samples, r_);
      likelihood.row(step) = Eigen::Map<const Eigen::RowVectorXd>(pieces.data(), static_cast<Index>(count));
    }
    return interpolated(mostLikely(likelihood), samples);
  }

 private:
  static constexpr int kSteps = kCalmest + 1;

  /// Of ln(T / T_) in each piece: Viterbi's path over the steps, then the vertex of the parabola around it.
  static std::vector<double> mostLikely(const Eigen::MatrixXd& likelihood) {
    const double change = std::log(kLivelyStep) / kChange;
    Eigen::MatrixXd best = likelihood;  // log-probability of the best path that ends there
    Eigen::MatrixXi from = Eigen::MatrixXi::Zero(likelihood.rows(), likelihood.cols());
    for (Index piece = 1; piece < likelihood.cols(); ++piece) {
      for (Index step = 0; step < kSteps; ++step) {
        double most = -std::numeric_limits<double>::infinity();
        for (Index last = 0; last < kSteps; ++last) {
          const double jump = change * static_cast<double>(step - last);
          const double probability = best(last, piece - 1) - 0.5 * jump * jump;
          if (probability <= most) continue;
          most = probability;
          from(step, piece) = static_cast<int>(last);
        }
        best(step, piece) += most;
      }
    }
    std::vector<double> path(static_cast<std::size_t>(likelihood.cols()));
    Index step = 0;
    best.rightCols<1>().maxCoeff(&step);
    for (Index piece = likelihood.cols() - 1; piece >= 0; --piece) {
      const double there = static_cast<double>(step) + vertex(likelihood.col(piece), step);
      path[static_cast<std::size_t>(piece)] = std::log(kLivelyStep) * there;
      step = from(step, piece);
    }
    return beforeItBegins(path);
  }

  /// Life that begins or ends within a piece is in its neighbour already: each takes the shortest T around it.
  static std::vector<double> beforeItBegins(const std::vector<double>& path) {
    std::vector<double> safe = path;
    for (std::size_t piece = 0; piece < path.size(); ++piece) {
      if (piece > 0) safe[piece] = std::min(safe[piece], path[piece - 1]);
      if (piece + 1 < path.size()) safe[piece] = std::min(safe[piece], path[piece + 1]);
    }
    return safe;
  }

  /// Of the parabola through a value and its neighbours, in steps from it.
  static double vertex(const Eigen::VectorXd& values, Index at) {
    if (at == 0 || at + 1 == values.size()) return 0.0;
    const double curvature = values[at - 1] - 2.0 * values[at] + values[at + 1];
    return curvature < 0.0 ? std::clamp(0.5 * (values[at - 1] - values[at + 1]) / curvature, -0.5, 0.5) : 0.0;
  }

  /// From the middle of a piece to that of the next in a straight line of ln T; S goes with T⁻⁸.
  std::vector<double> interpolated(const std::vector<double>& path, std::size_t samples) const {
    std::vector<double> factors(time_.size());
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const double there = std::max(0.0, (static_cast<double>(k) + 0.5) / static_cast<double>(samples) - 0.5);
      const auto piece = std::min(static_cast<std::size_t>(there), path.size() - 2);
      const double share = std::min(1.0, there - static_cast<double>(piece));
      factors[k] = std::exp(-8.0 * ((1.0 - share) * path[piece] + share * path[piece + 1]));
    }
    return factors;
  }

  const std::vector<double>& time_;
  const Eigen::VectorXd& position_;
  const double interval_;
  const double T_;
  const double r_;
  const Eigen::VectorXd& jumps_;
};

/// With a T that is known, and r about so. `jump_variance` may be empty.
SmoothedMotion smoothed(const std::vector<double>& time, const Eigen::VectorXd& position, double interval, double T,
                        const Eigen::VectorXd& jump_variance, double about_r, JumpEvidence* evidence) {
  const auto scaled = [&](double r) -> Eigen::VectorXd {
    constexpr double kAnything = 1e10;  // in units of r/T⁴: more makes no difference
    return (std::pow(T, 4) / r * jump_variance).cwiseMin(kAnything);
  };
  RandomSnapFilter uniform(time, position, interval, T);
  uniform.setJumps(scaled(about_r));
  uniform.run(0, time.size());
  const double r = uniform.variance();
  const Eigen::VectorXd over_r = std::pow(T, -4) * scaled(r);
  RandomSnapFilter filter(time, position, interval, T);
  const std::vector<double> liveliness = LivelinessSearch(time, position, interval, T, r, over_r).search();
  filter.setLiveliness(liveliness);
  filter.setJumps(scaled(r));
  SmoothedMotion motion = filter.smooth(r, evidence);
  addRemovedMotion(time, position, interval, liveliness, motion);
  return motion;
}

SmoothedMotion smoothed(const std::vector<double>& time, const Eigen::VectorXd& position, JumpEvidence* evidence) {
  require(time, position);
  const double interval = usualInterval(time);
  const double T = TimeConstantSearch(time, position, interval).search();
  return smoothed(time, position, interval, T, Eigen::VectorXd(), /*about_r=*/1.0, evidence);
}

}  // namespace

SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position) {
  return smoothed(time, position, nullptr);
}

SmoothedMotion smoothMotion(const std::vector<double>& time, const Eigen::VectorXd& position, JumpEvidence& evidence) {
  return smoothed(time, position, &evidence);
}

SmoothedMotion smoothMotionAgain(const std::vector<double>& time, const Eigen::VectorXd& position,
                                 const SmoothedMotion& before, const Eigen::VectorXd& jump_variance) {
  require(time, position);
  if (jump_variance.size() != position.size()) {
    throw Error("smoothing: there are " + std::to_string(jump_variance.size()) + " variances of jumps for " +
                std::to_string(position.size()) + " positions, expected as many.");
  }
  for (Index k = 0; k < jump_variance.size(); ++k) {
    if (std::isfinite(jump_variance[k]) && jump_variance[k] >= 0.0) continue;
    throw Error("smoothing: the variance of the jump before sample " + std::to_string(k) + " is " +
                print(jump_variance[k]) + ", expected a number of at least 0.");
  }
  const double r = std::pow(before.measurement_deviation, 2);
  if (!(r > 0.0)) return before;
  return smoothed(time, position, usualInterval(time), before.time_constant, jump_variance, r, nullptr);
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
