// Clocks that differ, jump, stall, or do not stamp at all.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "session.h"

namespace demo_logger::testing_support {
namespace {

/// Joint states every 10 ms whose stamps, receipts and steady clock are chosen apart. The position counts them.
class ClockTest : public ::testing::Test {
 protected:
  /// `stamp_ms` and `receipt_ms` since kToday, `steady_ms` since the machine was started a day ago.
  void joint(double stamp_ms, double receipt_ms, double steady_ms) {
    JointStateSample sample = makeJointState(at(stamp_ms), at(receipt_ms), {"elbow"}, {static_cast<double>(sent_++)});
    sample.arrival.steady = 86'400 * kNanosecondsPerSecond + static_cast<Nanoseconds>(steady_ms * 1e6);
    session_.synchroniser.push(sample);
  }
  void joint(double stamp_ms, double receipt_ms) { joint(stamp_ms, receipt_ms, receipt_ms); }

  std::size_t rows() const {
    std::size_t rows = 0;
    for (const auto& episode : session_.listener.episodes) rows += episode.rows.size();
    return rows;
  }

  Session session_{numberStreams({Alignment::hold})};
  int sent_ = 0;
};

TEST_F(ClockTest, AForwardJumpIsBelievedAfterTwoMessagesAndEndsTheEpisode) {
  session_.begin();
  session_.number(0, 0.0, 1.0);
  joint(0.0, 1.0);
  joint(10.0, 11.0);
  joint(5020.0, 21.0);
  session_.advance(25.0);
  EXPECT_TRUE(session_.listener.jumps.empty()) << "one message may be an outlier";
  joint(5030.0, 31.0);
  session_.advance(35.0);
  ASSERT_EQ(session_.listener.jumps.size(), 1U);
  EXPECT_EQ(session_.listener.jumps[0].stamp, at(5020.0));
  EXPECT_DOUBLE_EQ(session_.listener.jumps[0].seconds, 5.0);
  EXPECT_EQ(rows(), 2U) << "every row before the jump has been given";
  session_.end(500.0);
  EXPECT_EQ(rows(), 2U) << "the episode has ended";
  EXPECT_EQ(session_.counter("clock_outliers"), 0U);
}

TEST_F(ClockTest, ABackwardJumpIsBelievedAfterTwoMessages) {
  session_.begin();
  joint(5000.0, 1.0);
  joint(5010.0, 11.0);
  joint(20.0, 21.0);
  joint(30.0, 31.0);
  session_.advance(40.0);
  ASSERT_EQ(session_.listener.jumps.size(), 1U);
  EXPECT_DOUBLE_EQ(session_.listener.jumps[0].seconds, -5.0);
  EXPECT_EQ(rows(), 2U);
}

TEST_F(ClockTest, AStepOfLessThanASecondIsNoJump) {
  session_.begin();
  joint(0.0, 1.0);
  joint(999.0, 11.0);
  joint(10.0, 21.0);
  session_.end(2000.0);
  EXPECT_TRUE(session_.listener.jumps.empty());
  EXPECT_EQ(rows(), 3U);
}

/// Begins the next episode from within clockJumped(), as a recorder with autostart does.
class RestartingListener : public RecordingListener {
 public:
  explicit RestartingListener(Synchroniser& synchroniser) : synchroniser_(synchroniser) {}
  void clockJumped(Nanoseconds stamp, double seconds) override {
    RecordingListener::clockJumped(stamp, seconds);
    rows_before = synchroniser_.counters().at("rows");
    offset_before = synchroniser_.clockOffset();
    received_before = synchroniser_.streams().at(0).received;
    synchroniser_.begin(0);
  }

  // Of the episode that the jump ended.
  std::size_t rows_before = 0;
  std::optional<double> offset_before;
  std::size_t received_before = 0;

 private:
  Synchroniser& synchroniser_;
};

TEST_F(ClockTest, TheNextEpisodeMayBeginWithTheMessageThatShowedTheJump) {
  RestartingListener listener(session_.synchroniser);
  session_.begin();
  for (int i = 0; i < 3; ++i) joint(10.0 * i, 10.0 * i + 1.0);
  for (int i = 3; i < 6; ++i) joint(10.0 * i - 7000.0, 10.0 * i + 1.0);
  session_.synchroniser.advance(at(60.0), listener);
  session_.synchroniser.end(at(500.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows.size(), 3U);
  EXPECT_EQ(listener.episodes[1].rows.size(), 3U) << "no row is lost";
  EXPECT_EQ(listener.episodes[1].first_stamp, at(-6970.0));
}

TEST_F(ClockTest, WhatWasReceivedBeforeAJumpServesNoRowAfterIt) {
  RestartingListener listener(session_.synchroniser);
  session_.begin();
  session_.number(0, 0.0, 1.0, 1.0);  // on the old clock
  joint(0.0, 2.0);
  joint(5010.0, 11.0);
  session_.number(0, 5015.0, 2.0, 12.0);  // on the new one, before the jump is believed
  joint(5020.0, 21.0);
  session_.synchroniser.end(at(500.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows[0].values[4], 1.0);
  EXPECT_TRUE(std::isnan(listener.episodes[1].rows[0].values[4])) << "not the command of a clock that is gone";
  EXPECT_EQ(listener.episodes[1].rows[1].values[4], 2.0) << "what came on the new clock is kept";
}

TEST_F(ClockTest, DuringAJumpTheEndedEpisodeCanStillBeAskedAbout) {
  RestartingListener listener(session_.synchroniser);
  session_.begin();
  session_.number(0, 0.0, 1.0);
  joint(0.0, 3.0);
  joint(10.0, 13.0);
  joint(5000.0, 21.0);
  joint(5010.0, 31.0);
  session_.synchroniser.advance(at(40.0), listener);
  EXPECT_EQ(listener.rows_before, 2U);
  EXPECT_EQ(listener.received_before, 1U);
  ASSERT_TRUE(listener.offset_before.has_value()) << "frozen with what there is";
  EXPECT_DOUBLE_EQ(*listener.offset_before, 0.003);
  session_.synchroniser.end(at(500.0), listener);
  EXPECT_EQ(session_.counter("rows"), 2U);
  EXPECT_EQ(session_.synchroniser.streams()[0].received, 0U);
  EXPECT_DOUBLE_EQ(*session_.synchroniser.clockOffset(), -4.979) << "measured anew";
}

TEST_F(ClockTest, MergedJointsOfTheOldClockServeNoRowAfterAJump) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.joints = {"shoulder", "wrist"};
  configuration.merge_joint_states = true;
  Session session(configuration);
  RestartingListener listener(session.synchroniser);
  session.begin();
  session.joint(0.0, {"shoulder"}, {1.0}, 1.0);
  session.joint(10.0, {"wrist"}, {10.0}, 2.0);
  session.joint(-4996.0, {"shoulder"}, {1.0}, 3.0);
  session.joint(-4995.0, {"wrist"}, {20.0}, 4.0);
  session.joint(-4994.0, {"shoulder"}, {2.0}, 5.0);
  session.joint(-4993.0, {"wrist"}, {22.0}, 6.0);
  session.synchroniser.end(at(500.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_TRUE(std::isnan(listener.at(0, "q_wrist")));
  EXPECT_TRUE(std::isnan(listener.at(0, "wrist_age")));
  EXPECT_EQ(listener.at(1, "q_wrist"), 21.0) << "between −4995 ms and −4993 ms";
}

TEST_F(ClockTest, WhenTheMachinesClockIsSetBackAnEpisodeDoesNotWaitLongerForItsColumns) {
  SynchroniserConfiguration configuration;
  configuration.streams.push_back(makeStream("stick", StreamType::joy));
  Session session(configuration);
  session.begin();
  session.elbow(0.0, 0.0, 1.0);
  session.advance(500.0);
  EXPECT_TRUE(session.listener.episodes.empty());
  session.advance(-3'000'000.0);
  session.advance(-2'999'990.0);
  EXPECT_EQ(session.listener.rows().size(), 1U);
}

TEST_F(ClockTest, ASingleOutlierIsDroppedAndCounted) {
  session_.begin();
  joint(0.0, 1.0);
  joint(9000.0, 11.0);
  joint(20.0, 21.0);
  joint(-9000.0, 31.0);
  joint(40.0, 41.0);
  session_.end(500.0);
  EXPECT_TRUE(session_.listener.jumps.empty());
  EXPECT_EQ(rows(), 3U);
  EXPECT_EQ(session_.counter("clock_outliers"), 2U);
  EXPECT_EQ(
      session_.faultWith("more than 1 s off"),
      "a joint state's stamp was more than 1 s off, and the next one was not: it was dropped. Do two clocks stamp "
      "the joint states?");
}

TEST_F(ClockTest, AnOutlierThatArrivesTwiceIsStillOne) {
  session_.begin();
  joint(0.0, 1.0);
  joint(9000.0, 11.0);
  joint(9000.0, 12.0);
  joint(20.0, 21.0);
  session_.end(500.0);
  EXPECT_TRUE(session_.listener.jumps.empty());
  EXPECT_EQ(session_.counter("clock_outliers"), 1U);
  EXPECT_EQ(session_.counter("duplicate_rows"), 1U);
}

TEST_F(ClockTest, AStallWithLostMessagesIsNoJump) {
  session_.begin();
  joint(0.0, 1.0);
  joint(10.0, 3011.0);    // was held up for 3 s on its way
  joint(3000.0, 3012.0);  // those between were lost
  joint(3010.0, 3013.0);
  session_.end(9000.0);
  EXPECT_TRUE(session_.listener.jumps.empty());
  EXPECT_EQ(session_.counter("clock_outliers"), 0U);
  EXPECT_EQ(rows(), 4U);
}

TEST_F(ClockTest, APauseIsNoJump) {
  session_.begin();
  joint(0.0, 1.0);
  joint(60'000.0, 60'001.0);
  session_.end(70'000.0);
  EXPECT_EQ(rows(), 2U);
}

TEST_F(ClockTest, PlaybackAtFourTimesTheSpeedIsNoJump) {
  session_.begin();
  for (const double seconds : {0.0, 0.01, 5.0, 12.0, 13.0, 30.0}) joint(4000.0 * seconds, 1000.0 * seconds);
  session_.end(100'000.0);
  EXPECT_EQ(rows(), 6U);
  EXPECT_EQ(session_.counter("clock_outliers"), 0U);
}

TEST_F(ClockTest, UnderSimulatedTimeARestartIsABackwardJump) {
  RestartingListener listener(session_.synchroniser);
  session_.begin();
  const auto simulated = [this](double ms) { joint(ms, ms, ms - 86'400'000.0 + at(0.0) / 1e6); };
  for (const double ms : {90'000.0, 90'010.0, 90'020.0}) simulated(ms);
  session_.synchroniser.advance(at(90'025.0), listener);
  for (const double ms : {10.0, 20.0, 30.0}) simulated(ms);
  session_.synchroniser.advance(at(35.0), listener);
  session_.synchroniser.end(at(200.0), listener);
  ASSERT_EQ(listener.jumps.size(), 1U);
  EXPECT_DOUBLE_EQ(listener.jumps[0].seconds, -90.01);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows.size(), 3U);
  EXPECT_EQ(listener.episodes[1].rows.size(), 3U);
  EXPECT_EQ(session_.counter("pushed_late"), 0U);
}

TEST_F(ClockTest, WhenTheMachinesClockIsSetBackRowsGoOn) {
  // The robot keeps its own clock; the receipts fall by an hour.
  session_.begin();
  joint(0.0, 1.0, 1.0);
  joint(10.0, 11.0, 11.0);
  session_.advance(12.0);
  const double hour = 3'600'000.0;
  joint(20.0, 21.0 - hour, 21.0);
  joint(30.0, 31.0 - hour, 31.0);
  session_.advance(35.0 - hour);
  EXPECT_EQ(rows(), 2U) << "rows from before have waited enough";
  session_.advance(131.0 - hour);
  EXPECT_EQ(rows(), 4U) << "rows from after wait on the new setting";
  session_.end(140.0 - hour);
  EXPECT_TRUE(session_.listener.jumps.empty());
  EXPECT_EQ(session_.listener.episodes.size(), 1U);
}

TEST_F(ClockTest, WhenAllClocksAreSetBackTogetherTheEpisodeEndsAndNothingIsLost) {
  RestartingListener listener(session_.synchroniser);
  const double hour = 3'600'000.0;
  session_.begin();
  double position = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double now = 10.0 * i - (i < 100 ? 0.0 : hour);
    joint(now, now + 1.0, 10.0 * i + 1.0);
    session_.synchroniser.advance(at(now - 5.0), listener);
  }
  session_.synchroniser.end(at(2000.0 - hour), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  EXPECT_EQ(listener.episodes[0].rows.size(), 100U);
  EXPECT_EQ(listener.episodes[1].rows.size(), 100U);
  for (const auto& episode : listener.episodes) {
    for (const Row& row : episode.rows) EXPECT_EQ(row.values[0], position++);
  }
}

TEST_F(ClockTest, AVeryLateMessageDoesNotSetTheClockBack) {
  session_.begin();
  joint(0.0, 1.0);
  joint(5000.0, 5001.0);
  session_.advance(5050.0);
  session_.number(0, -10.0, 7.0, /*receipt_ms=*/2.0);
  session_.advance(5060.0);
  joint(5100.0, 5101.0);
  session_.end(6000.0);
  EXPECT_EQ(rows(), 3U);
  EXPECT_EQ(session_.counter("pushed_late"), 1U);
  EXPECT_EQ(session_.listener.at(2, "s0_value"), 7.0) << "it is in force all the same";
}

TEST_F(ClockTest, TheOffsetIsTheMedianOfTheFirstSecondThenFrozen) {
  session_.begin();
  joint(0.0, 3.0);
  joint(10.0, 13.0);
  joint(20.0, 99.0);
  joint(500.0, 504.0);
  joint(900.0, 904.0);
  joint(1003.0, 1003.5);  // after the first second
  session_.advance(1002.9);
  EXPECT_FALSE(session_.synchroniser.clockOffset().has_value());
  session_.advance(1004.0);
  EXPECT_DOUBLE_EQ(session_.synchroniser.clockOffset().value(), 0.004) << "median of 3, 3, 79, 4, 4 ms";
  joint(5000.0, 5090.0);
  session_.end(6000.0);
  EXPECT_DOUBLE_EQ(session_.synchroniser.clockOffset().value(), 0.004);
  EXPECT_EQ(session_.faultWith("this clock"), "");
}

TEST_F(ClockTest, AShortEpisodeFreezesTheOffsetWithWhatThereIs) {
  session_.begin();
  joint(0.0, 1.0);
  joint(10.0, 13.0);
  session_.end(20.0);
  EXPECT_DOUBLE_EQ(session_.synchroniser.clockOffset().value(), 0.002);
}

TEST_F(ClockTest, StampsFarFromThisClockAreReported) {
  session_.begin();
  joint(0.0, 100.0);
  joint(10.0, 110.000001);
  session_.end(500.0);
  EXPECT_EQ(session_.faultWith("this clock"), "") << "100 ms may be transport";

  Session ahead(SynchroniserConfiguration{});
  ahead.begin();
  ahead.elbow(35.0, 0.0, 0.0);
  ahead.end(500.0);
  EXPECT_EQ(ahead.faultWith("this clock"), "joint-state stamps are -35.0 ms from this clock (transport or skew)");
  EXPECT_EQ(ahead.synchroniser.faults()[0].severity, Severity::warning);
}

TEST_F(ClockTest, AnUnstampedStreamIsPlacedByReceipt) {
  session_.begin();
  StreamSample sample = makeNumber(0, at(5.0), 1.0);
  session_.synchroniser.push(0, sample);
  joint(7.0, 8.0);
  session_.end(500.0);
  EXPECT_EQ(session_.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(session_.listener.at(0, "s0_age"), 0.002);
  const StreamMetadata stream = session_.synchroniser.streams()[0];
  EXPECT_FALSE(stream.stamped);
  EXPECT_EQ(stream.receipt_delay.max, 0.0) << "a message without stamp has no delay to observe";
}

TEST_F(ClockTest, AnUnstampedStreamOnADistantClockIsAnError) {
  session_.begin();
  session_.synchroniser.push(0, makeNumber(0, at(5.0), 1.0));
  joint(-2500.0, 6.0);
  session_.end(500.0);
  EXPECT_TRUE(std::isnan(session_.listener.at(0, "s0_value")));
  const std::vector<Fault> faults = session_.synchroniser.faults();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].what, "joint-state stamps are 2506.0 ms from this clock (transport or skew)");
  EXPECT_EQ(faults[1].what,
            "stream s0 (/s0) has no stamps and is placed by this machine's clock, but the joint states' clock is 2.506 "
            "s away: its columns are useless. Synchronise the clocks, or set correct_clock_offset");
  EXPECT_EQ(faults[1].severity, Severity::error);
}

TEST_F(ClockTest, CorrectionMovesUnstampedStreamsByTheOffset) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold, Alignment::hold});
  configuration.correct_clock_offset = true;
  Session session(configuration);
  session.begin();
  session.synchroniser.push(0, makeNumber(0, at(5.0), 1.0));  // −2495 ms on the robot's clock
  session.synchroniser.push(1, makeNumber(at(-2496.0), at(5.0), 2.0));
  session.elbow(-2494.0, 0.0, 6.0);
  session.elbow(-1400.0, 0.0, 1100.0);
  session.advance(1005.0);
  EXPECT_TRUE(session.listener.rows().empty()) << "nothing can be placed before the offset is known";
  session.advance(1200.0);
  ASSERT_EQ(session.listener.rows().size(), 2U);
  EXPECT_EQ(session.synchroniser.clockOffset().value(), 2.5);
  EXPECT_EQ(session.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(session.listener.at(0, "s0_age"), 0.001);
  EXPECT_EQ(session.listener.at(0, "s1_age"), 0.002) << "stamped streams stay";
  for (const Fault& fault : session.synchroniser.faults()) EXPECT_EQ(fault.severity, Severity::warning) << fault.what;
}

TEST_F(ClockTest, CorrectionWorksInAnEpisodeShorterThanTheMeasurement) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.correct_clock_offset = true;
  Session session(configuration);
  session.begin();
  session.synchroniser.push(0, makeNumber(0, at(5.0), 1.0));
  session.elbow(-9994.0, 0.0, 6.0);
  session.advance(100.0);
  session.end(200.0);
  ASSERT_EQ(session.listener.rows().size(), 1U);
  EXPECT_EQ(session.listener.at(0, "s0_age"), 0.001);
}

TEST_F(ClockTest, CorrectionMeasuresAnewAfterAJump) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.correct_clock_offset = true;
  Session session(configuration);
  RestartingListener listener(session.synchroniser);
  session.begin();
  for (int i = 0; i < 400; ++i) {
    const double now = 10.0 * i;
    session.synchroniser.push(0, makeNumber(0, at(now), i));
    session.elbow(now + (i < 200 ? 3000.0 : 8000.0) + 1.0, i, now + 1.0);
    session.synchroniser.advance(at(now), listener);
  }
  session.synchroniser.end(at(5000.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  ASSERT_EQ(listener.episodes[0].rows.size(), 200U);
  ASSERT_EQ(listener.episodes[1].rows.size(), 200U);
  for (const Row& row : listener.episodes[0].rows) {
    EXPECT_EQ(row.values[4], row.values[0]) << "each joint state has its own command";
    EXPECT_EQ(row.values[5], 0.001);
  }
  // The command received with the first joint state after the jump was received before it; the next is corrected.
  for (std::size_t i = 2; i < 200; ++i) EXPECT_EQ(listener.episodes[1].rows[i].values[5], 0.001) << i;
  EXPECT_EQ(session.synchroniser.clockOffset().value(), -8.0);
}

TEST_F(ClockTest, UnstampedJointStatesAreKeyedByReceipt) {
  session_.begin();
  session_.synchroniser.push(makeJointState(0, at(10.0), {"elbow"}, {1.0}));
  session_.synchroniser.push(makeJointState(0, at(20.0), {"elbow"}, {2.0}));
  session_.end(500.0);
  ASSERT_EQ(session_.listener.rows().size(), 2U);
  EXPECT_EQ(session_.listener.rows()[0].stamp, at(10.0));
  EXPECT_EQ(session_.listener.at(0, "receipt_delay"), 0.0);
  EXPECT_EQ(session_.synchroniser.clockOffset().value(), 0.0);
}

TEST_F(ClockTest, AZeroStampFromAPublisherThatStampsIsDropped) {
  session_.begin();
  joint(0.0, 1.0);
  session_.synchroniser.push(makeJointState(0, at(11.0), {"elbow"}, {2.0}));
  session_.number(0, 1.0, 1.0);
  StreamSample sample = makeNumber(0, at(12.0), 2.0);
  session_.synchroniser.push(0, sample);
  sample.arrival.publisher = "/another";  // has not stamped so far
  sample.arrival.receipt = at(13.0);
  session_.synchroniser.push(0, sample);
  session_.end(500.0);
  EXPECT_EQ(rows(), 1U);
  EXPECT_EQ(session_.counter("zero_stamps"), 2U);
  EXPECT_EQ(session_.synchroniser.streams()[0].dropped, 1U);
  EXPECT_EQ(session_.synchroniser.streams()[0].received, 3U);
  EXPECT_EQ(session_.faultWith("stream s0"),
            "stream s0 (/s0) had a message with stamp 0 from a publisher that stamped its messages before; it was "
            "dropped");
  EXPECT_EQ(session_.faultWith("a joint state"),
            "a joint state came with stamp 0 from a publisher that stamped its messages before; it was dropped");
}

}  // namespace
}  // namespace demo_logger::testing_support
