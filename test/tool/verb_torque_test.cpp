#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "demo_logger/pipelines/model_calibration.h"
#include "demo_logger/robot/robot_model.h"
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
  EXPECT_TRUE(recording["largest_torque"][0].is_null()) << recording;
  EXPECT_NE(recording["notes"].dump().find("they count as instant at the motor side; --side, --effort and "
                                           "--control-period say otherwise"),
            std::string::npos)
      << recording;
  const auto said = run("torque short.csv -o said.csv --side link --effort instant" + kTwoLink).out;
  EXPECT_NE(said.find("said.csv: 3 rows with the human's torque in none of them\n"), std::string::npos) << said;
  EXPECT_EQ(said.find("nothing recorded says"), std::string::npos) << said;
  EXPECT_NE(recording["notes"].dump().find("1 part between silences has fewer than 8 rows"), std::string::npos)
      << recording;
}

TEST(VerbTorqueTest, WhatAnImportWasNotToldOfTheEffortsIsStillNotKnown) {
  const ToolRun run;
  const std::string sidecar =
      R"("format":"demo_logger/1","software":"demo_logger","robot":{"joints":["joint_1","joint_2"]})";
  const auto isAssumed = [&](const std::string& step) {
    run.write("bag.csv", upright(20));
    run.write("bag.json", "{" + sidecar + R"(,"provenance":{"parent":"a.bag","steps":[")" + step + "\"]}}");
    return run("torque bag.csv -o taught.csv --force" + kTwoLink).out.find("nothing recorded says") !=
           std::string::npos;
  };
  EXPECT_TRUE(isAssumed("import"));
  EXPECT_FALSE(isAssumed("import --effort instant --side motor"));
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
  run.write("model.yaml", "format: demo_logger_model/1\nside: link\njoints:\n  joint_1: {torque_bias: 0.5}\n");
  const auto outcome = run("torque held.csv -o taught.csv --side link --effort instant --model model.yaml" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NEAR(std::stod(run.cells("taught.csv")[20][9]), -1.0, 1e-9);

  const auto other_side =
      run("torque held.csv -o other.csv --side motor --effort instant --model model.yaml" + kTwoLink);
  EXPECT_NE(other_side.out.find("note: the model's biases and friction are those of efforts measured at the link side; "
                                "here they were measured at the motor side, so neither counts\n"),
            std::string::npos)
      << other_side.out;

  run.write("other.yaml", "format: demo_logger_model/1\njoints:\n  joint_9: {torque_bias: 0.5}\n");
  const auto refused = run("torque held.csv -o none.csv --side link --effort instant --model other.yaml" + kTwoLink);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(refused.err.rfind("other.yaml: no joint 'joint_9' to drive in the arm of robot", 0), 0U) << refused.err;
  EXPECT_FALSE(run.exists("none.csv"));
}

/// The planar arm swings its links by itself; what its motors need of it beyond the URDF is a bias. With a hand,
/// pushes of all sizes are added.
std::string swinging(double seconds, double bias, double hand) {
  const RobotModel model(
      describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf", {"base_link", "tool_tip", {}, 9.81}));
  std::string csv = "time,q_joint_1,q_joint_2,tau_joint_1,tau_joint_2\n";
  for (double t = 0.0; t < seconds; t += 0.01) {
    Eigen::VectorXd q(2), dq(2), ddq(2);
    q << 0.8 * std::sin(1.5 * t), 0.7 * std::sin(2.3 * t);
    dq << 1.2 * std::cos(1.5 * t), 1.61 * std::cos(2.3 * t);
    ddq << -1.8 * std::sin(1.5 * t), -3.703 * std::sin(2.3 * t);
    const Eigen::VectorXd torque = model.inverseDynamics(q, dq, ddq);
    const double push = hand * (std::sin(5.0 * t) + 0.7 * std::sin(11.0 * t) + 0.3 * std::sin(50.0 * t));
    csv += std::to_string(t) + "," + std::to_string(q[0]) + "," + std::to_string(q[1]) + "," +
           std::to_string(torque[0] + bias + push) + "," + std::to_string(torque[1] + 0.5 * push) + "\n";
  }
  return csv;
}

TEST(VerbTorqueTest, AFitWritesTheModelAndGoesByIt) {
  const ToolRun run;
  run.write("free.csv", swinging(10.0, 0.4, 0.0));
  const std::string how = " --side link --effort instant" + kTwoLink;
  const auto outcome = run("torque free.csv -o out.csv --fit arm.yaml" + how);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("arm.yaml: fitted to "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("  joint_1: torque bias 0.4"), std::string::npos) << outcome.out;
  const ModelCalibration model = readModelCalibration(run.path("arm.yaml"));
  EXPECT_NEAR(model.joints.at("joint_1").torque_bias->value, 0.4, 1e-3);
  EXPECT_NEAR(std::stod(run.cells("out.csv")[500][9]), 0.0, 0.01) << "no hand, no torque";

  EXPECT_EQ(run("torque free.csv -o again.csv --fit arm.yaml" + how).err,
            "arm.yaml: exists already and is not overwritten; choose another name, or add --force\n");
  EXPECT_EQ(run("torque free.csv -o again.csv --model arm.yaml" + how).exit_code, 0);
  EXPECT_EQ(run.cells("again.csv")[500][9].substr(0, 6), run.cells("out.csv")[500][9].substr(0, 6));
  const auto given = run("torque free.csv -o given.csv --fit given.yaml --hand-free 1:4 --hand-free 6:9 --json" + how);
  EXPECT_EQ(given.exit_code, 0) << given.err;
  const auto fit = nlohmann::json::parse(given.out)["fit"];
  EXPECT_EQ(fit["hand_free"].size(), 2U);
  EXPECT_NEAR(fit["duration"].get<double>(), 6.0, 0.03);
  EXPECT_EQ(fit["residual"].size(), 2U);
}

TEST(VerbTorqueTest, FrictionIsFittedUnaskedWhereTheEffortsAreTheMotors) {
  const ToolRun run;
  run.write("free.csv", swinging(10.0, 0.0, 0.0));
  const auto stepAndFindings = [&](const std::string& how) {
    const auto outcome =
        run("torque free.csv -o out.csv --fit arm.yaml --force --effort instant --json " + how + kTwoLink);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(run.read("out.json"))["provenance"]["steps"].back().get<std::string>() +
           nlohmann::json::parse(outcome.out)["fit"]["findings"].dump();
  };
  const std::string unasked = stepAndFindings("--side motor");
  EXPECT_EQ(unasked.find("fit-friction"), std::string::npos) << unasked;
  EXPECT_EQ(unasked.find("friction is not fitted"), std::string::npos) << unasked;
  const std::string refused = stepAndFindings("--side motor --no-fit-friction");
  EXPECT_NE(refused.find("--no-fit-friction"), std::string::npos) << refused;
  EXPECT_NE(refused.find("friction is not fitted"), std::string::npos) << refused;
  EXPECT_NE(stepAndFindings("--side link --fit-friction").find(" --fit-friction"), std::string::npos);
}

TEST(VerbTorqueTest, RecordingsOfBothSidesAreNotFittedTogetherWhateverElseIsSaidOfThem) {
  const ToolRun run;
  const std::string sidecar = R"({"format":"demo_logger/1","effort":{"side":")";
  for (const std::string side : {"motor", "link"}) {
    run.write(side + ".csv", swinging(5.0, 0.0, 0.0));
    run.write(side + ".json", sidecar + side + "\"}}");
  }
  for (const std::string more : {"", " --control-period 0.001", " --effort instant"}) {
    const auto outcome = run("torque motor.csv link.csv -o taught --fit arm.yaml" + more + kTwoLink);
    EXPECT_EQ(outcome.exit_code, 2) << more;
    EXPECT_NE(outcome.err.find("efforts were measured at different sides of the gears"), std::string::npos)
        << more << ": " << outcome.err;
  }
  EXPECT_EQ(run("torque motor.csv link.csv -o taught --fit arm.yaml --side link" + kTwoLink).exit_code, 0);
}

TEST(VerbTorqueTest, TwoOutputsWithOneSidecarAreRefusedBeforeAnythingIsWritten) {
  const ToolRun run;
  run.write("a.csv", upright(20));
  run.write("a.txt", upright(20));
  const auto outcome = run("torque a.csv a.txt -o taught --force" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err,
            "the sidecar of the output taught/a.txt and the sidecar of the output taught/a.csv would both become "
            "taught/a.json; "
            "rename an input, or run them one by one\n");
  EXPECT_FALSE(run.exists("taught"));
}

TEST(VerbTorqueTest, OfSeveralInputsTheOneThatCannotBeIsNamedAndNoOutputWritten) {
  const ToolRun run;
  run.write("good.csv", upright(20));
  std::string wild = "time,q_joint_1,q_joint_2,tau_joint_1,tau_joint_2\n";
  for (int k = 0; k < 20; ++k) wild += std::to_string(k) + "e-200," + std::to_string(k % 3) + ",0,0,0\n";
  run.write("wild.csv", wild);
  const auto outcome = run("torque good.csv wild.csv -o taught" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_EQ(outcome.err.rfind("wild.csv: ", 0), 0U) << outcome.err;
  EXPECT_FALSE(run.exists("taught/good.csv"));
}

TEST(VerbTorqueTest, WhereAHandIsAllTheTimeNothingIsWrittenAndTheReasonSaid) {
  const ToolRun run;
  run.write("held.csv", swinging(10.0, 0.0, 8.0));
  const std::string how = " --side link --effort instant" + kTwoLink;
  const auto outcome = run("torque held.csv -o out.csv --fit arm.yaml" + how);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.err.rfind("arm.yaml: not fitted, nothing written: only ", 0), 0U) << outcome.err;
  EXPECT_FALSE(run.exists("out.csv"));
  EXPECT_FALSE(run.exists("arm.yaml"));
  const auto json = run("torque held.csv -o out.csv --fit arm.yaml --json" + how);
  EXPECT_TRUE(nlohmann::json::parse(json.out)["fit"]["model"].is_null()) << json.out;

  EXPECT_EQ(run("torque held.csv -o out.csv --fit arm.yaml --hand-free 4:2" + how).err,
            "--hand-free is \"4:2\", expected FROM:TO in seconds since the first row, FROM before TO\n");
  EXPECT_EQ(run("torque held.csv -o out.csv --hand-free 2:4" + how).exit_code, 2) << "only with --fit";
}

TEST(VerbTorqueTest, AModelThatWouldDestroyWhatIsReadOrMadeIsRefusedEvenWithForce) {
  const ToolRun run;
  run.write("g.csv", swinging(10.0, 0.4, 0.0));
  const std::string how = " --force --side link --effort instant" + kTwoLink;
  ASSERT_EQ(run("torque g.csv -o z.csv" + how).exit_code, 0);
  run.write("g.json", run.read("z.json"));
  run.write("m.yaml", "format: demo_logger_model/1\n");
  const std::vector<std::string> names = {"g.csv", "g.json", "z.csv", "z.json", "m.yaml"};
  std::vector<std::string> before;
  for (const std::string& name : names) before.push_back(run.read(name));
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"-o z.csv --fit z.csv", "z.csv: would overwrite the output z.csv"},
      {"-o z.csv --fit z.json", "z.json: would overwrite the sidecar of the output z.csv"},
      {"-o z.csv --fit g.csv", "g.csv: would overwrite the input g.csv"},
      {"-o z.csv --fit ./none/../g.json", "./none/../g.json: would overwrite the sidecar of the input g.csv"},
      {"-o z.csv --fit m.yaml --model m.yaml", "m.yaml: would overwrite the input m.yaml"},
      {"-o m.yaml --model m.yaml", "m.yaml: would overwrite the input m.yaml"},
      {"-o g.csv", "g.csv: would overwrite the input g.csv"},
      {"-o g.txt", "g.json: would overwrite the sidecar of the input g.csv"},
  };
  for (const auto& [arguments, sentence] : cases) {
    const auto outcome = run("torque g.csv " + arguments + how);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.err, sentence + ", which --force does not allow either; choose another name\n") << arguments;
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(run.read(names[i]), before[i]) << arguments;
  }
  EXPECT_FALSE(run.exists("g.txt"));
}

TEST(VerbTorqueTest, AnOutputThatCannotBeWrittenLeavesNoModelAndAModelThatCannotNoOutput) {
  const ToolRun run;
  run.write("g.csv", swinging(10.0, 0.4, 0.0));
  const std::string how = " --side link --effort instant" + kTwoLink;
  EXPECT_EQ(run("torque g.csv -o /proc/x.csv --fit y.yaml" + how).exit_code, 2);
  EXPECT_FALSE(run.exists("y.yaml"));
  EXPECT_EQ(run("torque g.csv -o x.csv --fit /proc/y.yaml" + how).exit_code, 2);
  EXPECT_FALSE(run.exists("x.csv"));
  EXPECT_EQ(run("torque g.csv -o new/x.csv --fit new/y.yaml" + how).exit_code, 0) << "in a folder that is made";
  EXPECT_TRUE(run.exists("new/x.csv") && run.exists("new/y.yaml"));
}

TEST(VerbTorqueTest, GivenPartsInWhichAHandPushesAreDoubted) {
  const ToolRun run;
  run.write("held.csv", swinging(10.0, 0.0, 8.0));
  const auto outcome =
      run("torque held.csv -o out.csv --fit arm.yaml --hand-free 0:10 --side link --effort instant" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("  joint_1: what is left in the given parts is "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("; is the hand really away there?\n"), std::string::npos) << outcome.out;
  EXPECT_TRUE(run.exists("arm.yaml")) << "a finding, not a refusal";
}

TEST(VerbTorqueTest, AJointThatTellsNothingHasNothingLeftToPrint) {
  const ToolRun run;
  const RobotModel model(
      describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf", {"base_link", "tool_tip", {}, 9.81}));
  std::string csv = "time,q_joint_1,q_joint_2,tau_joint_1,tau_joint_2\n";
  for (double t = 0.0; t < 6.0; t += 0.01) {
    const Eigen::Vector2d q(0.8 * std::sin(1.5 * t), 0.4), dq(1.2 * std::cos(1.5 * t), 0.0);
    const Eigen::VectorXd torque = model.inverseDynamics(q, dq, Eigen::Vector2d(-1.8 * std::sin(1.5 * t), 0.0));
    csv += std::to_string(t) + "," + std::to_string(q[0]) + ",0.4," + std::to_string(torque[0]) + "," +
           std::to_string(torque[1]) + "\n";
  }
  run.write("still.csv", csv);
  const auto outcome =
      run("torque still.csv -o out.csv --fit arm.yaml --fit-friction --hand-free 0:6 --side motor --effort instant" +
          kTwoLink);
  EXPECT_NE(outcome.out.find("), nothing told N m or N\n"), std::string::npos) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
}

TEST(VerbTorqueTest, AControlPeriodThatNoArmHasIsRefused) {
  const ToolRun run;
  run.write("g.csv", upright(50));
  EXPECT_EQ(run("torque g.csv -o x.csv --effort held --control-period 7" + kTwoLink).exit_code, 2);
  run.write("g.json", R"({"format": "demo_logger/1", "effort": {"timing": "held", "control_period": 1e9}})");
  const auto outcome = run("torque g.csv -o x.csv" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find(" s, expected that of the arm's controller, above 0 and at most 1 s.\n"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(run.exists("x.csv"));
}

}  // namespace
}  // namespace demo_logger
