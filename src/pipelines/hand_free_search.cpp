#include "hand_free_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "demo_logger/trajectory/not_a_number.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kWindow = 0.25;                             // [s]
constexpr std::array<std::size_t, 2> kSeedWindows = {8, 4};  // a stretch to start from; a shorter one if none is free
constexpr std::size_t kMostSeeds = 60;                       // spread over the recordings
constexpr std::size_t kShortestRun = 3;  // windows; a hand that passes through its own mean is not away
constexpr int kMostRounds = 15;
constexpr int kTightenings = 3;
constexpr double kUsual = 3.0;     // times the usual residual still counts as usual
constexpr double kTightest = 0.3;  // of the tolerance; no model is so good that a hand's touch could be less

struct Window {
  Index first;
  Index last;  // rows [first, last)
  std::size_t range;
  std::vector<JointSums> sums;  // by joint
};

std::vector<Window> windowsOf(const TorqueEquations& equations, const TorqueRegression& regression) {
  std::vector<Window> windows;
  for (Index k = 0; k < regression.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    const bool continues =
        !windows.empty() && windows.back().range == equations.range[row] &&
        equations.time[row] - equations.time[static_cast<std::size_t>(windows.back().first)] < kWindow;
    if (!continues) {
      windows.push_back(
          {k, k, equations.range[row],
           std::vector<JointSums>(static_cast<std::size_t>(regression.joints), JointSums(regression.inertial.cols()))});
    }
    Window& window = windows.back();
    window.last = k + 1;
    for (Index i = 0; i < regression.joints; ++i) window.sums[static_cast<std::size_t>(i)].add(regression, k, i);
  }
  return windows;
}

class Search {
 public:
  Search(const TorqueRegression& regression, std::vector<Window> windows, HandFreeTolerance tolerance,
         const Prior& prior)
      : regression_(regression),
        windows_(std::move(windows)),
        tolerance_(std::move(tolerance)),
        least_(kTightest * tolerance_.largest),
        prior_(prior) {}

  std::vector<bool> largest() {
    std::vector<bool> best(windows_.size(), false);
    for (const std::size_t length : kSeedWindows) {
      for (const std::size_t seed : seeds(length)) {
        const std::vector<bool> grown = grow(seed, length);
        if (said(grown) > said(best)) best = grown;
      }
      if (said(best) > 0) break;
    }
    return usual(rowsOf(best));
  }

  std::vector<bool> usual(const std::vector<bool>& rows) {
    std::vector<bool> chosen;
    for (const Window& window : windows_) {
      const auto count = std::count(rows.begin() + window.first, rows.begin() + window.last, true);
      chosen.push_back(2.0 * static_cast<double>(count) > sizeOf(window));
    }
    for (int round = 0; round < kTightenings && said(chosen) > 0; ++round) chosen = tightened(chosen);
    return rowsOf(chosen);
  }

 private:
  static double sizeOf(const Window& window) { return static_cast<double>(window.last - window.first); }
  static bool says(const Window& window, const JointSums& joint) { return 2.0 * joint.count >= sizeOf(window); }
  static bool says(const Window& window) {
    return std::any_of(window.sums.begin(), window.sums.end(),
                       [&](const JointSums& joint) { return says(window, joint); });
  }

  /// What the chosen windows say, joint by joint: one in which most joints stand still is easily explained.
  std::size_t said(const std::vector<bool>& chosen) const {
    std::size_t count = 0;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      if (!chosen[w]) continue;
      for (const JointSums& joint : windows_[w].sums) count += says(windows_[w], joint) ? 1 : 0;
    }
    return count;
  }

  std::vector<std::size_t> seeds(std::size_t length) const {
    std::vector<std::size_t> possible;
    for (std::size_t w = 0; w + length <= windows_.size(); w += length / 4) {
      if (windows_[w].range == windows_[w + length - 1].range) possible.push_back(w);
    }
    std::vector<std::size_t> seeds;
    const std::size_t stride = (possible.size() + kMostSeeds - 1) / kMostSeeds;
    for (std::size_t i = 0; i < possible.size(); i += std::max<std::size_t>(stride, 1)) seeds.push_back(possible[i]);
    return seeds;
  }

  /// A window counts as one equation with the tolerance as its deviation.
  Eigen::VectorXd solve(const std::vector<bool>& chosen) const {
    std::vector<JointSums> sums(static_cast<std::size_t>(regression_.joints), JointSums(regression_.inertial.cols()));
    double rows = 0.0;
    double count = 0.0;
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      if (!chosen[w]) continue;
      for (std::size_t i = 0; i < sums.size(); ++i) {
        if (says(windows_[w], windows_[w].sums[i])) sums[i] += windows_[w].sums[i];
      }
      rows += sizeOf(windows_[w]);
      count += 1.0;
    }
    const Eigen::VectorXd weight = tolerance_.largest.cwiseAbs2().cwiseInverse() * (count / std::max(rows, 1.0));
    return solveRegression(regression_, sums, weight, prior_).value;
  }

  double usualResidual(const Window& window, Index joint, const Eigen::VectorXd& theta) const {
    const JointSums& sums = window.sums[static_cast<std::size_t>(joint)];
    if (!says(window, sums)) return kNaN;
    return std::sqrt(sums.squares(regression_, joint, theta) / sums.count);
  }

  bool isExplained(const Window& window, const Eigen::VectorXd& theta) const {
    for (Index i = 0; i < regression_.joints; ++i) {
      if (usualResidual(window, i, theta) > tolerance_.largest[i]) return false;  // NaN says nothing against it
    }
    return true;
  }

  std::vector<bool> explained(const Eigen::VectorXd& theta) const {
    std::vector<bool> chosen;
    for (const Window& window : windows_) chosen.push_back(isExplained(window, theta));
    for (std::size_t first = 0; first < chosen.size();) {  // no short runs
      std::size_t last = first + 1;
      while (last < chosen.size() && chosen[last] == chosen[first] && windows_[last].range == windows_[first].range) {
        ++last;
      }
      if (last - first < kShortestRun)
        std::fill(chosen.begin() + static_cast<std::ptrdiff_t>(first),
                  chosen.begin() + static_cast<std::ptrdiff_t>(last), false);
      first = last;
    }
    return chosen;
  }

  std::vector<bool> grow(std::size_t seed, std::size_t length) const {
    std::vector<bool> chosen(windows_.size(), false);
    for (std::size_t w = seed; w < seed + length; ++w) chosen[w] = true;
    for (int round = 0; round < kMostRounds; ++round) {
      std::vector<bool> next = explained(solve(chosen));
      if (next == chosen || said(next) == 0) return next;
      chosen = next;
    }
    return chosen;
  }

  /// What sticks out of the usual residual of the chosen windows is no longer chosen.
  std::vector<bool> tightened(const std::vector<bool>& chosen) {
    const Eigen::VectorXd theta = solve(chosen);
    for (Index i = 0; i < regression_.joints; ++i) {
      std::vector<double> residuals;
      for (std::size_t w = 0; w < windows_.size(); ++w) {
        const double residual = chosen[w] ? usualResidual(windows_[w], i, theta) : std::nan("");
        if (!std::isnan(residual)) residuals.push_back(residual);
      }
      if (residuals.empty()) continue;
      const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
      std::nth_element(residuals.begin(), middle, residuals.end());
      const double usual = kUsual * std::max(*middle, tolerance_.noise[i]);
      tolerance_.largest[i] = std::min(tolerance_.largest[i], std::max(usual, least_[i]));
    }
    std::vector<bool> kept = explained(theta);
    std::transform(kept.begin(), kept.end(), chosen.begin(), kept.begin(), std::logical_and<>());
    return kept;
  }

  std::vector<bool> rowsOf(const std::vector<bool>& chosen) const {
    std::vector<bool> rows(static_cast<std::size_t>(regression_.rows()), false);
    for (std::size_t w = 0; w < windows_.size(); ++w) {
      if (!chosen[w] || !says(windows_[w])) continue;
      std::fill(rows.begin() + windows_[w].first, rows.begin() + windows_[w].last, true);
    }
    return rows;
  }

  const TorqueRegression& regression_;
  const std::vector<Window> windows_;
  HandFreeTolerance tolerance_;
  const Eigen::VectorXd least_;
  const Prior& prior_;
};

}  // namespace

std::vector<bool> findHandFreeRows(const TorqueEquations& equations, const TorqueRegression& regression,
                                   const HandFreeTolerance& tolerance, const Prior& prior) {
  return Search(regression, windowsOf(equations, regression), tolerance, prior).largest();
}

std::vector<bool> keepUsualRows(const TorqueEquations& equations, const TorqueRegression& regression,
                                const HandFreeTolerance& tolerance, const Prior& prior, const std::vector<bool>& rows) {
  return Search(regression, windowsOf(equations, regression), tolerance, prior).usual(rows);
}

}  // namespace demo_logger
