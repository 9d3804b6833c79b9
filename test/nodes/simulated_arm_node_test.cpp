#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <std_srvs/Empty.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <cmath>
#include <set>

#include "test/nodes/simulated_arm_under_test.h"

namespace demo_logger {
namespace {

/// One that is sent plain twists.
class PlainTwistTest : public SimulatedArmNodeTest {
 protected:
  PlainTwistTest() : SimulatedArmNodeTest("plain") {}
};

/// One that is sent what is no twist.
class WrongTypeTest : public SimulatedArmNodeTest {
 protected:
  WrongTypeTest() : SimulatedArmNodeTest("wrong") {}
};

TEST_F(SimulatedArmNodeTest, JointStatesCarryEveryJointWithPositionVelocityAndEffort) {
  ASSERT_TRUE(joint_states.wait(10));
  const sensor_msgs::JointState& state = joint_states.last();
  EXPECT_EQ(state.name,
            (std::vector<std::string>{"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6", "joint_7"}));
  EXPECT_EQ(state.position.size(), 7U);
  EXPECT_EQ(state.velocity.size(), 7U);
  EXPECT_LT(state.effort[1], -20.0) << "[N m], gravity on the shoulder";
}

TEST_F(SimulatedArmNodeTest, TicksComeOneByOneExactlyAPeriodApartOnTheRosClock) {
  applied.forget();
  ASSERT_TRUE(applied.wait(1000));
  const std::vector<AppliedCommand>& ticks = applied.messages();
  std::size_t exact = 0;
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    ASSERT_EQ(ticks[i].tick, ticks[i - 1].tick + 1) << "no tick is left out";
    if (ticks[i].header.stamp - ticks[i - 1].header.stamp == ros::Duration(0, 1'000'000)) ++exact;
  }
  EXPECT_GE(exact + 20, ticks.size() - 1) << "only a stalled machine may leave a gap";
  EXPECT_LT(std::abs((ros::Time::now() - ticks.back().header.stamp).toSec()), 5.0);
  EXPECT_EQ(ticks.back().header.frame_id, "base_link");
}

TEST_F(SimulatedArmNodeTest, JointStatesAreThoseOfTicksWithTheTorqueHeldFromThen) {
  applied.forget();
  joint_states.forget();
  Listener<sensor_msgs::JointState> truth(node, "ground_truth/joint_states");
  ASSERT_TRUE(truth.wait(50));
  ASSERT_TRUE(joint_states.wait(50));
  ASSERT_TRUE(applied.wait(100));
  std::size_t matched = 0;
  for (const sensor_msgs::JointState& state : joint_states.messages()) {
    for (const AppliedCommand& tick : applied.messages()) {
      if (tick.header.stamp != state.header.stamp) continue;
      EXPECT_EQ(tick.torque, state.effort);
      ++matched;
    }
  }
  EXPECT_GE(matched, 40U);
  matched = 0;
  for (const sensor_msgs::JointState& state : truth.messages()) {
    for (const sensor_msgs::JointState& sensed : joint_states.messages()) {
      if (sensed.header.stamp != state.header.stamp) continue;
      EXPECT_EQ(sensed.position, state.position) << "without noise in the configuration";
      ++matched;
    }
  }
  EXPECT_GE(matched, 40U);
}

TEST_F(SimulatedArmNodeTest, AStampedTwistMovesTheTool) {
  ros::Publisher publisher = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  geometry_msgs::TwistStamped twist = makeStamped(0.05);
  twist.header.frame_id = "base_link";
  const std::vector<double> expected{0.0, 0.05, 0.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(send(publisher, twist, [&](const AppliedCommand& tick) {
    return tick.reason.empty() && tick.command == expected && tick.mode == "cartesian_velocity";
  })) << applied.last().reason;
  EXPECT_EQ(applied.last().name, (std::vector<std::string>{"vx", "vy", "vz", "wx", "wy", "wz"}));
  EXPECT_TRUE(joint_states.waitUntil([](const auto& state) { return std::abs(state.velocity[0]) > 0.03; }));
}

TEST_F(PlainTwistTest, MovesTheTool) {
  ros::Publisher publisher = advertise<geometry_msgs::Twist>("teleop_cmd");
  const std::vector<double> expected{0.0, -0.05, 0.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(send(publisher, makeTwist(-0.05), [&](const AppliedCommand& tick) {
    return tick.reason.empty() && tick.command == expected;
  })) << applied.last().reason;
}

TEST_F(SimulatedArmNodeTest, AStaleStampIsRefusedWithItsAge) {
  ros::Publisher publisher = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  EXPECT_TRUE(send(
      publisher, makeStamped(0.05),
      [](const AppliedCommand& tick) {
        return tick.reason.rfind(refusal("the stamp of a command is 3"), 0) == 0 && tick.command[1] == 0.0;
      },
      ros::Duration(3.0)))
      << applied.last().reason;
}

TEST_F(WrongTypeTest, MovesNothing) {
  ros::Publisher publisher = advertise<std_msgs::Float64MultiArray>("teleop_cmd");
  std_msgs::Float64MultiArray numbers;
  numbers.data = {1.0, 1.0};
  publisher.publish(numbers);
  applied.forget();
  ASSERT_TRUE(applied.wait(200));
  for (const AppliedCommand& tick : applied.messages()) EXPECT_EQ(tick.command, std::vector<double>(6, 0.0));
}

TEST_F(SimulatedArmNodeTest, WhenStampedCommandsEndTheArmBrakesByTheirStamps) {
  ros::Publisher publisher = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  const ros::Duration on_the_way(0.1);  // so that the stamp is too old before the receipt is
  ASSERT_TRUE(send(
      publisher, makeStamped(0.05), [](const AppliedCommand& tick) { return tick.command[1] == 0.05; }, on_the_way));
  EXPECT_TRUE(applied.waitUntil([](const AppliedCommand& tick) {
    return tick.reason == "the last command is older than 0.3 s by its stamp" && std::abs(tick.command[1]) < 1e-6;
  })) << applied.last().reason;
}

TEST_F(PlainTwistTest, EndAndTheArmBrakesByTheirReceipt) {
  ros::Publisher publisher = advertise<geometry_msgs::Twist>("teleop_cmd");
  ASSERT_TRUE(send(publisher, makeTwist(0.05), [](const AppliedCommand& tick) { return tick.command[1] == 0.05; }));
  EXPECT_TRUE(applied.waitUntil([](const AppliedCommand& tick) {
    return tick.reason == "no command for 0.5 s" && std::abs(tick.command[1]) < 1e-6;
  })) << applied.last().reason;
}

TEST_F(SimulatedArmNodeTest, InModeVelocityJointCommandsMoveItAndTwistsAreRefused) {
  ros::Publisher joints = advertise<std_msgs::Float64MultiArray>("joint_group_velocity_controller/command");
  const SetControlMode::Response response = setMode("velocity");
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.message, "mode velocity is in force from the next control tick on.");
  std_msgs::Float64MultiArray command;
  command.data = {0.1, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1};
  EXPECT_TRUE(send(joints, command, [&](const AppliedCommand& tick) {
    return tick.mode == "velocity" && tick.command == command.data && tick.name.front() == "joint_1";
  })) << applied.last().reason;

  ros::Publisher twists = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  EXPECT_TRUE(send(twists, makeStamped(0.05), [](const AppliedCommand& tick) {
    return tick.reason.rfind(refusal("a command for mode cartesian_velocity came while mode velocity is in force"),
                             0) == 0;
  })) << applied.last().reason;
}

TEST_F(SimulatedArmNodeTest, InModeEffortCommandsComeOnTopOfGravity) {
  ASSERT_TRUE(joint_states.wait());
  std_msgs::Float64MultiArray command;
  command.data = std::vector<double>(7, 0.0);
  ros::Publisher joints = advertise<std_msgs::Float64MultiArray>("joint_group_effort_controller/command");
  EXPECT_TRUE(setMode("effort").success);
  EXPECT_TRUE(send(joints, command, [&](const AppliedCommand& tick) {
    return tick.mode == "effort" && tick.command == command.data && tick.torque[1] < -20.0 && tick.reason.empty();
  })) << applied.last().reason;
}

TEST_F(SimulatedArmNodeTest, InModePositionItGoesToItsTarget) {
  ros::Publisher targets = advertise<sensor_msgs::JointState>("joint_target");
  EXPECT_TRUE(setMode("position").success);
  sensor_msgs::JointState target;
  target.name = {"joint_7", "joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6"};
  target.position = {-0.2, 0.1, 0.3, 0.0, 1.4, 0.0, 1.44};
  const std::vector<double> expected{0.1, 0.3, 0.0, 1.4, 0.0, 1.44, -0.2};
  EXPECT_TRUE(send(targets, target, [&](const AppliedCommand& tick) {
    return tick.mode == "position" && tick.command == expected && tick.reason.empty() &&
           !joint_states.messages().empty() && std::abs(joint_states.last().position[6] + 0.2) < 2e-3 &&
           std::abs(joint_states.last().position[0] - 0.1) < 2e-3;
  })) << applied.last().reason;

  target.name[0] = "joint_8";
  EXPECT_TRUE(send(targets, target, [&](const AppliedCommand& tick) {
    return tick.reason == refusal("the command names \"joint_8\", no joint of this arm");
  })) << applied.last().reason;
}

TEST_F(SimulatedArmNodeTest, InModePositionAnArrayIsATargetToo) {
  ros::Publisher joints = advertise<std_msgs::Float64MultiArray>("joint_group_position_controller/command");
  EXPECT_TRUE(setMode("position").success);
  std_msgs::Float64MultiArray command;
  command.data = {0.0, 0.3, 0.05, 1.4, 0.0, 1.44, 0.0};
  EXPECT_TRUE(send(joints, command, [&](const AppliedCommand& tick) {
    return tick.command == command.data && tick.reason.empty() && !joint_states.messages().empty() &&
           std::abs(joint_states.last().position[2] - 0.05) < 2e-3;
  })) << applied.last().reason;
}

TEST_F(SimulatedArmNodeTest, InModeTrajectoryAPathIsFollowedToItsEndAndHeld) {
  ros::Publisher paths = advertise<trajectory_msgs::JointTrajectory>("joint_trajectory");
  EXPECT_TRUE(setMode("trajectory").success);
  ASSERT_TRUE(applied.waitUntil([](const AppliedCommand& tick) { return tick.mode == "trajectory"; }));
  trajectory_msgs::JointTrajectory path;
  path.joint_names = {"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6", "joint_7"};
  path.points.resize(1);
  path.points[0].positions = {0.0, 0.3, 0.0, 1.4, 0.0, 1.44, 0.3};
  path.points[0].velocities = std::vector<double>(7, 0.0);
  path.points[0].accelerations = std::vector<double>(7, 0.0);
  path.points[0].time_from_start = ros::Duration(0.8);
  paths.publish(path);
  EXPECT_TRUE(applied.waitUntil([&](const AppliedCommand& tick) { return tick.command == path.points[0].positions; }));
  EXPECT_TRUE(joint_states.waitUntil([](const auto& state) { return std::abs(state.position[6] - 0.3) < 2e-3; }));

  path.points[0].time_from_start = ros::Duration(0.01);
  path.points[0].positions[6] = -0.3;
  paths.publish(path);
  EXPECT_TRUE(applied.waitUntil([&](const AppliedCommand& tick) {
    return tick.reason.find(": joint_7 would ") != std::string::npos && tick.reason.rfind("refused from ", 0) == 0;
  }));
}

TEST_F(SimulatedArmNodeTest, AnUnknownModeIsRefusedWithTheOnesThereAre) {
  const SetControlMode::Response response = setMode("telepathy");
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message,
            "control mode \"telepathy\" is not one of this arm, expected one of effort, velocity, position, "
            "trajectory, cartesian_velocity, gravity_compensation, impedance.");
}

TEST_F(SimulatedArmNodeTest, APauseStopsTimeForTheArm) {
  std_srvs::Empty call;
  ASSERT_TRUE(ros::service::call(node.resolveName("simulated_arm/pause_physics"), call));
  std::size_t arrived = 0;
  ASSERT_TRUE(waitFor([&] {  // until half a second passes without a tick
    arrived = applied.messages().size();
    return !waitFor([&] { return applied.messages().size() > arrived; }, 0.5);
  }));
  const AppliedCommand before = applied.last();
  ASSERT_TRUE(ros::service::call(node.resolveName("simulated_arm/unpause_physics"), call));
  ASSERT_TRUE(waitFor([&] { return applied.messages().size() > arrived; }));
  const AppliedCommand after = applied.messages()[arrived];
  EXPECT_EQ(after.tick, before.tick + 1);
  EXPECT_GE((after.header.stamp - before.header.stamp).toSec(), 0.5) << "on the ROS clock the pause is a gap";
}

TEST_F(SimulatedArmNodeTest, AResetBringsItBackToWhereItStarted) {
  ros::Publisher publisher = advertise<geometry_msgs::TwistStamped>("teleop_cmd");
  bool moved = false;
  ASSERT_TRUE(send(publisher, makeStamped(0.2), [&](const AppliedCommand& /*tick*/) {
    moved = !joint_states.messages().empty() && std::abs(joint_states.last().position[0]) > 0.02;
    return moved;
  }));
  publisher.shutdown();
  reset();
  EXPECT_TRUE(joint_states.waitUntil([](const sensor_msgs::JointState& state) {
    double distance = 0.0;
    for (std::size_t i = 0; i < 7; ++i) distance += std::abs(state.position[i] - kInitialPosition[i]);
    return distance < 1e-3;
  }));
}

TEST_F(SimulatedArmNodeTest, DiagnosticsTellOfTheLoopAndOfTheCommands) {
  Listener<diagnostic_msgs::DiagnosticArray> diagnostics(node, "/diagnostics");
  std::set<std::string> names;
  EXPECT_TRUE(diagnostics.waitUntil([&](const diagnostic_msgs::DiagnosticArray& array) {
    for (const auto& status : array.status) names.insert(status.name);
    return names.count("simulated_arm: control loop") == 1 && names.count("simulated_arm: commands") == 1;
  }));
}

TEST_F(SimulatedArmNodeTest, TheLaunchFilePublishesThePosesOfItsLinks) {
  Listener<tf2_msgs::TFMessage> transforms(node, "/tf");
  std::set<std::string> frames;
  EXPECT_TRUE(transforms.waitUntil([&](const tf2_msgs::TFMessage& message) {
    for (const auto& transform : message.transforms) frames.insert(transform.child_frame_id);
    return frames.count("link_1") == 1 && frames.count("link_7") == 1;
  }));
}

}  // namespace
}  // namespace demo_logger
