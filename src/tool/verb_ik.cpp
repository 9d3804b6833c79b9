#include <iostream>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "demo_logger/formats/atomic_file.h"
#include "src/tool/joint_table.h"
#include "src/tool/number_option.h"
#include "src/tool/output_plan.h"
#include "src/tool/pose_table.h"
#include "src/tool/progress.h"
#include "src/tool/robot_options.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

constexpr double kPatience = 1.0;  // [s] stuck, before track changes over to another posture

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  RobotOptions robot;
  std::optional<double> tolerance;
  std::optional<double> budget;
  std::string mode = "solve";
  double rate = 100.0;
  TrackingOptions tracking;
  bool no_foresight = false;
  unsigned jobs = 1;
  bool force = false;
  bool json = false;
};

struct Result {
  JointTable table;
  std::vector<std::string> notes;
};

Result convert(const std::filesystem::path& input, const RobotDescription& arm, const Options& options,
               const RowProgress& progress) {
  RowNotes notes(input.string());
  const PoseTable poses = readPoseTable(input, arm, notes);
  Result result;
  if (options.mode == "track") {
    TrackTableOptions track;
    track.tracking = options.tracking;
    track.tracking.patience = kPatience;
    track.tracking.tolerance = options.tolerance.value_or(track.tracking.tolerance);
    track.rate = options.rate;
    track.foresight = !options.no_foresight;
    result.table = trackTable(poses, input.string(), arm, track, progress);
  } else {
    SolveTableOptions solve;
    solve.tolerance = options.tolerance.value_or(solve.tolerance);
    solve.budget = options.budget;
    result.table = solveTable(poses, arm, solve, progress);
  }
  result.notes = notes.sentences();
  return result;
}

void writeAll(const std::vector<InputAndOutput>& plan, const std::vector<Result>& results, bool force) {
  makeDirectories(plan);
  AtomicFiles files;
  for (std::size_t i = 0; i < plan.size(); ++i) files.add(plan[i].output, force).write(results[i].table.csv);
  files.commit();
}

ordered_json toJson(const InputAndOutput& entry, const Result& result) {
  const JointTable& table = result.table;
  return {{"file", entry.input.string()},
          {"output", entry.output.string()},
          {"rows", table.rows},
          {"status", table.counted},
          {"largest_residual", table.largest_residual ? ordered_json(*table.largest_residual) : ordered_json()},
          {"mean_microseconds", table.mean_microseconds},
          {"planning_seconds", table.planning_seconds},
          {"notes", result.notes}};
}

void print(const InputAndOutput& entry, const Result& result) {
  const JointTable& table = result.table;
  for (const std::string& note : result.notes) std::cout << note << '\n';
  std::ostringstream figures;
  figures.precision(3);
  for (const auto& [status, rows] : table.counted) figures << rows << ' ' << status << ", ";
  if (table.largest_residual) {
    figures << "largest residual " << *table.largest_residual << " m or rad, ";
  } else {
    figures << "no residual, ";
  }
  figures << table.mean_microseconds << " µs a row";
  if (table.planning_seconds > 0.0) figures << ", " << table.planning_seconds << " s for the plan";
  std::cout << entry.output.string() << ": " << table.rows << " rows: " << figures.str() << '\n';
}

int convertAll(const Options& options) {
  const RobotDescription arm = describeRobot(options.robot);
  const std::vector<InputAndOutput> plan = planOutputs(options.inputs, options.output, options.force);
  std::vector<Result> results(plan.size());
  {
    Progress progress("ik");
    std::mutex watched;
    runJobs(plan.size(), options.jobs, [&](std::size_t i) {
      results[i] = convert(plan[i].input, arm, options, [&](std::size_t done, std::size_t all) {
        const std::lock_guard<std::mutex> lock(watched);
        progress.show(i * all + done, plan.size() * all);
      });
    });
  }
  writeAll(plan, results, options.force);
  int exit_code = kDone;
  ordered_json tables = ordered_json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    if (results[i].table.met < results[i].table.rows) exit_code = kFindings;
    tables.push_back(toJson(plan[i], results[i]));
    if (!options.json) print(plan[i], results[i]);
  }
  if (options.json) std::cout << ordered_json{{"tables", tables}}.dump(2) << '\n';
  return exit_code;
}

}  // namespace

void addIkVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("ik", "poses of the tool become joint positions");
  verb->add_option("IN", options->inputs,
                   "tables with columns x y z [m] qx qy qz qw, and if need be time [s], q0_<joint> (seeds)")
      ->required();
  verb->add_option("-o,--output", options->output, "table to write; of several inputs the directory for theirs")
      ->required();
  addRobotOptions(*verb, options->robot);
  verb->add_option("--mode", options->mode, "solve: each pose by itself; track: one motion within the arm's limits")
      ->capture_default_str()
      ->check(CLI::IsMember({"solve", "track"}));
  requireNumber(
      *verb->add_option("--tolerance", options->tolerance,
                        "[m] and [rad] that position and rotation may be off (default: 1e-6 to solve, 1e-3 to track)"),
      positive("m and rad"));
  requireNumber(*verb->add_option("--budget", options->budget,
                                  "solve: [s] for one row (default: bounded by iterations, some 5 ms)"),
                positive("s"));
  requireNumber(
      *verb->add_option("--rate", options->rate, "track: [Hz] of a table without time")->capture_default_str(),
      positive("Hz"));
  requireNumber(*verb->add_option("--max-velocity", options->tracking.max_velocity,
                                  "track: [rad/s or m/s] of each joint, beside the description's (default: those "
                                  "alone)"),
                positive("rad/s or m/s"));
  requireNumber(*verb->add_option("--max-acceleration", options->tracking.max_acceleration,
                                  "track: [rad/s² or m/s²] of each joint")
                     ->capture_default_str(),
                positive("rad/s² or m/s²"));
  verb->add_flag("--no-foresight", options->no_foresight,
                 "track: each step from the poses up to it, as a live robot must; else what a pose leaves open is "
                 "chosen with a view to the next 20 s");
  addJobsOption(*verb, options->jobs, "tables worked on at once");
  verb->add_flag("--force", options->force, "overwrite what is there");
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer(
      "Example: demo_tool ik poses.csv -o joints.csv --urdf arm.urdf --base base_link --tip tool0\n"
      "Columns written: time if given, q_<joint>, residual (larger of [m] and [rad]), microseconds, status: solved or\n"
      "failed; tracked, speed_limited, at_limit or unreachable. track starts at rest at the first row's seed\n"
      "(default: the middle of the ranges), the first row being the start itself. It is local: what only another\n"
      "posture reaches is speed_limited or at_limit until the arm, after 1 s or at once if the pose jumped, goes "
      "there\n"
      "through joint space; for the orientation alone only while the pose rests. unreachable is what solve fails at.\n"
      "Exit code: 1 if a row was not solved or tracked.");
  verb->callback([options, &exit_code] { exit_code = convertAll(*options); });
}

}  // namespace demo_logger
