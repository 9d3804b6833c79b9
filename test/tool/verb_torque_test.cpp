#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "test/tool/tool_run.h"

namespace demo_logger {
namespace {

const std::string kTwoLink = " --urdf " DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf --base base_link --tip tool_tip";

/// The planar arm stands upright, where gravity pulls at no joint, while its motors push with 1.5 and -0.25 N m.
std::string upright(int rows) {
  std::string csv = "time,q_joint_1,q_joint_2,tau_joint_1,tau_joint_2\n";
  for (int k = 0; k < rows; ++k) csv += std::to_string(0.01 * k) + ",0,0,1.5,-0.25\n";
  return csv;
}

TEST(VerbTorqueTest, WhoeverKeepsAnUprightArmStillPushesAgainstItsMotors) {
  const ToolRun run;
  run.write("held.csv", upright(50));
  const auto outcome = run("torque held.csv -o taught.csv --side link --effort instant" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("taught.csv: 50 rows with the human's torque in 50 of them, at most 1.5 at joint_1\n"),
            std::string::npos)
      << outcome.out;
  const auto table = run.cells("taught.csv");
  const std::vector<std::string> header = {
      "time",          "q_joint_1",         "q_joint_2",         "tau_joint_1", "tau_joint_2",
      "dq_joint_1",    "dq_joint_2",        "ddq_joint_1",       "ddq_joint_2", "tau_h_joint_1",
      "tau_h_joint_2", "tau_h_std_joint_1", "tau_h_std_joint_2", "tool_fx",     "tool_fy",
      "tool_fz",       "tool_tx",           "tool_ty",           "tool_tz",     "tool_condition"};
  EXPECT_EQ(table[0], header);
  EXPECT_NEAR(std::stod(table[20][9]), -1.5, 1e-9);
  EXPECT_NEAR(std::stod(table[20][10]), 0.25, 1e-9);
  const auto sidecar = nlohmann::json::parse(run.read("taught.json"));
  EXPECT_EQ(sidecar["effort"]["side"], "link");
  EXPECT_EQ(sidecar["provenance"]["steps"].back(),
            "torque --effort instant --side link --max-gap 0.1 --base base_link --tip tool_tip");
}

TEST(VerbTorqueTest, RowsWithoutATorqueAreAFinding) {
  const ToolRun run;
  run.write("short.csv", upright(3));
  const auto outcome = run("torque short.csv -o taught.csv --json" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const auto recording = nlohmann::json::parse(outcome.out)["recordings"][0];
  EXPECT_EQ(recording["rows_with_torque"], 0);
  EXPECT_NE(recording["notes"].dump().find("1 parts between silences have fewer than 8 rows"), std::string::npos)
      << recording;
}

TEST(VerbTorqueTest, WithoutEffortsNothingIsWrittenUnlessGravityWasCompensated) {
  const ToolRun run;
  std::string csv = "time,q_joint_1,q_joint_2\n";
  for (int k = 0; k < 20; ++k) csv += std::to_string(0.01 * k) + ",0.3,0.2\n";
  run.write("guided.csv", csv);
  const auto refused = run("torque guided.csv -o taught.csv" + kTwoLink);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("guided.csv: no column `tau_joint_1` with efforts of joint 'joint_1', without which"),
            std::string::npos)
      << refused.err;
  EXPECT_FALSE(run.exists("taught.csv"));
  EXPECT_EQ(run("torque guided.csv -o taught.csv --gravity-compensated" + kTwoLink).exit_code, 0);
  EXPECT_NEAR(std::stod(run.cells("taught.csv")[10][7]), 0.0, 1e-9) << "an arm at rest is let alone";
}

TEST(VerbTorqueTest, AModelFileTakesItsBiasOffTheEfforts) {
  const ToolRun run;
  run.write("held.csv", upright(50));
  run.write("model.yaml", "side: link\njoints:\n  joint_1: {torque_bias: 0.5}\n");
  const auto outcome = run("torque held.csv -o taught.csv --side link --effort instant --model model.yaml" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NEAR(std::stod(run.cells("taught.csv")[20][9]), -1.0, 1e-9);

  const auto other_side =
      run("torque held.csv -o other.csv --side motor --effort instant --model model.yaml" + kTwoLink);
  EXPECT_NE(other_side.out.find("note: the model's biases and friction are those of efforts measured at the link side; "
                                "here they were measured at the motor side, so neither counts\n"),
            std::string::npos)
      << other_side.out;

  run.write("other.yaml", "joints:\n  joint_9: {torque_bias: 0.5}\n");
  const auto refused = run("torque held.csv -o none.csv --side link --effort instant --model other.yaml" + kTwoLink);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err.rfind("other.yaml: no joint 'joint_9' to drive in the arm of robot", 0), 0U) << refused.err;
  EXPECT_FALSE(run.exists("none.csv"));
}

}  // namespace
}  // namespace demo_logger
