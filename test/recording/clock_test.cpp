// Clocks that jump, stall, or are set back.

#include <gtest/gtest.h>

#include <cmath>

#include "clock_fixture.h"

namespace demo_logger::testing_support {
namespace {

TEST_F(ClockTest, AForwardJumpIsBelievedAfterTwoMessagesAndEndsTheEpisode) {
  timeline_.begin();
  timeline_.number(0, 0.0, 1.0);
  joint(0.0, 1.0);
  joint(10.0, 11.0);
  joint(5020.0, 21.0);
  timeline_.advance(25.0);
  EXPECT_TRUE(timeline_.listener.jumps.empty()) << "one message may be an outlier";
  joint(5030.0, 31.0);
  timeline_.advance(35.0);
  ASSERT_EQ(timeline_.listener.jumps.size(), 1U);
  EXPECT_EQ(timeline_.listener.jumps[0].stamp, at(5020.0));
  EXPECT_DOUBLE_EQ(timeline_.listener.jumps[0].seconds, 5.0);
  EXPECT_EQ(rows(), 2U) << "every row before the jump has been given";
  timeline_.end(500.0);
  EXPECT_EQ(rows(), 2U) << "the episode has ended";
  EXPECT_EQ(timeline_.counter("clock_outliers"), 0U);
}

TEST_F(ClockTest, ABackwardJumpIsBelievedAfterTwoMessages) {
  timeline_.begin();
  joint(5000.0, 1.0);
  joint(5010.0, 11.0);
  joint(20.0, 21.0);
  joint(30.0, 31.0);
  timeline_.advance(40.0);
  ASSERT_EQ(timeline_.listener.jumps.size(), 1U);
  EXPECT_DOUBLE_EQ(timeline_.listener.jumps[0].seconds, -5.0);
  EXPECT_EQ(rows(), 2U);
}

TEST_F(ClockTest, AStepOfLessThanASecondIsNoJump) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(999.0, 11.0);
  joint(10.0, 21.0);
  timeline_.end(2000.0);
  EXPECT_TRUE(timeline_.listener.jumps.empty());
  EXPECT_EQ(rows(), 3U);
}

TEST_F(ClockTest, TheNextEpisodeMayBeginWithTheMessageThatShowedTheJump) {
  RestartingListener listener(timeline_.synchroniser);
  timeline_.begin();
  for (int i = 0; i < 3; ++i) joint(10.0 * i, 10.0 * i + 1.0);
  for (int i = 3; i < 6; ++i) joint(10.0 * i - 7000.0, 10.0 * i + 1.0);
  timeline_.synchroniser.advance(at(60.0), listener);
  timeline_.synchroniser.end(at(500.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows.size(), 3U);
  EXPECT_EQ(listener.episodes[1].rows.size(), 3U) << "no row is lost";
  EXPECT_EQ(listener.episodes[1].first_stamp, at(-6970.0));
}

TEST_F(ClockTest, WhatWasReceivedBeforeAJumpServesNoRowAfterIt) {
  RestartingListener listener(timeline_.synchroniser);
  timeline_.begin();
  timeline_.number(0, 0.0, 1.0, 1.0);  // on the old clock
  joint(0.0, 2.0);
  joint(5010.0, 11.0);
  timeline_.number(0, 5015.0, 2.0, 12.0);  // on the new one, before the jump is believed
  joint(5020.0, 21.0);
  timeline_.synchroniser.end(at(500.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows[0].values[4], 1.0);
  EXPECT_TRUE(std::isnan(listener.episodes[1].rows[0].values[4])) << "not the command of a clock that is gone";
  EXPECT_EQ(listener.episodes[1].rows[1].values[4], 2.0) << "what came on the new clock is kept";
}

TEST_F(ClockTest, DuringAJumpTheEndedEpisodeCanStillBeAskedAbout) {
  RestartingListener listener(timeline_.synchroniser);
  timeline_.begin();
  timeline_.number(0, 0.0, 1.0);
  joint(0.0, 3.0);
  joint(10.0, 13.0);
  joint(5000.0, 21.0);
  joint(5010.0, 31.0);
  timeline_.synchroniser.advance(at(40.0), listener);
  EXPECT_EQ(listener.rows_before, 2U);
  EXPECT_EQ(listener.received_before, 1U);
  ASSERT_TRUE(listener.offset_before.has_value()) << "frozen with what there is";
  EXPECT_DOUBLE_EQ(*listener.offset_before, 0.003);
  timeline_.synchroniser.end(at(500.0), listener);
  EXPECT_EQ(timeline_.counter("rows"), 2U);
  EXPECT_EQ(timeline_.synchroniser.streams()[0].received, 0U);
  EXPECT_DOUBLE_EQ(*timeline_.synchroniser.clockOffset(), -4.979) << "measured anew";
}

TEST_F(ClockTest, MergedJointsOfTheOldClockServeNoRowAfterAJump) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.joints = {"shoulder", "wrist"};
  configuration.merge_joint_states = true;
  Timeline timeline(configuration);
  RestartingListener listener(timeline.synchroniser);
  timeline.begin();
  timeline.joint(0.0, {"shoulder"}, {1.0}, 1.0);
  timeline.joint(10.0, {"wrist"}, {10.0}, 2.0);
  timeline.joint(-4996.0, {"shoulder"}, {1.0}, 3.0);
  timeline.joint(-4995.0, {"wrist"}, {20.0}, 4.0);
  timeline.joint(-4994.0, {"shoulder"}, {2.0}, 5.0);
  timeline.joint(-4993.0, {"wrist"}, {22.0}, 6.0);
  timeline.synchroniser.end(at(500.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_TRUE(std::isnan(listener.at(0, "q_wrist")));
  EXPECT_TRUE(std::isnan(listener.at(0, "wrist_age")));
  EXPECT_EQ(listener.at(1, "q_wrist"), 21.0) << "between −4995 ms and −4993 ms";
}

TEST_F(ClockTest, WhenTheMachinesClockIsSetBackAnEpisodeDoesNotWaitLongerForItsColumns) {
  SynchroniserConfiguration configuration;
  configuration.streams.push_back(makeStream("stick", StreamType::joy));
  Timeline timeline(configuration);
  timeline.begin();
  timeline.elbow(0.0, 0.0, 1.0);
  timeline.advance(500.0);
  EXPECT_TRUE(timeline.listener.episodes.empty());
  timeline.advance(-3'000'000.0);
  timeline.advance(-2'999'990.0);
  EXPECT_EQ(timeline.listener.rows().size(), 1U);
}

TEST_F(ClockTest, ASingleOutlierIsDroppedAndCounted) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(9000.0, 11.0);
  joint(20.0, 21.0);
  joint(-9000.0, 31.0);
  joint(40.0, 41.0);
  timeline_.end(500.0);
  EXPECT_TRUE(timeline_.listener.jumps.empty());
  EXPECT_EQ(rows(), 3U);
  EXPECT_EQ(timeline_.counter("clock_outliers"), 2U);
  EXPECT_EQ(
      timeline_.faultWith("more than 1 s off"),
      "a joint state's stamp was more than 1 s off, and the next one was not: it was dropped. Do two clocks stamp "
      "the joint states?");
}

TEST_F(ClockTest, AnOutlierThatArrivesTwiceIsStillOne) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(9000.0, 11.0);
  joint(9000.0, 12.0);
  joint(20.0, 21.0);
  timeline_.end(500.0);
  EXPECT_TRUE(timeline_.listener.jumps.empty());
  EXPECT_EQ(timeline_.counter("clock_outliers"), 1U);
  EXPECT_EQ(timeline_.counter("duplicate_rows"), 1U);
}

TEST_F(ClockTest, AStallWithLostMessagesIsNoJump) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(10.0, 3011.0);    // was held up for 3 s on its way
  joint(3000.0, 3012.0);  // those between were lost
  joint(3010.0, 3013.0);
  timeline_.end(9000.0);
  EXPECT_TRUE(timeline_.listener.jumps.empty());
  EXPECT_EQ(timeline_.counter("clock_outliers"), 0U);
  EXPECT_EQ(rows(), 4U);
}

TEST_F(ClockTest, APauseIsNoJump) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(60'000.0, 60'001.0);
  timeline_.end(70'000.0);
  EXPECT_EQ(rows(), 2U);
}

TEST_F(ClockTest, PlaybackAtFourTimesTheSpeedIsNoJump) {
  timeline_.begin();
  for (const double seconds : {0.0, 0.01, 5.0, 12.0, 13.0, 30.0}) joint(4000.0 * seconds, 1000.0 * seconds);
  timeline_.end(100'000.0);
  EXPECT_EQ(rows(), 6U);
  EXPECT_EQ(timeline_.counter("clock_outliers"), 0U);
}

TEST_F(ClockTest, UnderSimulatedTimeARestartIsABackwardJump) {
  RestartingListener listener(timeline_.synchroniser);
  timeline_.begin();
  const auto simulated = [this](double ms) { joint(ms, ms, ms - 86'400'000.0 + at(0.0) / 1e6); };
  for (const double ms : {90'000.0, 90'010.0, 90'020.0}) simulated(ms);
  timeline_.synchroniser.advance(at(90'025.0), listener);
  for (const double ms : {10.0, 20.0, 30.0}) simulated(ms);
  timeline_.synchroniser.advance(at(35.0), listener);
  timeline_.synchroniser.end(at(200.0), listener);
  ASSERT_EQ(listener.jumps.size(), 1U);
  EXPECT_DOUBLE_EQ(listener.jumps[0].seconds, -90.01);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows.size(), 3U);
  EXPECT_EQ(listener.episodes[1].rows.size(), 3U);
  EXPECT_EQ(timeline_.counter("pushed_late"), 0U);
}

TEST_F(ClockTest, WhenTheMachinesClockIsSetBackRowsGoOn) {
  // The robot keeps its own clock; the receipts fall by an hour.
  timeline_.begin();
  joint(0.0, 1.0, 1.0);
  joint(10.0, 11.0, 11.0);
  timeline_.advance(12.0);
  const double hour = 3'600'000.0;
  joint(20.0, 21.0 - hour, 21.0);
  joint(30.0, 31.0 - hour, 31.0);
  timeline_.advance(35.0 - hour);
  EXPECT_EQ(rows(), 2U) << "rows from before have waited enough";
  timeline_.advance(131.0 - hour);
  EXPECT_EQ(rows(), 4U) << "rows from after wait on the new setting";
  timeline_.end(140.0 - hour);
  EXPECT_TRUE(timeline_.listener.jumps.empty());
  EXPECT_EQ(timeline_.listener.episodes.size(), 1U);
}

TEST_F(ClockTest, WhenAllClocksAreSetBackTogetherTheEpisodeEndsAndNothingIsLost) {
  RestartingListener listener(timeline_.synchroniser);
  const double hour = 3'600'000.0;
  timeline_.begin();
  double position = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double now = 10.0 * i - (i < 100 ? 0.0 : hour);
    joint(now, now + 1.0, 10.0 * i + 1.0);
    timeline_.synchroniser.advance(at(now - 5.0), listener);
  }
  timeline_.synchroniser.end(at(2000.0 - hour), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows.size(), 100U);
  EXPECT_EQ(listener.episodes[1].rows.size(), 100U);
  for (const auto& episode : listener.episodes) {
    for (const Row& row : episode.rows) EXPECT_EQ(row.values[0], position++);
  }
}

TEST_F(ClockTest, AVeryLateMessageDoesNotSetTheClockBack) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(5000.0, 5001.0);
  timeline_.advance(5050.0);
  timeline_.number(0, -10.0, 7.0, /*receipt_ms=*/2.0);
  timeline_.advance(5060.0);
  joint(5100.0, 5101.0);
  timeline_.end(6000.0);
  EXPECT_EQ(rows(), 3U);
  EXPECT_EQ(timeline_.counter("pushed_late"), 1U);
  EXPECT_EQ(timeline_.listener.at(2, "s0_value"), 7.0) << "it is in force all the same";
}

}  // namespace
}  // namespace demo_logger::testing_support
