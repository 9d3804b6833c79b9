// Episodes: what is in force when they begin, which columns they have, what belongs to them.

#include <gtest/gtest.h>

#include <cmath>

#include "session.h"

namespace demo_logger::testing_support {
namespace {

using Names = std::vector<std::string>;

SynchroniserConfiguration withJoystick() {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.streams.push_back(makeStream("stick", StreamType::joy));
  configuration.max_wait = 0.05;
  configuration.wait_for_streams = 1.0;
  return configuration;
}

TEST(EpisodeTest, ACommandSentLongBeforeIsInForceInTheFirstRow) {
  Session session(numberStreams({Alignment::hold}));
  session.number(0, 0.0, 7.0);
  for (int i = 0; i < 6000; ++i) {
    session.elbow(10.0 * i, 0.0);
    session.advance(10.0 * i);
  }
  session.begin(60'000.0);
  session.elbow(60'005.0, 1.0);
  session.end(61'000.0);
  ASSERT_EQ(session.listener.rows().size(), 1U) << "rows are those received after the request";
  EXPECT_EQ(session.listener.at(0, "s0_value"), 7.0);
  EXPECT_EQ(session.listener.at(0, "s0_age"), 60.005);
  EXPECT_EQ(session.synchroniser.streams()[0].received, 0U);
  EXPECT_EQ(session.synchroniser.streams()[0].used, 1U);
}

TEST(EpisodeTest, RowsReceivedUntilTheRequestsBelongToTheEpisode) {
  Session session(SynchroniserConfiguration{});
  for (int i = 0; i < 10; ++i) session.elbow(10.0 * i, i, 10.0 * i);
  session.begin(20.0);
  session.end(60.0);
  ASSERT_EQ(session.listener.rows().size(), 4U);
  EXPECT_EQ(session.listener.rows().front().stamp, at(30.0));
  EXPECT_EQ(session.listener.rows().back().stamp, at(60.0));
  session.begin(70.0);
  session.end(200.0);
  ASSERT_EQ(session.listener.episodes.size(), 2U) << "what waits in the inbox serves the next episode";
  EXPECT_EQ(session.listener.rows().size(), 2U);
  EXPECT_EQ(session.listener.rows().front().stamp, at(80.0));
}

TEST(EpisodeTest, StopFinishesRowsWithWhatHasArrived) {
  Session session(numberStreams({Alignment::linear}));
  session.begin();
  session.number(0, 0.0, 0.0);
  session.elbow(5.0, 0.0);
  session.number(0, 10.0, 1.0, /*receipt_ms=*/12.0);
  session.end(11.0);
  ASSERT_EQ(session.listener.rows().size(), 1U) << "without waiting";
  EXPECT_TRUE(std::isnan(session.listener.at(0, "s0_value"))) << "and without what was received after the request";
}

TEST(EpisodeTest, RowsStillWaitingThatWereReceivedAfterTheRequestAreNotInTheEpisode) {
  Session session(SynchroniserConfiguration{});
  session.begin();
  session.elbow(0.0, 0.0);
  session.elbow(50.0, 1.0);
  session.advance(90.0);
  session.end(40.0);
  EXPECT_EQ(session.listener.rows().size(), 1U);
}

TEST(EpisodeTest, AnEpisodeWithoutAJointStateIsNeverOpened) {
  Session session(numberStreams({Alignment::hold}));
  session.begin();
  session.number(0, 0.0, 1.0);
  session.advance(5000.0);
  session.end(6000.0);
  EXPECT_TRUE(session.listener.episodes.empty());
  EXPECT_FALSE(session.synchroniser.lastJointState().has_value());
  EXPECT_EQ(session.synchroniser.lastOf(0), at(1.0));
}

TEST(EpisodeTest, ColumnsWaitForTheFirstMessageOfAJoystick) {
  Session session(withJoystick());
  session.begin();
  session.elbow(0.0, 0.0);
  session.elbow(10.0, 1.0);
  session.advance(900.0);
  EXPECT_TRUE(session.listener.episodes.empty());
  session.synchroniser.push(1, makeJoy(at(905.0), at(906.0), {0.5, -0.5}));
  session.elbow(910.0, 2.0);
  session.advance(1100.0);
  EXPECT_EQ(session.listener.columnNames(), (Names{"q_elbow", "dq_elbow", "tau_elbow", "receipt_delay", "s0_value",
                                                   "s0_age", "stick_axis0", "stick_axis1", "stick_age"}));
  ASSERT_EQ(session.listener.rows().size(), 3U) << "rows wait meanwhile";
  EXPECT_TRUE(std::isnan(session.listener.at(0, "stick_axis1")));
  EXPECT_TRUE(std::isnan(session.listener.at(0, "stick_age")));
  EXPECT_EQ(session.listener.at(2, "stick_axis1"), -0.5);
  EXPECT_EQ(session.listener.at(2, "stick_age"), 0.005);
  EXPECT_EQ(session.listener.episodes[0].first_stamp, at(0.0));
}

TEST(EpisodeTest, AStreamThatDoesNotShowItsColumnsInTimeIsLeftOutAndReported) {
  Session session(withJoystick());
  session.begin();
  session.elbow(0.0, 0.0, /*receipt_ms=*/0.0);
  session.synchroniser.push(1, makeJoy(at(1000.0), at(1000.000001), {0.5}));
  session.elbow(1100.0, 0.0);
  session.end(2000.0);
  EXPECT_EQ(session.listener.columnNames(),
            (Names{"q_elbow", "dq_elbow", "tau_elbow", "receipt_delay", "s0_value", "s0_age"}));
  EXPECT_EQ(session.listener.rows()[1].values.size(), 6U);
  EXPECT_EQ(
      session.faultWith("left out"),
      "stream stick (/stick) is left out of this episode: no message showed its columns within wait_for_streams (1 "
      "s) after the first joint state. Does it publish?");
  session.begin(3000.0);
  session.elbow(3001.0, 0.0);
  session.end(4000.0);
  EXPECT_EQ(session.listener.columnNames().back(), "stick_age") << "the next episode has it";
  EXPECT_EQ(session.listener.at(0, "stick_axis0"), 0.5);
}

TEST(EpisodeTest, AStreamInTimeByItsReceiptIsInHoweverLateItIsPushed) {
  Session session(withJoystick());
  session.begin();
  session.elbow(0.0, 0.0, /*receipt_ms=*/0.0);
  session.elbow(2000.0, 0.0);
  session.synchroniser.push(1, makeJoy(at(999.0), at(1000.0), {0.5}));
  session.end(3000.0);
  EXPECT_EQ(session.listener.columnNames().back(), "stick_age");
}

TEST(EpisodeTest, AnyTypeIsLearnedFromTheFirstMessage) {
  SynchroniserConfiguration configuration;
  configuration.streams.push_back(makeStream("teleop_cmd", std::nullopt));
  configuration.streams.push_back(makeStream("joint_target", std::nullopt));
  Session session(configuration);
  session.begin();
  session.synchroniser.push(0, makeTwist(at(0.0), at(0.0), 0.25));
  StreamSample command = makeStreamSample(StreamType::joint_command, at(0.0), at(0.0), {1.0, 2.0});
  command.components = {"a", "b"};
  command.units = {"rad", "m"};
  session.synchroniser.push(1, command);
  command = makeStreamSample(StreamType::joint_command, at(5.0), at(5.0), {20.0, 10.0});
  command.components = {"b", "a"};
  command.units = {"m", "rad"};
  session.synchroniser.push(1, command);
  session.elbow(1.0, 0.0);
  session.elbow(6.0, 0.0);
  session.end(1000.0);
  EXPECT_EQ(session.listener.at(0, "u_vx"), 0.25);
  EXPECT_EQ(session.listener.at(0, "joint_target_b"), 2.0);
  EXPECT_EQ(session.listener.at(1, "joint_target_a"), 10.0) << "joints of commands are found by name";
  EXPECT_EQ(session.listener.episodes[0].columns[12].unit, "m");
  EXPECT_EQ(session.synchroniser.streams()[0].type, "twist");
}

TEST(EpisodeTest, InAnOpenEpisodeOtherComponentsAreMalformedBetweenEpisodesTheyAreLearned) {
  Session session(withJoystick());
  session.synchroniser.push(1, makeJoy(at(0.0), at(0.0), {0.1}));
  session.begin();
  session.elbow(1.0, 0.0);
  session.advance(200.0);
  session.synchroniser.push(1, makeJoy(at(210.0), at(210.0), {0.1, 0.2}));
  session.elbow(220.0, 0.0);
  session.end(300.0);
  EXPECT_EQ(session.listener.at(1, "stick_axis0"), 0.1);
  EXPECT_EQ(session.counter("malformed_stream_messages"), 1U);
  EXPECT_EQ(session.faultWith("stick"),
            "stream stick (/stick) sent a joy with 2 values, expected joy with 1 values; it was dropped");
  session.synchroniser.push(1, makeJoy(at(310.0), at(310.0), {0.1, 0.2}));
  session.advance(320.0);
  session.begin(330.0);
  session.elbow(340.0, 0.0);
  session.end(500.0);
  EXPECT_EQ(session.listener.at(0, "stick_axis1"), 0.2);
}

TEST(EpisodeTest, CountersAndFaultsBelongToTheEpisode) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.joints = {"elbow"};
  Session session(configuration);
  session.begin(0.0);
  session.joint(1.0, {"finger"}, {0.0});
  session.number(0, 2.0, 1.0);
  session.elbow(3.0, 0.0);
  session.end(100.0);
  EXPECT_EQ(session.counter("foreign_joint_states"), 1U);
  EXPECT_EQ(session.counter("rows"), 1U);
  EXPECT_EQ(session.synchroniser.faults().size(), 1U);
  EXPECT_EQ(session.synchroniser.faults()[0].stamp, at(2.0)) << "its receipt";

  session.begin(200.0);
  session.joint(150.0, {"finger"}, {0.0});  // received after the call, and before the request
  session.elbow(201.0, 0.0);
  session.end(300.0);
  EXPECT_EQ(session.counter("foreign_joint_states"), 0U);
  EXPECT_EQ(session.counter("rows"), 1U);
  EXPECT_EQ(session.synchroniser.streams()[0].received, 0U);
  EXPECT_TRUE(session.synchroniser.faults().empty());
}

TEST(EpisodeTest, ASecondBeginAndAnEndWithoutABeginAreIgnored) {
  Session session(SynchroniserConfiguration{});
  session.end(0.0);
  session.begin(0.0);
  session.begin(50.0);
  session.elbow(10.0, 0.0);
  session.end(100.0);
  session.end(200.0);
  EXPECT_EQ(session.listener.episodes.size(), 1U);
  EXPECT_EQ(session.listener.rows().size(), 1U);
}

}  // namespace
}  // namespace demo_logger::testing_support
