#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "src/tool/bag_import.h"
#include "src/tool/number_option.h"
#include "src/tool/progress.h"
#include "src/tool/stream_option.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

struct Options {
  std::vector<std::string> bags;
  std::string output;
  std::string joint_states;
  std::vector<std::string> streams;
  double max_wait = 0.1;
  double split_gap = 0.0;
  std::string channel = "unknown";
  EffortOptions effort;
  std::string urdf;
  std::string base;
  std::string tip;
  bool json = false;
};

ImportOptions makeImportOptions(const Options& options) {
  ImportOptions result;
  result.output = options.output;
  result.max_wait = options.max_wait;
  result.split_gap = options.split_gap;
  result.channel = options.channel;
  result.effort = options.effort;
  validate(corrected(EffortMetadata(), options.effort));
  if (!options.urdf.empty()) {
    DescriptionOptions description;
    description.base = options.base;
    description.tip = options.tip;
    result.robot = describeRobotFile(options.urdf, description);
  } else if (!options.base.empty() || !options.tip.empty()) {
    throw ConfigurationError("--base and --tip say where in a robot the tool is, expected --urdf with them");
  }
  return result;
}

/// Every bag is opened and planned before anything is written.
std::vector<std::pair<BagReader, ImportPlan>> openBags(const Options& options) {
  std::vector<StreamConfiguration> streams;
  for (const std::string& stream : options.streams) {
    streams.push_back(parseStreamOption(stream));
  }
  const auto joint_states = options.joint_states.empty() ? std::nullopt : std::make_optional(options.joint_states);
  std::vector<std::pair<BagReader, ImportPlan>> bags;
  for (const std::string& path : options.bags) {
    BagReader bag(path);
    ImportPlan plan = planImport(bag, joint_states, streams);
    SynchroniserConfiguration configuration;
    configuration.streams = plan.streams;
    validate(configuration);
    bags.emplace_back(std::move(bag), std::move(plan));
  }
  return bags;
}

ordered_json describe(const std::filesystem::path& file) {
  const Metadata metadata = readSidecar(sidecarPath(file)).metadata;
  ordered_json faults = ordered_json::array();
  for (const Fault& fault : metadata.faults) {
    faults.push_back(fault.what);
  }
  return {{"id", metadata.id},         {"file", file.string()},
          {"rows", metadata.rows},     {"duration", metadata.duration},
          {"status", metadata.status}, {"faults", faults}};
}

void print(const ordered_json& bag) {
  std::cout << bag["bag"].get<std::string>() << '\n';
  for (const ordered_json& note : bag["notes"]) {
    std::cout << "  " << note.get<std::string>() << '\n';
  }
  for (const ordered_json& episode : bag["episodes"]) {
    std::cout << "  " << episode["file"].get<std::string>() << ": " << episode["rows"] << " rows, "
              << episode["duration"].get<double>() << " s, " << episode["status"].get<std::string>() << '\n';
    for (const ordered_json& fault : episode["faults"]) {
      std::cout << "    " << fault.get<std::string>() << '\n';
    }
  }
}

/// Returns the exit code.
int import(const Options& options) {
  int exit_code = kDone;
  ImportOptions import_options = makeImportOptions(options);
  ordered_json bags = ordered_json::array();
  for (const auto& [bag, plan] : openBags(options)) {
    Progress progress(bag.path().filename().string());
    import_options.progress = [&](std::uint64_t done, std::uint64_t all) { progress.show(done, all); };
    ordered_json entry = {{"bag", bag.path().string()},
                          {"joint_states", plan.joint_states},
                          {"notes", plan.notes},
                          {"episodes", ordered_json::array()}};
    for (const std::filesystem::path& file : importBag(bag, plan, import_options)) {
      entry["episodes"].push_back(describe(file));
      if (!entry["episodes"].back()["faults"].empty()) exit_code = kFindings;
    }
    if (!options.json) {
      print(entry);
    }
    bags.push_back(std::move(entry));
  }
  if (options.json) {
    std::cout << ordered_json{{"bags", bags}}.dump(2) << '\n';
  }
  return exit_code;
}

}  // namespace

void addImportVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("import", "ROS bags become demonstrations");
  verb->add_option("BAG", options->bags, "bags to read, each an episode of its own")->required();
  verb->add_option("-o,--output", options->output, "directory for demo_000001.csv and .json, the next free numbers")
      ->required();
  verb->add_option("--joint-states", options->joint_states,
                   "topic of the joint states (default: /joint_states, else the only one of that type)");
  verb->add_option("--stream", options->streams,
                   "NAME=TOPIC[:hold|linear|nearest[:LATENCY_S]], once per stream (default: teleop_cmd from the topic "
                   "named teleop_cmd or cmd_vel)")
      ->type_size(1)
      ->allow_extra_args(false);
  NumberRange seconds;
  seconds.unit = "s";
  seconds.lower = 0.0;
  requireNumber(
      *verb->add_option("--split-gap", options->split_gap, "[s] a longer pause begins another episode; 0: never")
           ->capture_default_str(),
      seconds);
  seconds.upper = 10.0;
  requireNumber(
      *verb->add_option("--max-wait", options->max_wait, "[s] that a row waits for stragglers")->capture_default_str(),
      seconds);
  verb->add_option("--channel", options->channel, "over which it was demonstrated")
      ->capture_default_str()
      ->check(CLI::IsMember({"teleoperation", "kinesthetic", "vr", "unknown"}));
  addEffortOptions(*verb, options->effort, "instant, at the motor side");
  verb->add_option("--urdf", options->urdf, "robot description, for the tool pose");
  verb->add_option("--base", options->base, "link in whose frame the tool pose is given (default: the root)");
  verb->add_option("--tip", options->tip, "link of the tool (default: the only leaf)");
  verb->add_flag("--json", options->json, "print one JSON object instead");
  verb->footer(
      "Example: demo_tool import teleoperation.bag -o demos --stream wrench=/ft_sensor:linear:0.004\n"
      "Exit code: 1 if an episode has faults, as `demo_tool info` shows them.");
  verb->callback([options, &exit_code] { exit_code = import(*options); });
}

}  // namespace demo_logger
