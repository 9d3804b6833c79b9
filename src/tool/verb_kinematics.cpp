#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/formats/sidecar.h"
#include "demo_logger/pipelines/tool_pose.h"
#include "demo_logger/trajectory/error.h"
#include "src/ros/version.h"
#include "src/tool/output_plan.h"
#include "src/tool/robot_options.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  RobotOptions robot;
  unsigned jobs = 1;
  bool force = false;
  bool json = false;
};

std::string stepOf(const RobotDescription& arm, const Options& options) {
  std::string step = "kinematics --base " + arm.base + " --tip " + arm.tip;
  for (const std::string& at : options.robot.at) step += " --at " + at;
  return step;
}

LoadedDemonstration withToolPose(const std::filesystem::path& input, const RobotDescription& arm,
                                 const Options& options) {
  LoadedDemonstration loaded = readDemonstration(input);
  Demonstration& demonstration = loaded.demonstration;
  try {
    addToolPose(arm, demonstration);
  } catch (const ConfigurationError& error) {
    throw FileError(input.string() + ": " + error.what());
  }
  Metadata& metadata = demonstration.metadata;
  metadata.robot.name = arm.name;
  metadata.robot.urdf_sha256 = arm.urdf_sha256;
  metadata.robot.base = arm.base;
  metadata.robot.tip = arm.tip;
  if (metadata.robot.joints.empty()) metadata.robot.joints = arm.jointNames();
  metadata.software = kSoftware;
  metadata.provenance.parent = input.filename().string();
  metadata.provenance.steps.push_back(stepOf(arm, options));
  return loaded;
}

/// Two files each, so their places are judged before any is written.
void refuseSidecarsThatAreThere(const std::vector<InputAndOutput>& plan) {
  for (const InputAndOutput& entry : plan) {
    const std::filesystem::path sidecar = sidecarPath(entry.output);
    if (std::filesystem::exists(sidecar)) {
      throw FileError(sidecar.string() +
                      ": exists already and is not overwritten; choose another name, or add --force");
    }
  }
}

void convertAll(const Options& options) {
  const RobotDescription arm = describeRobot(options.robot);
  const std::vector<InputAndOutput> plan = planOutputs(options.inputs, options.output, options.force);
  if (!options.force) refuseSidecarsThatAreThere(plan);
  std::vector<LoadedDemonstration> results(plan.size());
  runJobs(plan.size(), options.jobs, [&](std::size_t i) { results[i] = withToolPose(plan[i].input, arm, options); });
  makeDirectories(plan);
  ordered_json recordings = ordered_json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const std::string output = plan[i].output.string();
    const Demonstration& demonstration = results[i].demonstration;
    writeDemonstration(plan[i].output, demonstration, options.force);
    recordings.push_back({{"file", plan[i].input.string()},
                          {"output", output},
                          {"rows", demonstration.time.size()},
                          {"notes", results[i].notes}});
    if (options.json) continue;
    for (const std::string& note : results[i].notes) std::cout << "note: " << note << '\n';
    std::cout << output << ": " << demonstration.time.size() << " rows with the pose of " << arm.tip << " in "
              << arm.base << '\n';
  }
  if (options.json) std::cout << ordered_json{{"recordings", recordings}}.dump(2) << '\n';
}

}  // namespace

void addKinematicsVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("kinematics", "recordings get the pose of the tool, from their joints");
  verb->add_option("IN", options->inputs, "recordings (*.csv) with a column q_<joint> of each joint, or directories")
      ->required();
  verb->add_option("-o,--output", options->output, "recording to write; of several inputs the directory for theirs")
      ->required();
  addRobotOptions(*verb, options->robot);
  verb->add_option("--jobs", options->jobs, "recordings worked on at once")
      ->capture_default_str()
      ->check(CLI::Range(1U, 256U));
  verb->add_flag("--force", options->force, "overwrite what is there");
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer(
      "Example: demo_tool kinematics demos/demo_000001.csv -o with_pose.csv --urdf arm.urdf --tip tool0\n"
      "Adds ee_x ee_y ee_z [m], ee_qx ee_qy ee_qz ee_qw in the base frame; such columns that are there are replaced.");
  verb->callback([options, &exit_code] {
    convertAll(*options);
    exit_code = kDone;
  });
}

}  // namespace demo_logger
