// The hand against an arm of this test: physics without ROS, in between messages only.
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>

#include "test/nodes/waiting.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

/// In an order that is not the URDF's, beside a joint that is not the arm's.
sensor_msgs::JointState asSeen(const ArmTick& tick) {
  sensor_msgs::JointState state;
  state.header.stamp.fromNSec(static_cast<std::uint64_t>(tick.stamp));
  state.name.emplace_back("gripper");
  state.position.push_back(0.02);
  state.velocity.push_back(0.0);
  for (int i = 6; i >= 0; --i) {
    state.name.push_back("joint_" + std::to_string(i + 1));
    state.position.push_back(tick.truth.q[i]);
    state.velocity.push_back(tick.truth.dq[i]);
  }
  return state;
}

LinkWrench toLinkWrench(const RobotDescription& robot, const geometry_msgs::Wrench& wrench) {
  const Eigen::Matrix3d R = robot.X_lastlink_tip.linear();
  return {6, robot.X_lastlink_tip.translation(), R * Eigen::Vector3d(wrench.force.x, wrench.force.y, wrench.force.z),
          R * Eigen::Vector3d(wrench.torque.x, wrench.torque.y, wrench.torque.z), true};
}

TEST(SimulatedHandNodeTest, AnswersEachJointStateGuidesTheArmPressesItsButtonsAndEnds) {
  ros::NodeHandle node;
  Listener<geometry_msgs::WrenchStamped> wrench(node, "human_wrench");
  Listener<sensor_msgs::Joy> joy(node, "joy");
  ros::Publisher truth = node.advertise<sensor_msgs::JointState>("ground_truth/joint_states", 10);
  ASSERT_TRUE(
      waitFor([&] { return truth.getNumSubscribers() > 0 && wrench.publishers() > 0 && joy.publishers() > 0; }));
  SimulatedArm arm = makeDemoArm(ControlMode::gravity_compensation);
  ArmTick tick = arm.tick(kNanosecondsPerSecond, {});
  const Eigen::VectorXd start = tick.truth.q;
  double farthest = 0.0;
  double strongest = 0.0;
  while (wrench.publishers() > 0 && tick.stamp < 20 * kNanosecondsPerSecond) {
    const std::size_t answered = wrench.messages().size();
    const sensor_msgs::JointState state = asSeen(tick);
    truth.publish(state);
    ASSERT_TRUE(waitFor([&] { return wrench.messages().size() > answered || wrench.publishers() == 0; }));
    if (wrench.messages().size() > answered) {
      const geometry_msgs::WrenchStamped& answer = wrench.last();
      ASSERT_EQ(answer.header.stamp, state.header.stamp);
      ASSERT_EQ(answer.header.frame_id, "tool_tip");
      arm.applyWrench(toLinkWrench(arm.description(), answer.wrench), tick.stamp + 200 * kMillisecond, "/hand");
    }
    for (int k = 0; k < 4; ++k) tick = arm.tick(tick.stamp + kMillisecond, {});
    farthest = std::max(farthest, (tick.truth.q - start).norm());
    strongest = std::max(strongest, tick.external_torque.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(wrench.publishers(), 0U) << "the node ends with its task";
  EXPECT_GT(farthest, 0.2) << "[rad]";
  EXPECT_GT(strongest, 2.0) << "[N m]";
  EXPECT_LT(strongest, 40.0) << "[N m]";

  bool started = false;
  bool stopped = false;
  for (const sensor_msgs::Joy& reading : joy.messages()) {
    ASSERT_EQ(reading.buttons.size(), 3U);
    started = started || reading.buttons[1] == 1;
    EXPECT_TRUE(started || reading.buttons[2] == 0);
    stopped = stopped || reading.buttons[2] == 1;
  }
  EXPECT_TRUE(started);
  EXPECT_TRUE(stopped);
}

}  // namespace
}  // namespace demo_logger
