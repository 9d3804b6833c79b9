// How the nodes of the arm's side start, or refuse to: run as programs, their words read.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <fstream>
#include <sstream>

#include "test/nodes/node_process.h"

namespace demo_logger {
namespace {

std::string readFile(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

struct Ended {
  int exit_code = 0;
  std::string output;
};

Ended runToItsEnd(const std::vector<std::string>& command) {
  NodeProcess process(command, testing::TempDir() + "node_start_test_" + std::to_string(getpid()) + ".log");
  const std::optional<int> exit_code = process.wait();
  EXPECT_TRUE(exit_code) << command.front() << " still runs";
  return {exit_code.value_or(-1), process.output()};
}

std::string pathOf(const std::string& node) { return std::string(DEMO_LOGGER_NODES) + "/" + node; }

Ended startAs(const std::string& name, const std::string& node) {
  return runToItsEnd({pathOf(node), "__name:=" + name});
}

class NodeStartTest : public testing::Test {
 protected:
  void SetUp() override {
    ros::NodeHandle().setParam("robot_description",
                               readFile(std::string(DEMO_LOGGER_SOURCE_DIR) + "/urdf/two_link.urdf"));
    ros::NodeHandle().deleteParam("started");
  }

  /// Starts the node with one private parameter set, and with an axis, which teleop_node does not start without.
  template <typename Value>
  static Ended start(const std::string& node, const std::string& parameter, const Value& value,
                     bool without_axis = false) {
    ros::NodeHandle().deleteParam("started");
    ros::NodeHandle().setParam("started/" + parameter, value);
    if (node == "teleop_node" && !without_axis) ros::NodeHandle().setParam("started/axis_linear", 0);
    return startAs("started", node);
  }
};

void expectRefusal(const Ended& ended, const std::string& sentence) {
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.output, sentence + "\n");
}

TEST_F(NodeStartTest, WithoutAMasterEveryNodeSaysSoInOneLineAndEnds) {
  for (const auto& [node, name] : {std::pair<std::string, std::string>{"simulated_arm_node", "simulated_arm"},
                                   {"teleop_node", "teleop"},
                                   {"keyboard_node", "keyboard"},
                                   {"simulated_human_node", "simulated_human"}}) {
    const Ended ended = runToItsEnd({pathOf(node), "__master:=http://localhost:9"});
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(ended.output, name +
                                ": no ROS master answers at http://localhost:9; start one with roscore, or set "
                                "ROS_MASTER_URI to the one that runs.\n");
  }
}

TEST_F(NodeStartTest, AValueOutOfRangeIsNamedWithWhatWasExpected) {
  expectRefusal(start("simulated_arm_node", "publish_rate", 0),
                "simulated_arm: /started/publish_rate is 0 Hz, expected a number from 1 to 1000 Hz.");
  expectRefusal(start("simulated_arm_node", "control_rate", 50),
                "simulated_arm: /started/control_rate is 50 Hz, expected a whole number from 100 to 4000 Hz.");
  expectRefusal(start("teleop_node", "joy_timeout", -1.0),
                "teleop: /started/joy_timeout is -1 s, expected a number from 0.01 to 60 s.");
  expectRefusal(start("keyboard_node", "joy_rate", 1000),
                "keyboard: /started/joy_rate is 1000 Hz, expected a number from 5 to 500 Hz.");
  expectRefusal(start("simulated_human_node", "reaction_delay", 2.0),
                "simulated_human: /started/reaction_delay is 2 s, expected a number from 0 to 0.5 s.");
}

TEST_F(NodeStartTest, ASeedThatNoParameterCanHoldIsToldTheRange) {
  expectRefusal(runToItsEnd({pathOf("simulated_arm_node"), "__name:=started", "_sensors/seed:=99999999999"}),
                "simulated_arm: /started/sensors/seed is 99999999999, expected a whole number from 0 to 2147483647.");
}

TEST_F(NodeStartTest, AWrongTypeIsNamedWithWhatWasExpected) {
  expectRefusal(start("simulated_arm_node", "publish_clock", std::string("yes")),
                "simulated_arm: /started/publish_clock is the text \"yes\", expected true or false.");
  expectRefusal(start("simulated_arm_node", "sensors", 1.0),
                "simulated_arm: /started/sensors is 1, expected a group of parameters.");
  expectRefusal(start("teleop_node", "enable_button", 1.5),
                "teleop: /started/enable_button is 1.5, expected a whole number from -1 to 63.");
  expectRefusal(start("simulated_human_node", "seed", std::string("one")),
                "simulated_human: /started/seed is the text \"one\", expected a whole number of at least 0.");
}

TEST_F(NodeStartTest, AnUnknownNameIsRefused) {
  for (const std::string node : {"simulated_arm_node", "teleop_node", "keyboard_node", "simulated_human_node"}) {
    ros::NodeHandle().deleteParam("started");
    ros::NodeHandle().setParam("started/axis_linear", 0);
    ros::NodeHandle().setParam("started/device/axis_linear", 0);
    if (node != "teleop_node") ros::NodeHandle().deleteParam("started/axis_linear");
    if (node != "simulated_human_node") ros::NodeHandle().deleteParam("started/device");
    ros::NodeHandle().setParam("started/publsh_rate", 100);
    const Ended ended = startAs("started", node);
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_NE(ended.output.find("/started/publsh_rate is not a parameter that is understood here; known are "),
              std::string::npos)
        << ended.output;
  }
}

TEST_F(NodeStartTest, JointStatesOnlyComeAtControlTicks) {
  expectRefusal(start("simulated_arm_node", "publish_rate", 300),
                "simulated_arm: /started/publish_rate is 300 Hz, expected a whole part of the control rate of "
                "1000 Hz, as joint states are those of control ticks.");
}

TEST_F(NodeStartTest, TheArmFollowsNoOtherClockThanItsOwn) {
  ros::NodeHandle().setParam("/use_sim_time", true);
  const Ended ended = startAs("started", "simulated_arm_node");
  ros::NodeHandle().deleteParam("/use_sim_time");
  expectRefusal(ended,
                "simulated_arm: /use_sim_time is true, expected false unless /started/publish_clock is true: the "
                "simulated arm follows no other simulation's clock.");
}

TEST_F(NodeStartTest, AHandThatCouldNotHoldTheArmIsRefused) {
  expectRefusal(start("simulated_human_node", "task", std::string("juggle")),
                "simulated_human: /started/task is \"juggle\", expected one of teleoperation, reach, arc, peg.");
  ros::NodeHandle().setParam("started/task", "reach");
  ros::NodeHandle().setParam("started/damping", 2.0);
  expectRefusal(
      startAs("started", "simulated_human_node"),
      "simulated_human: simulated hand: damping is 2 N s/m, expected from 5 to 1000 N s/m with a stiffness of "
      "500, or a hand that sees the arm 10 ms late would swing up.");
}

TEST_F(NodeStartTest, AnImpedanceThatCouldNotBeHeldIsRefused) {
  ros::NodeHandle().deleteParam("started");
  ros::NodeHandle().setParam("started/impedance/damping", std::vector<double>{1e4});
  const Ended ended = startAs("started", "simulated_arm_node");
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.output.rfind("simulated_arm: impedance: damping of ", 0), 0U) << ended.output;
  ros::NodeHandle().setParam("started/impedance/damping", std::vector<double>{-1.0});
  expectRefusal(startAs("started", "simulated_arm_node"),
                "simulated_arm: /started/impedance/damping[0] is -1 N m s/rad or N s/m, expected a number from 0 to "
                "1e+09 N m s/rad or N s/m.");
}

TEST_F(NodeStartTest, ADeviceWithoutAxesIsRefused) {
  expectRefusal(start("teleop_node", "dead_zone", 0.1, /*without_axis=*/true),
                "teleop: /started/axis_linear and axis_angular name no axis of the device, expected at least one "
                "(config/teleop.yaml has an example), or axes and gain.");
}

TEST_F(NodeStartTest, WithoutAUrdfTheArmSaysWhereItLooked) {
  ros::NodeHandle().deleteParam("robot_description");
  expectRefusal(startAs("started", "simulated_arm_node"),
                "simulated_arm: /started/robot_description is not set, here or in a namespace above, expected the URDF "
                "of the arm as a text.");
}

TEST_F(NodeStartTest, AnArmThatCannotBeIsRefusedInTheWordsOfTheLibrary) {
  const Ended ended = start("simulated_arm_node", "tip", std::string("nowhere"));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_NE(ended.output.find("nowhere"), std::string::npos) << ended.output;
}

TEST_F(NodeStartTest, TheKeyboardNeedsATerminal) {
  expectRefusal(runToItsEnd({"sh", "-c", "exec " + pathOf("keyboard_node") + " </dev/null"}),
                "keyboard: standard input is not a terminal, expected one to read keys from; start it with rosrun in a "
                "terminal, or in a launch file with launch-prefix=\"xterm -e\".");
}

}  // namespace
}  // namespace demo_logger
