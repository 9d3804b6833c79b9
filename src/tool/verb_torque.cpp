#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "demo_logger/pipelines/human_torque.h"
#include "demo_logger/trajectory/print.h"
#include "src/tool/effort_options.h"
#include "src/tool/number_option.h"
#include "src/tool/recording_conversion.h"
#include "src/tool/torque_fit.h"
#include "src/tool/verbs.h"

namespace demo_logger {
namespace {

struct Options {
  ConversionOptions conversion;
  EffortOptions effort;
  bool gravity_compensated = false;
  TorqueFitOptions fit;
  double max_gap = HumanTorqueOptions().max_gap;
};

std::string stepOf(const Options& options) {
  std::string step = "torque" + stepOf(options.effort);
  if (options.gravity_compensated) step += " --gravity-compensated";
  return step + stepOf(options.fit) + " --max-gap " + print(options.max_gap);
}

/// ", at most 1.5 at joint_1", or nothing if no torque is known.
std::string largestTorque(const RobotDescription& arm, const std::vector<double>& torques) {
  std::optional<std::size_t> largest;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (!std::isnan(torques[i]) && (!largest || torques[i] > torques[*largest])) largest = i;
  }
  return largest ? ", at most " + print(torques[*largest]) + " at " + arm.jointNames()[*largest] : "";
}

/// What a recording's efforts mean, as it says or as the command line does; where neither says it, a note of what they
/// are taken for.
void explainEfforts(const Options& options, LoadedDemonstration& recording) {
  Metadata& metadata = recording.demonstration.metadata;
  const bool is_told = !options.effort.side.empty() && !options.effort.timing.empty();
  const bool is_known = is_told || options.gravity_compensated || saysWhatEffortsMean(metadata);
  metadata.effort = corrected(metadata.effort, options.effort);
  if (is_known) return;
  recording.notes.push_back("nothing recorded says what the efforts mean: they count as " + metadata.effort.timing +
                            " at the " + metadata.effort.side +
                            " side; --side, --effort and --control-period say otherwise");
}

ConversionReport addTorques(const CalibratedArm& arm, LoadedDemonstration& recording, const Options& options) {
  HumanTorqueOptions torque;
  torque.gravity_compensated = options.gravity_compensated;
  torque.max_gap = options.max_gap;
  const HumanTorqueSummary summary = addHumanTorque(arm, recording.demonstration, torque);
  recording.notes.insert(recording.notes.end(), summary.notes.begin(), summary.notes.end());

  ConversionReport report;
  const std::size_t rows = recording.demonstration.time.size();
  report.has_findings = summary.rows < rows;
  report.sentence = "with the human's torque in " + (summary.rows == 0 ? "none" : std::to_string(summary.rows)) +
                    " of them" + largestTorque(arm.robot, summary.largest_torque);
  report.figures = [summary](nlohmann::ordered_json& object) {
    object["rows_with_torque"] = summary.rows;
    object["encoder_noise"] = summary.encoder_noise;
    object["largest_torque"] = summary.largest_torque;
  };
  return report;
}

int recoverTorques(const Options& options) {
  TorqueModel model(options.fit, options.conversion.force, options.conversion.json);
  Conversion conversion;
  conversion.step = stepOf(options);
  conversion.prepare = [&](const RobotDescription& arm, std::vector<LoadedDemonstration>& recordings) {
    for (LoadedDemonstration& recording : recordings) explainEfforts(options, recording);
    FitOptions fit;
    fit.max_gap = options.max_gap;
    return model.prepare(arm, recordings, fit);
  };
  conversion.convert = [&](const RobotDescription&, LoadedDemonstration& recording) {
    return addTorques(model.arm(), recording, options);
  };
  conversion.also_read = options.fit.model;
  conversion.also_written = options.fit.fit;
  conversion.write = [&](AtomicFiles& files) { model.write(files); };
  conversion.conclude = [&](nlohmann::ordered_json& report) { return model.conclude(report); };
  return convertRecordings(options.conversion, conversion);
}

}  // namespace

void addTorqueVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<Options>();
  CLI::App* verb = tool.add_subcommand("torque", "recordings get the torque that the human's hand exerted");
  addConversionOptions(*verb, options->conversion,
                       "recordings (*.csv) with columns q_<joint> and tau_<joint> of each joint, or directories");
  addEffortOptions(*verb, options->effort, "as the recording says");
  verb->add_flag("--gravity-compensated", options->gravity_compensated,
                 "the arm was compensated for gravity alone; efforts are not needed");
  addTorqueFitOptions(*verb, options->fit);
  requireNumber(*verb->add_option("--max-gap", options->max_gap, "[s] nothing is concluded across a longer silence")
                     ->capture_default_str(),
                positive("s"));
  verb->footer(
      "Example: demo_tool torque demos/demo_000001.csv -o taught.csv --urdf arm.urdf --base base_link --tip tool0\n"
      "Adds tau_h_<joint> with tau_h_std_<joint>, the smoothed dq_<joint> and ddq_<joint>, and the force at the tool\n"
      "tool_fx … tool_tz in base axes with tool_condition; such columns that are there are replaced.\n"
      "With --fit, the model is found from what one payload, bias and friction explain; where none explains enough, "
      "say\n"
      "where no hand is: demo_tool torque demos/demo_000001.csv -o taught.csv --fit arm.yaml --hand-free 0:6 --urdf …\n"
      "Recorded velocities are not needed: they follow from positions. Nothing is concluded across silences, nor from\n"
      "fewer than 8 rows: NaN. A joint without efforts stays NaN; if none has any, that is refused, unless the arm "
      "was\n"
      "--gravity-compensated.\n"
      "Exit code: 1 if a row got no torque, or a model could not be fitted (then nothing is written).");
  verb->callback([options, &exit_code] { exit_code = recoverTorques(*options); });
}

}  // namespace demo_logger
