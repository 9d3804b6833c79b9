#include <memory>

#include "demo_logger/pipelines/tool_pose.h"
#include "src/tool/recording_conversion.h"
#include "src/tool/verbs.h"

namespace demo_logger {

void addKinematicsVerb(CLI::App& tool, int& exit_code) {
  const auto options = std::make_shared<ConversionOptions>();
  CLI::App* verb = tool.add_subcommand("kinematics", "recordings get the pose of the tool, from their joints");
  addConversionOptions(*verb, *options, "recordings (*.csv) with a column q_<joint> of each joint, or directories");
  verb->footer(
      "Example: demo_tool kinematics demos/demo_000001.csv -o with_pose.csv --urdf arm.urdf --tip tool0\n"
      "Adds ee_x ee_y ee_z [m], ee_qx ee_qy ee_qz ee_qw in the base frame; such columns that are there are replaced.");
  verb->callback([options, &exit_code] {
    Conversion conversion;
    conversion.step = "kinematics";
    conversion.convert = [](const RobotDescription& arm, LoadedDemonstration& recording) {
      addToolPose(arm, recording.demonstration);
      ConversionReport report;
      report.sentence = "with the pose of " + arm.tip + " in " + arm.base;
      return report;
    };
    exit_code = convertRecordings(*options, conversion);
  });
}

}  // namespace demo_logger
