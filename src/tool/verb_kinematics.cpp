#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "demo_logger/pipelines/tool_pose.h"
#include "src/tool/recording_conversion.h"
#include "src/tool/verbs.h"

namespace demo_logger {

void addKinematicsVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<ConversionOptions>();
  CLI::App* verb = tool.add_subcommand("kinematics", "recordings get the pose of the tool, from their joints");
  options->plain_tables = true;
  addConversionOptions(*verb, *options, "recordings (*.csv) with a column q_<joint> of each joint, or directories");
  verb->footer(
      "Example: demo_tool kinematics demos/demo_000001.csv -o with_pose.csv --urdf arm.urdf --tip tool0\n"
      "Adds ee_x ee_y ee_z [m], ee_qx ee_qy ee_qz ee_qw in the base frame; such columns that are there are replaced.\n"
      "Tables that ik wrote, without time or with words in a column status, are taken too and get no sidecar.\n"
      "Exit code: 1 if a row got no pose, as the position of a joint is NaN.");
  verb->callback([options, &exit_code] {
    Conversion conversion;
    conversion.step = "kinematics";
    conversion.convert = [](const RobotDescription& arm, LoadedDemonstration& recording) {
      const std::size_t without_pose = addToolPose(arm, recording.demonstration);
      ConversionReport report;
      report.sentence = "with the pose of " + arm.tip + " in " + arm.base;
      if (without_pose > 0) {
        report.sentence +=
            "; " + std::to_string(without_pose) + " of them without, as the position of a joint is missing (NaN)";
      }
      report.figures = [without_pose](nlohmann::ordered_json& object) { object["rows_without_pose"] = without_pose; };
      report.has_findings = without_pose > 0;
      return report;
    };
    exit_code = convertRecordings(*options, conversion);
  });
}

}  // namespace demo_logger
