// Which joint states make rows, and what is said about the others.

#include <gtest/gtest.h>

#include <cmath>

#include "timeline.h"

namespace demo_logger::testing_support {
namespace {

using Names = std::vector<std::string>;

SynchroniserConfiguration armOf(Names joints) {
  SynchroniserConfiguration configuration;
  configuration.joints = std::move(joints);
  return configuration;
}

TEST(JointStatesTest, JointsAreFoundByNameInAnyOrder) {
  Timeline timeline(armOf({"a", "b", "c"}));
  timeline.begin();
  timeline.joint(0.0, {"a", "b", "c"}, {1.0, 2.0, 3.0});
  timeline.joint(10.0, {"c", "a", "b"}, {30.0, 10.0, 20.0});
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.columnNames(),
            (Names{"q_a", "q_b", "q_c", "dq_a", "dq_b", "dq_c", "tau_a", "tau_b", "tau_c", "receipt_delay"}));
  EXPECT_EQ(timeline.listener.at(1, "q_a"), 10.0);
  EXPECT_EQ(timeline.listener.at(1, "q_b"), 20.0);
  EXPECT_EQ(timeline.listener.at(1, "q_c"), 30.0);
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "dq_a"))) << "velocities were not sent";
  EXPECT_TRUE(timeline.synchroniser.faults().empty()) << "order may change";
}

TEST(JointStatesTest, WithoutAListTheFirstValidMessageNamesTheJoints) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  EXPECT_TRUE(timeline.synchroniser.joints().empty());
  timeline.joint(0.0, {"x", "y"}, {1.0});  // sizes disagree
  timeline.joint(10.0, {"shoulder", "elbow"}, {1.0, 2.0});
  timeline.end(200.0);
  EXPECT_EQ(timeline.synchroniser.joints(), (Names{"shoulder", "elbow"}));
  EXPECT_EQ(timeline.listener.rows().size(), 1U);
  EXPECT_EQ(timeline.counter("malformed_joint_states"), 1U);
  EXPECT_EQ(timeline.faultWith("cannot be used"),
            "a joint state cannot be used: it has 2 names, 1 positions, 0 velocities and 0 efforts; every array should "
            "be empty or have one value per name");
}

TEST(JointStatesTest, JointsWithoutNamesAreNumbered) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.joint(0.0, {}, {1.0, 2.0});
  timeline.end(200.0);
  EXPECT_EQ(timeline.synchroniser.joints(), (Names{"joint0", "joint1"}));
  EXPECT_EQ(timeline.listener.at(0, "q_joint1"), 2.0);
}

TEST(JointStatesTest, JointsOfOthersAreIgnoredAndReportedOnce) {
  Timeline timeline(armOf({"elbow"}));
  timeline.begin();
  timeline.joint(0.0, {"finger", "elbow"}, {9.0, 1.0});
  timeline.joint(10.0, {"finger", "elbow"}, {9.0, 2.0});
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.at(1, "q_elbow"), 2.0);
  ASSERT_EQ(timeline.synchroniser.faults().size(), 1U);
  EXPECT_EQ(timeline.synchroniser.faults()[0].what,
            "joint states also have finger, which are not recorded; name them in the joints to record them");
  EXPECT_EQ(timeline.synchroniser.faults()[0].count, 2U);
}

TEST(JointStatesTest, AMessageWithoutTheArmsJointsIsForeign) {
  Timeline timeline(armOf({"elbow"}));
  timeline.begin();
  timeline.joint(0.0, {"finger"}, {9.0});
  timeline.joint(1.0, {}, {});
  timeline.end(200.0);
  EXPECT_TRUE(timeline.listener.episodes.empty());
  EXPECT_EQ(timeline.counter("foreign_joint_states"), 2U);
  EXPECT_EQ(timeline.faultWith("none of"), "a joint state has none of the arm's joints elbow, but finger");
}

TEST(JointStatesTest, AMessageWithSomeOfTheJointsIsPartialAndSaysWhatItLacks) {
  Timeline timeline(armOf({"a", "b", "c"}));
  timeline.begin();
  JointStateSample sample = makeJointState(at(0.0), at(1.0), {"b"}, {1.0});
  sample.arrival.publisher = "/gripper";
  timeline.synchroniser.push(sample);
  timeline.end(200.0);
  EXPECT_TRUE(timeline.listener.episodes.empty());
  EXPECT_EQ(timeline.counter("partial_joint_states"), 1U);
  EXPECT_EQ(timeline.faultWith("lack"),
            "joint states of /gripper lack a, c and make no rows; where several nodes publish the arm's joints, set "
            "merge_joint_states");
}

TEST(JointStatesTest, UnbelievableMessagesAreMalformed) {
  Timeline timeline(armOf({"elbow"}));
  timeline.begin();
  timeline.joint(0.0, Names(1001, "elbow"), std::vector<double>(1001, 0.0));
  timeline.joint(1.0, {"elbow", std::string(256, 'x')}, {0.0, 0.0});
  timeline.joint(2.0, {"elbow", "elbow"}, {0.0, 0.0});
  timeline.joint(-2e15, {"elbow"}, {0.0}, 3.0);
  timeline.end(200.0);
  EXPECT_TRUE(timeline.listener.episodes.empty());
  EXPECT_EQ(timeline.counter("malformed_joint_states"), 4U);
  EXPECT_EQ(timeline.faultWith("cannot be used"), "a joint state cannot be used: it has more than 1000 joints");
}

TEST(JointStatesTest, MergedJointsAreInterpolatedAtTheRowWithTheirAge) {
  SynchroniserConfiguration configuration = armOf({"shoulder", "elbow", "wrist"});
  configuration.merge_joint_states = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.joint(0.0, {"wrist"}, {10.0});
  timeline.joint(4.0, {"elbow", "shoulder"}, {2.0, 1.0});
  timeline.joint(10.0, {"wrist"}, {20.0});
  timeline.end(200.0);
  ASSERT_EQ(timeline.listener.rows().size(), 1U) << "the message with the first listed joint makes the row";
  EXPECT_EQ(timeline.listener.columnNames().back(), "wrist_age");
  EXPECT_EQ(timeline.listener.at(0, "q_shoulder"), 1.0);
  EXPECT_EQ(timeline.listener.at(0, "q_elbow"), 2.0);
  EXPECT_DOUBLE_EQ(timeline.listener.at(0, "q_wrist"), 14.0);
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "dq_wrist")));
  EXPECT_EQ(timeline.listener.at(0, "wrist_age"), 0.004);
  EXPECT_EQ(timeline.counter("partial_joint_states"), 0U);
}

TEST(JointStatesTest, AMergedJointWithoutALaterNeighbourIsMissingAndCounted) {
  SynchroniserConfiguration configuration = armOf({"shoulder", "wrist"});
  configuration.merge_joint_states = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.joint(0.0, {"wrist"}, {10.0});
  timeline.joint(4.0, {"shoulder"}, {1.0});
  timeline.end(200.0);
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "q_wrist")));
  EXPECT_EQ(timeline.listener.at(0, "wrist_age"), 0.004);
  EXPECT_EQ(timeline.counter("unbridged_gaps"), 1U);
  EXPECT_EQ(timeline.faultWith("joint wrist"),
            "joint wrist could not be interpolated: no later message came in time, or more than max_gap (0.5 s) "
            "after the earlier one");
}

TEST(JointStatesTest, WhenMergingARowNeedsTheJointsThatTheFirstRowHad) {
  SynchroniserConfiguration configuration = armOf({"shoulder", "elbow"});
  configuration.merge_joint_states = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.joint(0.0, {"shoulder", "elbow"}, {1.0, 2.0});
  timeline.joint(10.0, {"shoulder"}, {1.0});
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.rows().size(), 1U);
  EXPECT_EQ(timeline.counter("partial_joint_states"), 1U);
  EXPECT_EQ(timeline.faultWith("lack"),
            "joint states lack elbow that they had when the episode began, and make no rows; keep the messages' joints "
            "the same");
}

TEST(JointStatesTest, ChangesOfNamesFrameAndPublisherAreReported) {
  Timeline timeline(armOf({"elbow"}));
  timeline.begin();
  JointStateSample sample = makeJointState(at(0.0), at(1.0), {"elbow"}, {1.0});
  sample.arrival.publisher = "/arm";
  sample.arrival.frame_id = "base";
  timeline.synchroniser.push(sample);
  sample = makeJointState(at(10.0), at(11.0), {"elbow", "finger"}, {1.0, 2.0});
  sample.arrival.publisher = "/impostor";
  sample.arrival.frame_id = "world";
  timeline.synchroniser.push(sample);
  sample = makeJointState(at(20.0), at(21.0), {"elbow"}, {1.0});
  sample.arrival.publisher = "/arm";
  sample.arrival.frame_id = "base";
  timeline.synchroniser.push(sample);
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.rows().size(), 3U) << "the episode goes on";
  EXPECT_EQ(
      timeline.faultWith("published by"),
      "joint elbow is published by /arm and by /impostor: the rows mix both; stop one of them or remap its topic");
  EXPECT_EQ(timeline.faultWith("frame_id"), "joint states of /impostor changed their frame_id from 'base' to 'world'");
  EXPECT_EQ(timeline.faultWith("changed their joints"),
            "joint states of /impostor changed their joints from elbow to elbow, finger");
}

TEST(JointStatesTest, APublisherThatTakesOverFromAnotherIsNoFault) {
  Timeline timeline(armOf({"elbow"}));
  timeline.begin();
  for (int k = 0; k < 10; ++k) {
    JointStateSample sample = makeJointState(at(10.0 * k), at(10.0 * k + 1.0), {"elbow"}, {1.0});
    sample.arrival.publisher = k < 5 ? "/driver" : "/driver_restarted";
    timeline.synchroniser.push(sample);
  }
  timeline.end(200.0);
  EXPECT_TRUE(timeline.synchroniser.faults().empty());
}

TEST(JointStatesTest, ColumnsSayWhatTheyAre) {
  SynchroniserConfiguration configuration = armOf({"left/elbow", "left.elbow"});
  configuration.prismatic_joints = {"left.elbow"};
  configuration.streams.push_back(makeStream("teleop_cmd", StreamType::twist));
  Timeline timeline(configuration);
  timeline.begin();
  timeline.joint(0.0, {"left/elbow", "left.elbow"}, {1.0, 2.0});
  timeline.end(200.0);
  const std::vector<Column>& columns = timeline.listener.episodes.at(0).columns;
  ASSERT_EQ(columns.size(), 7U + 7U);
  EXPECT_EQ(columns[0].name, "q_left_elbow");
  EXPECT_EQ(columns[0].unit, "rad");
  EXPECT_EQ(columns[0].role, Role::state);
  EXPECT_EQ(columns[0].interpolation, Interpolation::linear);
  EXPECT_EQ(columns[0].source, "joint_states/position/left/elbow");
  EXPECT_EQ(columns[1].name, "q_left_elbow_2");
  EXPECT_EQ(columns[1].unit, "m");
  EXPECT_EQ(columns[3].unit, "m/s");
  EXPECT_EQ(columns[4].unit, "N m");
  EXPECT_EQ(columns[5].unit, "N");
  EXPECT_EQ(columns[6].name, "receipt_delay");
  EXPECT_EQ(columns[7].name, "u_vx");
  EXPECT_EQ(columns[7].unit, "m/s");
  EXPECT_EQ(columns[7].role, Role::control);
  EXPECT_EQ(columns[7].interpolation, Interpolation::hold);
  EXPECT_EQ(columns[7].source, "/teleop_cmd/linear/x");
  EXPECT_EQ(columns[12].name, "u_wz");
  EXPECT_EQ(columns[13].name, "u_age");
  EXPECT_EQ(columns[13].interpolation, Interpolation::none);
  EXPECT_EQ(timeline.synchroniser.originalNames().at("q_left_elbow"), "q_left/elbow");
  EXPECT_EQ(timeline.synchroniser.originalNames().at("q_left_elbow_2"), "q_left.elbow");
}

}  // namespace
}  // namespace demo_logger::testing_support
