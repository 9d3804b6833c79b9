#pragma once

#include <cmath>

#include "demo_logger/pipelines/check.h"

namespace demo_logger {

constexpr double kSineAmplitude = 0.5;  // [rad]
constexpr double kSineFrequency = 2.0;  // [rad/s]

/// Two joints on a sine, 500 rows at 100 Hz, under a command that is 20 ms old: nothing to find in it.
/// Columns: q_elbow q_wrist dq_elbow dq_wrist receipt_delay u_vx u_age.
inline Demonstration makeSineDemonstration() {
  Demonstration demonstration;
  demonstration.columns = {{"q_elbow", "rad", Role::state, Interpolation::linear, ""},
                           {"q_wrist", "rad", Role::state, Interpolation::linear, ""},
                           {"dq_elbow", "rad/s", Role::state, Interpolation::linear, ""},
                           {"dq_wrist", "rad/s", Role::state, Interpolation::linear, ""},
                           {"receipt_delay", "s", Role::auxiliary, Interpolation::none, ""},
                           {"u_vx", "m/s", Role::control, Interpolation::hold, ""},
                           {"u_age", "s", Role::auxiliary, Interpolation::none, ""}};
  constexpr int kRows = 500;
  demonstration.values.resize(kRows, static_cast<Eigen::Index>(demonstration.columns.size()));
  for (int row = 0; row < kRows; ++row) {
    const double time = 0.01 * row;
    const double position = kSineAmplitude * std::sin(kSineFrequency * time);
    const double velocity = kSineAmplitude * kSineFrequency * std::cos(kSineFrequency * time);
    demonstration.time.push_back(time);
    demonstration.values.row(row) << position, -position, velocity, -velocity, 0.002, velocity, 0.02;
  }
  demonstration.metadata.rows = kRows;
  demonstration.metadata.duration = 4.99;
  return demonstration;
}

/// Takes rows out, as a loss on the way does.
inline void removeRows(Demonstration& demonstration, int first, int count) {
  const auto rows = static_cast<int>(demonstration.time.size());
  const Demonstration::Values after = demonstration.values.bottomRows(rows - first - count);
  demonstration.values.middleRows(first, after.rows()) = after;
  demonstration.values.conservativeResize(rows - count, Eigen::NoChange);
  demonstration.time.erase(demonstration.time.begin() + first, demonstration.time.begin() + first + count);
}

/// The only finding there must be.
inline Finding onlyFinding(const CheckResult& result) {
  return result.findings.size() == 1 ? result.findings[0]
                                     : Finding{std::to_string(result.findings.size()) + " findings", Severity::error,
                                               result.findings.empty() ? "" : result.findings[0].sentence};
}

}  // namespace demo_logger
