#include "src/tool/recording_conversion.h"

#include <iostream>
#include <nlohmann/json.hpp>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "src/ros/version.h"
#include "src/tool/number_option.h"
#include "src/tool/output_plan.h"
#include "src/tool/plain_table.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

std::string describeStep(std::string step, const RobotDescription& arm, const ConversionOptions& options) {
  step += " --base " + arm.base + " --tip " + arm.tip;
  for (const std::string& at : options.robot.at) step += " --at " + at;
  return step;
}

/// Whose arm it was, and what was done.
void noteOrigin(const std::filesystem::path& input, const RobotDescription& arm, const std::string& step,
                Metadata& metadata) {
  metadata.robot.name = arm.name;
  metadata.robot.urdf_sha256 = arm.urdf_sha256;
  metadata.robot.base = arm.base;
  metadata.robot.tip = arm.tip;
  if (metadata.robot.joints.empty()) metadata.robot.joints = arm.jointNames();
  metadata.software = kSoftware;
  metadata.provenance.parent = input.filename().string();
  metadata.provenance.steps.push_back(step);
}

/// The words of a table that is no recording, if it is none and such are taken.
using Words = std::optional<std::vector<std::string>>;

LoadedDemonstration readInput(const std::filesystem::path& file, bool plain_tables, Words& words) {
  if (!plain_tables || !isPlainTable(file)) return readDemonstration(file);
  PlainTable table = readPlainTable(file);
  words = std::move(table.status);
  return std::move(table.numbers);
}

/// Two files each, so their places are judged before any is written.
void refuseSidecarsThatAreThere(const std::vector<InputAndOutput>& plan) {
  for (const InputAndOutput& entry : plan) refuseToOverwrite(sidecarPath(entry.output));
}

}  // namespace

void addConversionOptions(CLI::App& verb, ConversionOptions& options, const std::string& inputs) {
  verb.add_option("IN", options.inputs, inputs)->required();
  verb.add_option("-o,--output", options.output, "recording to write; of several inputs the directory for theirs")
      ->required();
  addRobotOptions(verb, options.robot);
  addJobsOption(verb, options.jobs, "recordings worked on at once");
  verb.add_flag("--force", options.force, "overwrite what is there");
  verb.add_flag("--json", options.json, "print one JSON object instead");
}

int convertRecordings(const ConversionOptions& options, const Conversion& conversion) {
  const RobotDescription arm = describeRobot(options.robot);
  const std::vector<InputAndOutput> plan = planOutputs(options.inputs, options.output, options.force);
  refuseToDestroy(plan, {options.robot.urdf, conversion.also_read}, conversion.also_written);
  if (!options.force) refuseSidecarsThatAreThere(plan);
  std::vector<LoadedDemonstration> recordings(plan.size());
  std::vector<ConversionReport> reports(plan.size());
  std::vector<Words> words(plan.size());
  runJobs(plan.size(), options.jobs,
          [&](std::size_t i) { recordings[i] = readInput(plan[i].input, options.plain_tables, words[i]); });
  if (conversion.prepare) {
    try {
      if (const auto exit_code = conversion.prepare(arm, recordings)) return *exit_code;
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw FileError((plan.size() == 1 ? plan.front().input.string() + ": " : std::string()) + error.what());
    }
  }
  runJobs(plan.size(), options.jobs, [&](std::size_t i) {
    try {
      reports[i] = conversion.convert(arm, recordings[i]);
    } catch (const FileError&) {
      throw;
    } catch (const Error& error) {
      throw FileError(plan[i].input.string() + ": " + error.what());
    }
    noteOrigin(plan[i].input, arm, describeStep(conversion.step, arm, options), recordings[i].demonstration.metadata);
  });
  makeDirectories(plan);
  AtomicFiles files;
  if (conversion.write) conversion.write(files);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Demonstration& demonstration = recordings[i].demonstration;
    if (words[i]) {
      files.add(plan[i].output, options.force).write(textOf(demonstration, *words[i]));
    } else {
      writeDemonstration(files, plan[i].output, demonstration, options.force);
    }
  }
  files.commit();
  ordered_json report;
  int exit_code = kDone;
  if (conversion.conclude && conversion.conclude(report)) exit_code = kFindings;
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const std::string output = plan[i].output.string();
    const Eigen::Index rows = recordings[i].demonstration.values.rows();
    if (reports[i].has_findings) exit_code = kFindings;
    ordered_json object = {
        {"file", plan[i].input.string()}, {"output", output}, {"rows", rows}, {"notes", recordings[i].notes}};
    if (reports[i].figures) reports[i].figures(object);
    list.push_back(std::move(object));
    if (options.json) continue;
    for (const std::string& note : recordings[i].notes) std::cout << "note: " << note << '\n';
    std::cout << output << ": " << rows << " rows " << reports[i].sentence << '\n';
  }
  report["recordings"] = std::move(list);
  if (options.json) std::cout << report.dump(2) << '\n';
  return exit_code;
}

}  // namespace demo_logger
