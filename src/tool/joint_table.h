#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "demo_logger/robot/robot_description.h"
#include "demo_logger/robot/tracking.h"
#include "src/tool/pose_table.h"

namespace demo_logger {

struct SolveTableOptions {
  double tolerance = 1e-6;       // [m] and [rad]
  std::optional<double> budget;  // [s] per row
};

struct TrackTableOptions {
  TrackingOptions tracking;
  double rate = 100.0;    // [Hz] of a table without times
  bool foresight = true;  // the path is known: plan ahead on it
};

/// What `ik` found for a table: its text, and the figures that are told about it.
struct JointTable {
  std::string csv;  // [time,] q_<joint> …, residual, microseconds, status
  std::size_t rows = 0;
  std::size_t met = 0;                     // solved, or tracked
  std::optional<double> largest_residual;  // of the rows with one [m or rad]
  double mean_microseconds = 0.0;
  double planning_seconds = 0.0;               // for foresight, beside the rows' own time
  std::map<std::string, std::size_t> counted;  // rows by status
};

using RowProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Each pose by itself (robot/inverse_kinematics.h), from the row's seed or the middle of the ranges.
JointTable solveTable(const PoseTable& poses, const RobotDescription& arm, const SolveTableOptions& options,
                      const RowProgress& progress);

/// One motion along all poses, from rest at the first row's seed or the middle of the ranges (robot/tracking.h). Throws
/// FileError, naming `file`, for times that do not strictly increase.
JointTable trackTable(const PoseTable& poses, const std::string& file, const RobotDescription& arm,
                      const TrackTableOptions& options, const RowProgress& progress);

}  // namespace demo_logger
