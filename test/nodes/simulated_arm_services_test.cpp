// What one may do to a simulated arm besides commanding it, and what it does when it is treated badly.
#include <demo_logger/ApplyWrench.h>
#include <demo_logger/SetLoad.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Float64MultiArray.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "test/nodes/node_process.h"
#include "test/nodes/simulated_arm_under_test.h"

namespace demo_logger {
namespace {

class SimulatedArmServicesTest : public SimulatedArmNodeTest {
 protected:
  SetLoad::Response setLoad(double mass, double moment = 1e-3) {
    SetLoad call;
    call.request.load.m = mass;
    call.request.load.ixx = call.request.load.iyy = call.request.load.izz = moment;
    EXPECT_TRUE(ros::service::call(node.resolveName("simulated_arm/set_load"), call));
    return call.response;
  }

  ApplyWrench::Response push(const std::string& link, double fy, double duration, const std::string& axes = "") {
    ApplyWrench call;
    call.request.link = link;
    call.request.wrench.header.frame_id = axes;
    call.request.wrench.wrench.force.y = fy;
    call.request.duration = ros::Duration(duration);
    EXPECT_TRUE(ros::service::call(node.resolveName("simulated_arm/apply_wrench"), call));
    return call.response;
  }

  Listener<sensor_msgs::JointState> human_torque{node, "ground_truth/human_torque"};
};

TEST_F(SimulatedArmServicesTest, ALoadIsHeldAndPutDown) {
  ASSERT_TRUE(applied.wait());
  const double before = applied.last().torque[1];
  const SetLoad::Response taken = setLoad(2.0);
  EXPECT_TRUE(taken.success) << taken.message;
  EXPECT_EQ(taken.message, "the arm carries the load from the next control tick on.");
  EXPECT_TRUE(applied.waitUntil([&](const AppliedCommand& tick) { return tick.torque[1] < before - 5.0; }))
      << "[N m] on the shoulder";
  EXPECT_EQ(setLoad(0.0).message, "the hand is empty from the next control tick on.");
  EXPECT_TRUE(applied.waitUntil([&](const AppliedCommand& tick) { return std::abs(tick.torque[1] - before) < 1e-3; }));
}

TEST_F(SimulatedArmServicesTest, AnImpossibleLoadIsAnsweredInASentence) {
  const SetLoad::Response response = setLoad(-1.0);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("mass"), std::string::npos) << response.message;
}

TEST_F(SimulatedArmServicesTest, AWrenchActsForItsDurationAndIsInTheGroundTruth) {
  ros::Publisher efforts = advertise<std_msgs::Float64MultiArray>("joint_group_effort_controller/command");
  EXPECT_TRUE(setMode("effort").success);
  std_msgs::Float64MultiArray compliant;  // gravity compensation alone
  compliant.data = std::vector<double>(7, 0.0);
  ASSERT_TRUE(send(efforts, compliant, [](const AppliedCommand& tick) { return tick.reason.empty(); }));

  const ApplyWrench::Response response = push("tool_tip", 15.0, 0.2);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_TRUE(human_torque.waitUntil([](const auto& truth) { return truth.effort[0] > 1.0; }));
  EXPECT_TRUE(human_torque.waitUntil([](const auto& truth) { return truth.effort == std::vector<double>(7, 0.0); }));
  EXPECT_TRUE(joint_states.waitUntil([](const auto& state) {
    return std::abs(state.position[0]) + std::abs(state.position[2]) + std::abs(state.position[4]) > 1e-3;
  })) << "and it has moved the compliant arm";
}

TEST_F(SimulatedArmServicesTest, ACompliantArmIsPushedAndNeedsNoCommand) {
  EXPECT_TRUE(setMode("gravity_compensation").success);
  const auto complies = [](const AppliedCommand& tick) {
    return tick.mode == "gravity_compensation" && tick.reason.empty() && tick.command.empty() && tick.name.empty() &&
           tick.torque.size() == 7;
  };
  ASSERT_TRUE(applied.waitUntil(complies));
  EXPECT_TRUE(push("tool_tip", 15.0, 0.2).success);
  EXPECT_TRUE(joint_states.waitUntil([](const auto& state) {
    return std::abs(state.position[0]) + std::abs(state.position[2]) + std::abs(state.position[4]) > 1e-2;
  }));
}

TEST_F(SimulatedArmServicesTest, AnArmWithSpringsComesBackFromAPush) {
  ASSERT_TRUE(joint_states.wait());
  const SetControlMode::Response response = setMode("impedance", {50.0}, {0.2});
  ASSERT_TRUE(response.success) << response.message;
  ASSERT_TRUE(applied.waitUntil([](const AppliedCommand& tick) { return tick.mode == "impedance"; }));
  const std::vector<double> rest = applied.last().command;
  ASSERT_EQ(rest.size(), 7U);
  EXPECT_EQ(applied.last().name.front(), "joint_1");
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(rest[i], kInitialPosition[i], 1e-6);
  EXPECT_TRUE(push("tool_tip", 15.0, 0.2).success);
  const auto off = [&](const sensor_msgs::JointState& state) { return std::abs(state.position[0] - rest[0]); };
  EXPECT_TRUE(joint_states.waitUntil([&](const auto& state) { return off(state) > 1e-2; }));
  EXPECT_TRUE(joint_states.waitUntil([&](const auto& state) {
    return off(state) < 0.6 / 50.0 + 1e-3 && std::abs(state.velocity[0]) < 1e-3;
  })) << "but for what its friction of 0.6 N m holds against 50 N m/rad";
}

TEST_F(SimulatedArmServicesTest, GainsThatCannotBeHeldAreRefusedInASentence) {
  ASSERT_TRUE(applied.waitUntil([](const AppliedCommand& tick) { return tick.mode == "cartesian_velocity"; }));
  const SetControlMode::Response stiff = setMode("impedance", {}, {30.0});
  EXPECT_FALSE(stiff.success);
  EXPECT_EQ(stiff.message.rfind("impedance: damping of joint_7 is 30 N m s/rad, expected at most ", 0), 0U)
      << stiff.message;
  EXPECT_EQ(
      setMode("impedance", {1.0, 2.0}).message,
      "impedance: stiffness has 2 values, expected one for each of the 7 joints, one for all of them, or none for "
      "the defaults.");
  EXPECT_EQ(setMode("gravity_compensation", {1.0}).message,
            "mode gravity_compensation takes neither stiffness nor damping, expected both empty.");
  const std::uint64_t asked = applied.last().tick;
  ASSERT_TRUE(applied.waitUntil([&](const AppliedCommand& tick) { return tick.tick > asked + 20; }));
  EXPECT_EQ(applied.last().mode, "cartesian_velocity") << "and nothing has changed";
}

TEST_F(SimulatedArmServicesTest, ImpossibleWrenchesAreAnsweredInASentence) {
  EXPECT_EQ(push("no_link", 1.0, 1.0).message, "a wrench acts upon \"no_link\", no link of this robot.");
  EXPECT_LT(push(std::string(100000, 'x'), 1.0, 1.0).message.size(), 200U) << "no more than tells which";
  EXPECT_EQ(push("base_link", 1.0, 1.0).message, "a wrench acts upon \"base_link\", which this arm does not move.");
  EXPECT_EQ(push("link_3", 1.0, 1.0, "link_5").message,
            "the wrench is in the axes of \"link_5\", expected \"link_3\" or \"base_link\".");
  EXPECT_EQ(push("link_3", 1.0, 0.0).message, "duration is 0 s, expected above 0, at most 3600 s.");
  EXPECT_EQ(push("link_3", std::numeric_limits<double>::quiet_NaN(), 1.0).message,
            "the wrench has a component that is not a number.");
}

TEST_F(SimulatedArmServicesTest, AHandPushesThroughHumanWrenchUntilItsMessagesEnd) {
  ros::Publisher hand = advertise<geometry_msgs::WrenchStamped>("human_wrench");
  geometry_msgs::WrenchStamped wrench;
  wrench.header.frame_id = "link_2";
  wrench.wrench.torque.x = 2.0;  // in the axes of link 2
  const auto pushes = [&] {
    hand.publish(wrench);
    return !human_torque.messages().empty() && std::abs(human_torque.last().effort[0]) > 0.1;
  };
  EXPECT_TRUE(waitFor(pushes));
  EXPECT_EQ(human_torque.last().effort[2], 0.0) << "joints beyond the link feel nothing of it";
  EXPECT_TRUE(human_torque.waitUntil([](const auto& truth) { return truth.effort == std::vector<double>(7, 0.0); }));

  wrench.header.frame_id = "nowhere";
  EXPECT_TRUE(send(hand, wrench, [](const AppliedCommand& tick) {
    return tick.reason.find(refusal("a wrench acts upon \"nowhere\", no link of this robot")) != std::string::npos;
  })) << applied.last().reason;
}

TEST_F(SimulatedArmServicesTest, NotANumberIsRefusedAndTheArmStays) {
  ros::Publisher publisher = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  EXPECT_TRUE(send(publisher, makeStamped(std::numeric_limits<double>::quiet_NaN()), [](const AppliedCommand& tick) {
    return tick.reason.find(refusal("vy in a cartesian_velocity command is nan m/s")) != std::string::npos &&
           tick.command == std::vector<double>(6, 0.0);
  })) << applied.last().reason;
}

TEST_F(SimulatedArmServicesTest, TenThousandCommandsASecondCostNoTickAndAreCounted) {
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics(node, "/diagnostics");
  ros::Publisher flood = advertise<std_msgs::Float64MultiArray>("joint_group_velocity_controller/command");
  ros::Publisher sound = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  std_msgs::Float64MultiArray wrong;  // for another mode than the one in force
  wrong.data = std::vector<double>(7, 1.0);
  applied.forget();
  geometry_msgs::TwistStamped twist = makeStamped(0.02);
  constexpr int kFlood = 10'000;
  const ros::WallTime start = ros::WallTime::now();
  int sent = 0;
  ASSERT_TRUE(waitFor([&] {  // as many as are due by now, for a second
    const double elapsed = (ros::WallTime::now() - start).toSec();
    for (; sent < kFlood && sent < elapsed * kFlood; ++sent) flood.publish(wrong);
    stamp(twist, ros::Time::now());
    sound.publish(twist);
    return sent == kFlood;
  }));
  EXPECT_TRUE(send(sound, twist, [](const AppliedCommand& tick) { return tick.command[1] == 0.02; }))
      << "the sound commands among them were obeyed: " << applied.last().reason;
  const std::vector<AppliedCommand>& ticks = applied.messages();
  std::size_t said = 0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    ASSERT_EQ(ticks[i].tick, ticks[i - 1].tick + 1);
    if (ticks[i].reason.find(refusal("a command for mode velocity came while")) != std::string::npos) ++said;
    ASSERT_EQ(ticks[i].mode, "cartesian_velocity");
  }
  EXPECT_GT(said, 100U);
  const auto levelOfCommands = [](const diagnostic_msgs::DiagnosticArray& array, std::string& summary) {
    for (const auto& status : array.status) {
      for (const auto& value : status.values) {
        if (value.key != "refused" || std::atol(value.value.c_str()) < 1000) continue;
        summary = status.message;
        return static_cast<int>(status.level);
      }
    }
    return -1;
  };
  EXPECT_TRUE(diagnostics.waitUntil([&](const diagnostic_msgs::DiagnosticArray& array) {
    std::string summary;
    return levelOfCommands(array, summary) == diagnostic_msgs::DiagnosticStatus::WARN &&
           summary.find(" refused lately, the last: ") != std::string::npos &&
           summary.find(refusal("a command for mode velocity came while mode cartesian_velocity is in force")) !=
               std::string::npos;
  }));
  EXPECT_TRUE(diagnostics.waitUntil([&](const diagnostic_msgs::DiagnosticArray& array) {
    std::string summary;
    return levelOfCommands(array, summary) == diagnostic_msgs::DiagnosticStatus::OK;
  })) << "once the refusals are over";
}

TEST_F(SimulatedArmServicesTest, AnotherUrdfNeedsNoOtherArgumentAndItsFloorIsNoticed) {
  Listener<sensor_msgs::JointState> others(ros::NodeHandle("other"), "joint_states");
  EXPECT_TRUE(others.waitUntil([](const sensor_msgs::JointState& state) {
    return state.name == std::vector<std::string>{"joint_1", "joint_2"};
  }));
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics(node, "/diagnostics");
  EXPECT_TRUE(diagnostics.waitUntil([](const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) {
      if (status.name != "other/simulated_arm: surroundings" && status.name != "simulated_arm: surroundings") continue;
      return status.level == diagnostic_msgs::DiagnosticStatus::WARN &&
             status.message.find(" mm inside the floor, which pushes it out; ") != std::string::npos;
    }
    return false;
  }));
}

TEST_F(SimulatedArmServicesTest, AnotherArmGoesOnFromASavedState) {
  EXPECT_TRUE(setMode("velocity").success);
  ASSERT_TRUE(push("link_4", 30.0, 30.0).success);  // so that it moves and remembers
  ASSERT_TRUE(human_torque.waitUntil([](const auto& truth) { return std::abs(truth.effort[0]) > 1.0; }));
  std_srvs::Trigger save;
  ASSERT_TRUE(ros::service::call(node.resolveName("simulated_arm/save_state"), save));
  ASSERT_TRUE(save.response.success) << save.response.message;
  const std::string file = save.response.message;
  EXPECT_NE(file.find("arm_state_0"), std::string::npos);

  ros::NodeHandle second_namespace("second");
  second_namespace.setParam("robot_description", ros::NodeHandle().param<std::string>("robot_description", ""));
  ros::NodeHandle second("second/simulated_arm");
  second.setParam("base", "base_link");
  second.setParam("tip", "tool_tip");
  second.setParam("initial_state", file);
  second.setParam("command_timeout", 0.5);
  Listener<AppliedCommand> others(second_namespace, "applied_command");
  NodeProcess process({std::string(DEMO_LOGGER_NODES) + "/simulated_arm_node", "__ns:=second", "__name:=simulated_arm"},
                      testing::TempDir() + "second_arm_" + std::to_string(getpid()) + ".log");
  ASSERT_TRUE(others.wait(200)) << process.output();

  std::map<std::uint64_t, AppliedCommand> mine;
  for (const AppliedCommand& tick : applied.messages()) mine[tick.tick] = tick;
  std::size_t compared = 0;
  for (const AppliedCommand& tick : others.messages()) {
    const auto same = mine.find(tick.tick);
    if (same == mine.end()) continue;
    EXPECT_EQ(tick.torque, same->second.torque) << "tick " << tick.tick << ", bit for bit";
    EXPECT_EQ(tick.mode, "velocity");
    ++compared;
  }
  EXPECT_GT(compared, 100U);
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), 0) << process.output();
  EXPECT_NE(process.output().find("of them started more than a period late"), std::string::npos) << process.output();
  std::filesystem::remove(file);
}

/// One whose driver is bad.
class FaultyArmTest : public SimulatedArmNodeTest {
 protected:
  FaultyArmTest() : SimulatedArmNodeTest("faulty") {}
};

TEST_F(FaultyArmTest, ItsJointStatesAreTheTruthInDisorder) {
  Listener<sensor_msgs::JointState> truth(node, "ground_truth/joint_states");
  ASSERT_TRUE(truth.wait(500));
  ASSERT_TRUE(joint_states.wait(500));
  std::map<ros::Time, std::map<std::string, double>> positions;
  for (const auto& state : truth.messages()) {
    for (std::size_t i = 0; i < state.name.size(); ++i)
      positions[state.header.stamp][state.name[i]] = state.position[i];
  }
  std::set<std::set<std::string>> groups;
  std::size_t zero_stamped = 0;
  std::size_t permuted = 0;
  std::size_t compared = 0;
  for (const auto& state : joint_states.messages()) {
    groups.insert({state.name.begin(), state.name.end()});
    if (!std::is_sorted(state.name.begin(), state.name.end())) ++permuted;
    if (state.header.stamp.isZero()) {
      ++zero_stamped;
      continue;
    }
    const auto true_state = positions.find(state.header.stamp);
    if (true_state == positions.end() || state.name[0] == "finger") continue;
    for (std::size_t i = 0; i < state.name.size(); ++i) {
      ASSERT_EQ(state.position[i], true_state->second[state.name[i]]);
      ++compared;
    }
  }
  const std::set<std::set<std::string>> expected{
      {"joint_1", "joint_2", "joint_3"}, {"joint_4", "joint_5", "joint_6", "joint_7"}, {"finger"}};
  EXPECT_EQ(groups, expected);
  EXPECT_GT(zero_stamped, 10U);
  EXPECT_GT(permuted, 50U);
  EXPECT_GT(compared, 500U);
}

}  // namespace
}  // namespace demo_logger
