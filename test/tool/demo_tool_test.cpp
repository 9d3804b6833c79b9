#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/String.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "test/tool/tool_run.h"

// demo_tool as a user's shell sees it: exit codes, what goes to which stream, nothing half-written.

namespace demo_logger {
namespace {

using Outcome = ToolRun::Outcome;

sensor_msgs::JointState elbowAt(int i, double position) {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(100, 10'000'000U * static_cast<unsigned>(i));
  message.name = {"elbow"};
  message.position = {position};
  return message;
}

class DemoToolTest : public testing::Test {
 protected:
  DemoToolTest() {
    rosbag::Bag bag(path("motion.bag"), rosbag::bagmode::Write);
    for (int i = 0; i < 100; ++i) bag.write("/joint_states", elbowAt(i, 0.01 * i).header.stamp, elbowAt(i, 0.01 * i));
  }

  std::string path(const std::string& name) const { return run.path(name); }
  std::string read(const std::string& name) const { return run.read(name); }

  const ToolRun run;
};

TEST_F(DemoToolTest, EveryVerbExplainsItselfWithAnExample) {
  const Outcome all = run("--help");
  EXPECT_EQ(all.exit_code, 0);
  for (const std::string verb : {"import", "info", "check", "recover", "kinematics", "ik", "torque"}) {
    EXPECT_NE(all.out.find(verb), std::string::npos);
    const Outcome help = run(verb + " --help");
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_NE(help.out.find("Example: demo_tool " + verb), std::string::npos) << help.out;
    EXPECT_EQ(help.err, "");
  }
}

TEST_F(DemoToolTest, WrongUsageIsExitCodeTwoOnStandardError) {
  const std::vector<std::string> wrong = {"",
                                          "fly",
                                          "import",
                                          "import " + path("motion.bag"),
                                          "info",
                                          "import x.bag -o d --max-wait=-1",
                                          "import x.bag -o d --channel telepathy",
                                          "import x.bag -o d --frobnicate"};
  for (const std::string& arguments : wrong) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_NE(outcome.err, "") << arguments;
  }
}

TEST_F(DemoToolTest, ImportThenInfoTellsRowsRateAndFiles) {
  const Outcome imported = run("import " + path("motion.bag") + " -o " + path("demos"));
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_NE(imported.out.find("demo_000001.csv: 100 rows, 0.99 s, complete"), std::string::npos) << imported.out;
  EXPECT_EQ(imported.err, "");

  const Outcome info = run("info " + path("demos"));
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_NE(info.out.find("100 rows in 0.990 s: 100.0 Hz, largest gap 10.0 ms"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("columns: time q_elbow dq_elbow tau_elbow receipt_delay"), std::string::npos) << info.out;
  EXPECT_NE(info.out.find("demo_000001.json"), std::string::npos) << info.out;
}

TEST_F(DemoToolTest, AnImportTakesWhatTheEffortsMeanFromTheCommandLineForOnlyItKnows) {
  const std::string import = "import " + path("motion.bag") + " -o ";
  const Outcome refused = run(import + "held --effort held");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("control_period is 0 s, expected that of the arm's controller"), std::string::npos)
      << refused.err;
  EXPECT_FALSE(run.exists("held"));

  ASSERT_EQ(run(import + "held --effort held --side link --control-period 0.002").exit_code, 0);
  const auto sidecar = nlohmann::json::parse(read("held/demo_000001.json"));
  EXPECT_EQ(sidecar["effort"]["timing"], "held");
  EXPECT_EQ(sidecar["effort"]["side"], "link");
  EXPECT_EQ(sidecar["effort"]["control_period"], 0.002);
  EXPECT_EQ(sidecar["provenance"]["steps"][0], "import --effort held --side link --control-period 0.002");
}

TEST_F(DemoToolTest, FaultsOfWhatWasImportedAreAFinding) {
  {
    rosbag::Bag bag(path("faulty.bag"), rosbag::bagmode::Write);
    for (int i = 0; i < 100; ++i) {
      const double position = i == 50 ? std::nan("") : 0.01 * i;
      bag.write("/joint_states", elbowAt(i, position).header.stamp, elbowAt(i, position));
    }
  }
  const Outcome imported = run("import " + path("faulty.bag") + " -o " + path("demos"));
  EXPECT_EQ(imported.exit_code, 1) << imported.err;
  EXPECT_NE(imported.out.find("not finite"), std::string::npos) << imported.out;
  EXPECT_TRUE(run.exists("demos/demo_000001.csv"));
}

TEST_F(DemoToolTest, OneUnreadableRecordingDoesNotKeepTheOthersFromTheirTurn) {
  ASSERT_EQ(run("import " + path("motion.bag") + " -o " + path("demos")).exit_code, 0);
  std::ofstream(path("demos/broken.csv")) << "time,q_elbow\n0,1\n0.1\n";
  for (const std::string verb : {"info", "check"}) {
    const Outcome outcome = run(verb + " " + path("demos"));
    EXPECT_EQ(outcome.exit_code, 2) << verb;
    EXPECT_NE(outcome.out.find("demo_000001.csv"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.err.find("broken.csv:3: "), std::string::npos) << outcome.err;
    const auto recordings = nlohmann::json::parse(run(verb + " --json " + path("demos")).out)["recordings"];
    ASSERT_EQ(recordings.size(), 2U);
    EXPECT_NE(recordings[0]["error"].get<std::string>().find("broken.csv:3: "), std::string::npos);
    EXPECT_EQ(recordings[1].count("error"), 0U);
  }
}

TEST_F(DemoToolTest, WhatFollowsFromTheColumnNamesAloneIsSaidToBeSo) {
  ASSERT_EQ(run("import " + path("motion.bag") + " -o " + path("demos")).exit_code, 0);
  std::filesystem::remove(path("demos/demo_000001.json"));
  const Outcome checked = run("check " + path("demos"));
  EXPECT_NE(checked.out.find("demo_000001.csv: note: "), std::string::npos) << checked.out;
  const Outcome info = run("info " + path("demos"));
  EXPECT_NE(info.out.find("note: "), std::string::npos) << info.out;
  EXPECT_EQ(info.out.find("complete"), std::string::npos) << "nobody knows whether it is: " << info.out;
}

TEST_F(DemoToolTest, JsonIsOneObjectAndNothingElse) {
  const Outcome imported = run("import " + path("motion.bag") + " -o " + path("demos") + " --json");
  const auto bags = nlohmann::json::parse(imported.out);
  EXPECT_EQ(bags["bags"][0]["episodes"][0]["rows"], 100);
  EXPECT_EQ(bags["bags"][0]["joint_states"], "/joint_states");

  const auto info = nlohmann::json::parse(run("info --json " + path("demos/demo_000001.csv")).out);
  const auto& recording = info["recordings"][0];
  EXPECT_EQ(recording["rows"], 100);
  EXPECT_DOUBLE_EQ(recording["duration"], 0.99);
  EXPECT_NEAR(recording["rate"], 100.0, 1e-9);
  EXPECT_NEAR(recording["largest_gap"], 0.01, 1e-9);
  EXPECT_EQ(recording["files"].size(), 2U);

  const auto recovered = nlohmann::json::parse(run("recover --json " + path("demos")).out);
  EXPECT_TRUE(recovered["recovered"].empty());
}

TEST_F(DemoToolTest, ABagAmongOthersThatIsRefusedLeavesNothingWritten) {
  {
    rosbag::Bag bag(path("chat.bag"), rosbag::bagmode::Write);
    bag.write("/chat", ros::Time(1, 0), std_msgs::String());
  }
  const Outcome outcome = run("import " + path("motion.bag") + " " + path("chat.bag") + " -o " + path("demos"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, path("chat.bag") +
                             ": no joint states (sensor_msgs/JointState) to make rows of; it holds /chat "
                             "(std_msgs/String, 1)\n");
  EXPECT_FALSE(run.exists("demos"));
}

TEST_F(DemoToolTest, WhatIsNotThereIsOneSentence) {
  EXPECT_EQ(run("import " + path("gone.bag") + " -o " + path("demos")).err, path("gone.bag") + ": no such file\n");
  EXPECT_EQ(run("info " + path("gone.csv")).err, path("gone.csv") + ": no such file or directory\n");
  EXPECT_EQ(run("recover " + path("gone")).err, path("gone") + ": no such directory\n");
  std::filesystem::create_directory(path("empty"));
  const Outcome outcome = run("info " + path("empty"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err, path("empty") + ": no recording (*.csv) in this directory\n");
}

TEST_F(DemoToolTest, CheckEndsWithOneWhereItFindsSomethingAndWithZeroWhereNot) {
  run.write("good.csv", "time,q_elbow,dq_elbow\n0,0,1\n0.01,0.01,1\n0.02,0.02,1\n0.03,0.03,1\n");
  run.write("bad.csv", "time,q_elbow,dq_elbow\n0,0,1\n0.01,0.01,1\n0.02,0.02,1\n2.02,2.02,1\n");
  const Outcome good = run("check " + path("good.csv"));
  EXPECT_EQ(good.exit_code, 0) << good.out;
  EXPECT_EQ(good.out, path("good.csv") + ": note: " + path("good.json") +
                          ": is not there; units, roles and interpolation follow from the columns' names.\n" +
                          path("good.csv") + ": nothing found wrong in 4 rows\n");

  const Outcome bad = run("check " + path("good.csv") + " " + path("bad.csv"));
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.out.find(path("bad.csv") + ": error: "), std::string::npos) << bad.out;

  const auto json = nlohmann::json::parse(run("check --json " + path("bad.csv")).out);
  EXPECT_EQ(json["recordings"][0]["findings"][0]["kind"], "gap") << json.dump(2);
  EXPECT_EQ(run("check " + path("gone.csv")).exit_code, 2);
}

TEST_F(DemoToolTest, TwoStreamsMayBeAskedForAndBagsMayFollowThem) {
  const Outcome outcome = run("import -o " + path("demos") +
                              " --stream a=/joint_states --stream b=/joint_states:nearest " + path("motion.bag"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Outcome info = run("info " + path("demos"));
  EXPECT_NE(info.out.find(" a_elbow a_age b_elbow b_age"), std::string::npos) << info.out;
}

TEST_F(DemoToolTest, WhatAKilledRecorderLeftIsFinished) {
  std::filesystem::create_directory(path("demos"));
  run.write("demos/demo_000001.csv.part", "time,q_elbow\n0,1\n0.5,2\n1,");
  run.write("demos/demo_000001.json.part", R"({"format": "demo_logger/1", "id": "demo_000001"})");
  const Outcome outcome = run("recover " + path("demos"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            path("demos/demo_000001.csv") + ": 2 rows, interrupted: killed; 2 bytes of an incomplete row dropped\n");
  EXPECT_EQ(run("recover " + path("demos")).out, "nothing to recover\n");
  EXPECT_NE(run("info " + path("demos")).out.find("interrupted: killed"), std::string::npos);
}

}  // namespace
}  // namespace demo_logger
