#pragma once

// A real Panda's identification run, without contact: 21 s, published with Gaz, Cognetti, Oliva, Robuffo Giordano and
// De Luca, Dynamic identification of the Franka Emika Panda robot, RA-L 2019. From the folder DEMO_LOGGER_DATA.

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

/// What the published model, with its friction, leaves of the same run, looked at through local quartics of 0.3 s [N
/// m].
constexpr std::array<double, 7> kPublishedResidual = {0.22, 0.52, 0.21, 0.26, 0.12, 0.08, 0.06};

/// Nothing where the folders DEMO_LOGGER_DATA and DEMO_LOGGER_URDF are not there.
inline std::optional<RobotDescription> describePanda() {
  const char* const folder = std::getenv("DEMO_LOGGER_URDF");
  if (folder == nullptr) return std::nullopt;
  return describeRobotFile(std::string(folder) + "/panda.urdf", {"panda_link0", "panda_link8", {}, 9.81});
}

inline std::optional<Demonstration> readPandaRun() {
  const char* const folder = std::getenv("DEMO_LOGGER_DATA");
  if (folder == nullptr) return std::nullopt;
  const auto read = [&](const std::string& what) {
    std::vector<double> numbers;
    std::ifstream file(std::string(folder) + "/panda_excitation_" + what + ".txt");
    for (double number = 0.0; file >> number;) numbers.push_back(number);
    return numbers;
  };
  const std::vector<double> time = read("time");
  const std::vector<double> position = read("positions");
  const std::vector<double> torque = read("torques");
  if (time.empty() || position.size() != 7 * time.size() || torque.size() != position.size()) return std::nullopt;
  Demonstration run;
  for (const char* prefix : {"q_", "tau_"}) {
    for (int i = 1; i <= 7; ++i) {
      run.columns.push_back({prefix + ("panda_joint" + std::to_string(i)), "", Role::state, Interpolation::linear, ""});
    }
  }
  run.values.resize(static_cast<Eigen::Index>(time.size()), 14);
  for (std::size_t k = 0; k < time.size(); ++k) {
    run.time.push_back(time[k] - time[0]);
    for (std::size_t i = 0; i < 7; ++i) {
      run.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = position[7 * k + i];
      run.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(7 + i)) = torque[7 * k + i];
    }
  }
  run.metadata.effort.side = "link";
  run.metadata.effort.timing = "instant";
  return run;
}

/// Each tenth value of a series between two times, replaced by the quartic that fits 0.3 s around it best.
inline std::vector<double> throughQuartics(const std::vector<double>& time, const Eigen::VectorXd& series, double from,
                                           double to) {
  constexpr double kHalf = 0.15;  // [s]
  std::vector<double> result;
  for (std::size_t k = 0; k < time.size(); k += 10) {
    if (time[k] < std::max(from, time.front() + kHalf) || time[k] > std::min(to, time.back() - kHalf)) continue;
    const auto first =
        static_cast<Eigen::Index>(std::lower_bound(time.begin(), time.end(), time[k] - kHalf) - time.begin());
    const auto last =
        static_cast<Eigen::Index>(std::upper_bound(time.begin(), time.end(), time[k] + kHalf) - time.begin());
    Eigen::MatrixXd powers(last - first, 5);
    for (Eigen::Index j = first; j < last; ++j) {
      const double s = (time[static_cast<std::size_t>(j)] - time[k]) / kHalf;
      powers.row(j - first) << 1.0, s, s * s, s * s * s, s * s * s * s;
    }
    result.push_back(powers.colPivHouseholderQr().solve(series.segment(first, last - first))[0]);
  }
  return result;
}

inline double rootMeanSquare(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace demo_logger
