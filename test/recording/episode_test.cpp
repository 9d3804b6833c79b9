// Episodes: what is in force when they begin, which columns they have, what belongs to them.

#include <gtest/gtest.h>

#include <cmath>

#include "timeline.h"

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
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.number(0, 0.0, 7.0);
  for (int i = 0; i < 6000; ++i) {
    timeline.elbow(10.0 * i, 0.0);
    timeline.advance(10.0 * i);
  }
  timeline.begin(60'000.0);
  timeline.elbow(60'005.0, 1.0);
  timeline.end(61'000.0);
  ASSERT_EQ(timeline.listener.rows().size(), 1U) << "rows are those received after the request";
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 7.0);
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 60.005);
  EXPECT_EQ(timeline.synchroniser.streams()[0].received, 0U);
  EXPECT_EQ(timeline.synchroniser.streams()[0].used, 1U);
}

TEST(EpisodeTest, RowsReceivedUntilTheRequestsBelongToTheEpisode) {
  Timeline timeline(SynchroniserConfiguration{});
  for (int i = 0; i < 10; ++i) timeline.elbow(10.0 * i, i, 10.0 * i);
  timeline.begin(20.0);
  timeline.end(60.0);
  ASSERT_EQ(timeline.listener.rows().size(), 4U);
  EXPECT_EQ(timeline.listener.rows().front().stamp, at(30.0));
  EXPECT_EQ(timeline.listener.rows().back().stamp, at(60.0));
  timeline.begin(70.0);
  timeline.end(200.0);
  ASSERT_EQ(timeline.listener.episodes.size(), 2U) << "what waits in the inbox serves the next episode";
  EXPECT_EQ(timeline.listener.rows().size(), 2U);
  EXPECT_EQ(timeline.listener.rows().front().stamp, at(80.0));
}

TEST(EpisodeTest, StopFinishesRowsWithWhatHasArrived) {
  Timeline timeline(numberStreams({Alignment::linear}));
  timeline.begin();
  timeline.number(0, 0.0, 0.0);
  timeline.elbow(5.0, 0.0);
  timeline.number(0, 10.0, 1.0, /*receipt_ms=*/12.0);
  timeline.end(11.0);
  ASSERT_EQ(timeline.listener.rows().size(), 1U) << "without waiting";
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "s0_value"))) << "and without what was received after the request";
}

TEST(EpisodeTest, RowsStillWaitingThatWereReceivedAfterTheRequestAreNotInTheEpisode) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.elbow(0.0, 0.0);
  timeline.elbow(50.0, 1.0);
  timeline.advance(90.0);
  timeline.end(40.0);
  EXPECT_EQ(timeline.listener.rows().size(), 1U);
}

TEST(EpisodeTest, AnEpisodeWithoutAJointStateIsNeverOpened) {
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.begin();
  timeline.number(0, 0.0, 1.0);
  timeline.advance(5000.0);
  timeline.end(6000.0);
  EXPECT_TRUE(timeline.listener.episodes.empty());
  EXPECT_FALSE(timeline.synchroniser.lastJointState().has_value());
  EXPECT_EQ(timeline.synchroniser.lastOf(0), at(1.0));
}

TEST(EpisodeTest, ColumnsWaitForTheFirstMessageOfAJoystick) {
  Timeline timeline(withJoystick());
  timeline.begin();
  timeline.elbow(0.0, 0.0);
  timeline.elbow(10.0, 1.0);
  timeline.advance(900.0);
  EXPECT_TRUE(timeline.listener.episodes.empty());
  timeline.synchroniser.push(1, makeJoy(at(905.0), at(906.0), {0.5, -0.5}));
  timeline.elbow(910.0, 2.0);
  timeline.advance(1100.0);
  EXPECT_EQ(timeline.listener.columnNames(), (Names{"q_elbow", "dq_elbow", "tau_elbow", "receipt_delay", "s0_value",
                                                    "s0_age", "stick_axis0", "stick_axis1", "stick_age"}));
  ASSERT_EQ(timeline.listener.rows().size(), 3U) << "rows wait meanwhile";
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "stick_axis1")));
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "stick_age")));
  EXPECT_EQ(timeline.listener.at(2, "stick_axis1"), -0.5);
  EXPECT_EQ(timeline.listener.at(2, "stick_age"), 0.005);
  EXPECT_EQ(timeline.listener.episodes[0].first_stamp, at(0.0));
}

TEST(EpisodeTest, AStreamThatDoesNotShowItsColumnsInTimeIsLeftOutAndReported) {
  Timeline timeline(withJoystick());
  timeline.begin();
  timeline.elbow(0.0, 0.0, /*receipt_ms=*/0.0);
  timeline.synchroniser.push(1, makeJoy(at(1000.0), at(1000.000001), {0.5}));
  timeline.elbow(1100.0, 0.0);
  timeline.end(2000.0);
  EXPECT_EQ(timeline.listener.columnNames(),
            (Names{"q_elbow", "dq_elbow", "tau_elbow", "receipt_delay", "s0_value", "s0_age"}));
  EXPECT_EQ(timeline.listener.rows()[1].values.size(), 6U);
  EXPECT_EQ(
      timeline.faultWith("left out"),
      "stream stick (/stick) is left out of this episode: no message showed its columns within wait_for_streams (1 "
      "s) after the first joint state. Does it publish?");
  timeline.begin(3000.0);
  timeline.elbow(3001.0, 0.0);
  timeline.end(4000.0);
  EXPECT_EQ(timeline.listener.columnNames().back(), "stick_age") << "the next episode has it";
  EXPECT_EQ(timeline.listener.at(0, "stick_axis0"), 0.5);
}

TEST(EpisodeTest, AStreamInTimeByItsReceiptIsInHoweverLateItIsPushed) {
  Timeline timeline(withJoystick());
  timeline.begin();
  timeline.elbow(0.0, 0.0, /*receipt_ms=*/0.0);
  timeline.elbow(2000.0, 0.0);
  timeline.synchroniser.push(1, makeJoy(at(999.0), at(1000.0), {0.5}));
  timeline.end(3000.0);
  EXPECT_EQ(timeline.listener.columnNames().back(), "stick_age");
}

TEST(EpisodeTest, AnyTypeIsLearnedFromTheFirstMessage) {
  SynchroniserConfiguration configuration;
  configuration.streams.push_back(makeStream("teleop_cmd", std::nullopt));
  configuration.streams.push_back(makeStream("joint_target", std::nullopt));
  Timeline timeline(configuration);
  timeline.begin();
  timeline.synchroniser.push(0, makeTwist(at(0.0), at(0.0), 0.25));
  StreamSample command = makeStreamSample(StreamType::joint_command, at(0.0), at(0.0), {1.0, 2.0});
  command.components = {"a", "b"};
  command.units = {"rad", "m"};
  timeline.synchroniser.push(1, command);
  command = makeStreamSample(StreamType::joint_command, at(5.0), at(5.0), {20.0, 10.0});
  command.components = {"b", "a"};
  command.units = {"m", "rad"};
  timeline.synchroniser.push(1, command);
  timeline.elbow(1.0, 0.0);
  timeline.elbow(6.0, 0.0);
  timeline.end(1000.0);
  EXPECT_EQ(timeline.listener.at(0, "u_vx"), 0.25);
  EXPECT_EQ(timeline.listener.at(0, "joint_target_b"), 2.0);
  EXPECT_EQ(timeline.listener.at(1, "joint_target_a"), 10.0) << "joints of commands are found by name";
  EXPECT_EQ(timeline.listener.episodes[0].columns[12].unit, "m");
  EXPECT_EQ(timeline.synchroniser.streams()[0].type, "twist");
}

TEST(EpisodeTest, InAnOpenEpisodeOtherComponentsAreMalformedBetweenEpisodesTheyAreLearned) {
  Timeline timeline(withJoystick());
  timeline.synchroniser.push(1, makeJoy(at(0.0), at(0.0), {0.1}));
  timeline.begin();
  timeline.elbow(1.0, 0.0);
  timeline.advance(200.0);
  timeline.synchroniser.push(1, makeJoy(at(210.0), at(210.0), {0.1, 0.2}));
  timeline.elbow(220.0, 0.0);
  timeline.end(300.0);
  EXPECT_EQ(timeline.listener.at(1, "stick_axis0"), 0.1);
  EXPECT_EQ(timeline.counter("malformed_stream_messages"), 1U);
  EXPECT_EQ(timeline.faultWith("stick"),
            "stream stick (/stick) sent a joy with 2 values, expected joy with 1 values; it was dropped");
  timeline.synchroniser.push(1, makeJoy(at(310.0), at(310.0), {0.1, 0.2}));
  timeline.advance(320.0);
  timeline.begin(330.0);
  timeline.elbow(340.0, 0.0);
  timeline.end(500.0);
  EXPECT_EQ(timeline.listener.at(0, "stick_axis1"), 0.2);
}

TEST(EpisodeTest, CountersAndFaultsBelongToTheEpisode) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.joints = {"elbow"};
  Timeline timeline(configuration);
  timeline.begin(0.0);
  timeline.joint(1.0, {"finger"}, {0.0});
  timeline.number(0, 2.0, 1.0);
  timeline.elbow(3.0, 0.0);
  timeline.end(100.0);
  EXPECT_EQ(timeline.counter("foreign_joint_states"), 1U);
  EXPECT_EQ(timeline.counter("rows"), 1U);
  EXPECT_EQ(timeline.synchroniser.faults().size(), 1U);
  EXPECT_EQ(timeline.synchroniser.faults()[0].stamp, at(2.0)) << "its receipt";

  timeline.begin(200.0);
  timeline.joint(150.0, {"finger"}, {0.0});  // received after the call, and before the request
  timeline.elbow(201.0, 0.0);
  timeline.end(300.0);
  EXPECT_EQ(timeline.counter("foreign_joint_states"), 0U);
  EXPECT_EQ(timeline.counter("rows"), 1U);
  EXPECT_EQ(timeline.synchroniser.streams()[0].received, 0U);
  EXPECT_TRUE(timeline.synchroniser.faults().empty());
}

TEST(EpisodeTest, ASecondBeginAndAnEndWithoutABeginAreIgnored) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.end(0.0);
  timeline.begin(0.0);
  timeline.begin(50.0);
  timeline.elbow(10.0, 0.0);
  timeline.end(100.0);
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.episodes.size(), 1U);
  EXPECT_EQ(timeline.listener.rows().size(), 1U);
}

}  // namespace
}  // namespace demo_logger::testing_support
