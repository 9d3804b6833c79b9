#include "src/tool/joint_table.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/formats/csv_writer.h"
#include "demo_logger/robot/inverse_kinematics.h"

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
    if (met) ++table_.met;
    table_.largest_residual = std::fmax(table_.largest_residual, residual);
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

}  // namespace demo_logger
