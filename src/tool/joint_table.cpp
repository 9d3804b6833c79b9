#include "src/tool/joint_table.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/formats/csv_writer.h"
#include "demo_logger/robot/inverse_kinematics.h"
#include "demo_logger/robot/path_tracking.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr std::size_t kRowsPerProgress = 1000;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Builds the text row by row, and the figures beside it.
class JointTableWriter {
 public:
  JointTableWriter(const PoseTable& poses, const RobotDescription& arm, const RowProgress& progress)
      : poses_(poses), progress_(progress) {
    std::vector<std::string> names;
    for (const std::string& joint : arm.jointNames()) names.push_back("q_" + joint);
    if (!poses.time.empty()) table_.csv = "time,";
    for (const std::string& name : makePortable(names).names) table_.csv += name + ",";
    table_.csv += "residual,microseconds,status\n";
  }

  void add(const Eigen::VectorXd& q, double residual, double microseconds, bool met, const char* status) {
    const std::size_t row = table_.rows++;
    if (!poses_.time.empty()) addCell(poses_.time[row]);
    for (const double position : q) addCell(position);
    addCell(residual);
    addCell(std::round(1e3 * microseconds) * 1e-3);  // the clock tells nanoseconds
    table_.csv += status;
    table_.csv += '\n';
    ++table_.counted[status];
    if (met) ++table_.met;
    if (!std::isnan(residual)) table_.largest_residual = std::max(table_.largest_residual.value_or(0.0), residual);
    table_.mean_microseconds += microseconds;
    if (table_.rows % kRowsPerProgress == 0) progress_(table_.rows, poses_.poses.size());
  }

  JointTable finish() {
    if (table_.rows > 0) table_.mean_microseconds /= static_cast<double>(table_.rows);
    return std::move(table_);
  }

 private:
  void addCell(double value) {
    appendNumber(table_.csv, value);
    table_.csv += ',';
  }

  const PoseTable& poses_;
  const RowProgress& progress_;
  JointTable table_;
};

std::vector<double> timesOf(const PoseTable& poses, const std::string& file, double rate) {
  if (poses.time.empty()) {
    std::vector<double> times(poses.poses.size());
    for (std::size_t row = 0; row < times.size(); ++row) times[row] = static_cast<double>(row) / rate;
    return times;
  }
  for (std::size_t row = 0; row < poses.time.size(); ++row) {
    const bool follows = row == 0 || poses.time[row] > poses.time[row - 1];
    if (!std::isfinite(poses.time[row]) || !follows) {
      throw FileError(file + ":" + std::to_string(row + 2) + ": time " + printExactly(poses.time[row]) +
                      " s does not follow the row before; to track, times must strictly increase");
    }
  }
  return poses.time;
}

}  // namespace

JointTable solveTable(const PoseTable& poses, const RobotDescription& arm, const SolveTableOptions& options,
                      const RowProgress& progress) {
  const InverseKinematics solver(arm);
  SolveOptions solve_options;
  solve_options.tolerance = options.tolerance;
  Clock::time_point begin;
  if (options.budget) {
    solve_options.out_of_time = [&] { return secondsSince(begin) > *options.budget; };
  }
  JointTableWriter writer(poses, arm, progress);
  Eigen::VectorXd q(solver.middle().size());
  for (std::size_t row = 0; row < poses.poses.size(); ++row) {
    const Eigen::VectorXd& seed = poses.seeds.empty() ? solver.middle() : poses.seeds[row];
    begin = Clock::now();
    const Solution solution = solver.solve(poses.poses[row], seed, q, solve_options);
    const double microseconds = 1e6 * secondsSince(begin);
    writer.add(q, solution.residual, microseconds, solution.solved, solution.solved ? "solved" : "failed");
  }
  return writer.finish();
}

JointTable trackTable(const PoseTable& poses, const std::string& file, const RobotDescription& arm,
                      const TrackTableOptions& options, const RowProgress& progress) {
  const std::vector<double> times = timesOf(poses, file, options.rate);
  const Eigen::VectorXd start = poses.seeds.empty() ? InverseKinematics(arm).middle() : poses.seeds.front();
  if (!start.allFinite()) {
    throw FileError(file + ":2: the seed is not finite, expected the positions at which the motion starts");
  }
  JointTableWriter writer(poses, arm, progress);
  const auto add = [&](const TrackedStep& step, const Eigen::VectorXd& q, double seconds) {
    const double residual =
        std::isnan(step.position_error) ? step.position_error : std::max(step.position_error, step.rotation_error);
    writer.add(q, residual, 1e6 * seconds, step.status == TrackingStatus::tracked, toString(step.status));
  };
  double planning = 0.0;
  if (options.foresight) {
    PathTracker tracker(arm, poses.poses, times, start, options.tracking);
    for (std::size_t row = 0; row < times.size(); ++row) {
      Clock::time_point begin = Clock::now();
      if (tracker.needsPlan()) {
        tracker.plan();
        planning += secondsSince(begin);
        begin = Clock::now();
      }
      const TrackedStep step = tracker.step();
      add(step, tracker.q(), secondsSince(begin));
    }
  } else {
    Tracker tracker(arm, options.tracking);
    tracker.reset(start);
    for (std::size_t row = 0; row < times.size(); ++row) {
      const Clock::time_point begin = Clock::now();
      const TrackedStep step =
          row == 0 ? tracker.stay(poses.poses[0]) : tracker.step(poses.poses[row], times[row] - times[row - 1]);
      add(step, tracker.q(), secondsSince(begin));
    }
  }
  JointTable table = writer.finish();
  table.planning_seconds = planning;
  return table;
}

}  // namespace demo_logger
