// Clocks that differ, and streams without stamps.

#include <gtest/gtest.h>

#include <cmath>

#include "clock_fixture.h"

namespace demo_logger::testing_support {
namespace {

using ClockOffsetTest = ClockTest;

TEST_F(ClockOffsetTest, TheOffsetIsTheMedianOfTheFirstSecondThenFrozen) {
  timeline_.begin();
  joint(0.0, 3.0);
  joint(10.0, 13.0);
  joint(20.0, 99.0);
  joint(500.0, 504.0);
  joint(900.0, 904.0);
  joint(1003.0, 1003.5);  // after the first second
  timeline_.advance(1002.9);
  EXPECT_FALSE(timeline_.synchroniser.clockOffset().has_value());
  timeline_.advance(1004.0);
  EXPECT_DOUBLE_EQ(timeline_.synchroniser.clockOffset().value(), 0.004) << "median of 3, 3, 79, 4, 4 ms";
  joint(5000.0, 5090.0);
  timeline_.end(6000.0);
  EXPECT_DOUBLE_EQ(timeline_.synchroniser.clockOffset().value(), 0.004);
  EXPECT_EQ(timeline_.faultWith("this clock"), "");
}

TEST_F(ClockOffsetTest, AShortEpisodeFreezesTheOffsetWithWhatThereIs) {
  timeline_.begin();
  joint(0.0, 1.0);
  joint(10.0, 13.0);
  timeline_.end(20.0);
  EXPECT_DOUBLE_EQ(timeline_.synchroniser.clockOffset().value(), 0.002);
}

TEST_F(ClockOffsetTest, StampsFarFromThisClockAreReported) {
  timeline_.begin();
  joint(0.0, 100.0);
  joint(10.0, 110.000001);
  timeline_.end(500.0);
  EXPECT_EQ(timeline_.faultWith("this clock"), "") << "100 ms may be transport";

  Timeline ahead(SynchroniserConfiguration{});
  ahead.begin();
  ahead.elbow(35.0, 0.0, 0.0);
  ahead.end(500.0);
  EXPECT_EQ(ahead.faultWith("this clock"), "joint-state stamps are -35.0 ms from this clock (transport or skew)");
  EXPECT_EQ(ahead.synchroniser.faults()[0].severity, Severity::warning);
}

TEST_F(ClockOffsetTest, AnUnstampedStreamIsPlacedByReceipt) {
  timeline_.begin();
  StreamSample sample = makeNumber(0, at(5.0), 1.0);
  timeline_.synchroniser.push(0, sample);
  joint(7.0, 8.0);
  timeline_.end(500.0);
  EXPECT_EQ(timeline_.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(timeline_.listener.at(0, "s0_age"), 0.002);
  const StreamMetadata stream = timeline_.synchroniser.streams()[0];
  EXPECT_FALSE(stream.stamped);
  EXPECT_EQ(stream.receipt_delay.max, 0.0) << "a message without stamp has no delay to observe";
}

TEST_F(ClockOffsetTest, AnUnstampedStreamOnADistantClockIsAnError) {
  timeline_.begin();
  timeline_.synchroniser.push(0, makeNumber(0, at(5.0), 1.0));
  joint(-2500.0, 6.0);
  timeline_.end(500.0);
  EXPECT_TRUE(std::isnan(timeline_.listener.at(0, "s0_value")));
  const std::vector<Fault> faults = timeline_.synchroniser.faults();
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].what, "joint-state stamps are 2506.0 ms from this clock (transport or skew)");
  EXPECT_EQ(faults[1].what,
            "stream s0 (/s0) has no stamps and is placed by this machine's clock, but the joint states' clock is 2.506 "
            "s away: its columns are useless. Synchronise the clocks, or set correct_clock_offset");
  EXPECT_EQ(faults[1].severity, Severity::error);
}

TEST_F(ClockOffsetTest, CorrectionMovesUnstampedStreamsByTheOffset) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold, Alignment::hold});
  configuration.correct_clock_offset = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.synchroniser.push(0, makeNumber(0, at(5.0), 1.0));  // −2495 ms on the robot's clock
  timeline.synchroniser.push(1, makeNumber(at(-2496.0), at(5.0), 2.0));
  timeline.elbow(-2494.0, 0.0, 6.0);
  timeline.elbow(-1400.0, 0.0, 1100.0);
  timeline.advance(1005.0);
  EXPECT_TRUE(timeline.listener.rows().empty()) << "nothing can be placed before the offset is known";
  timeline.advance(1200.0);
  ASSERT_EQ(timeline.listener.rows().size(), 2U);
  EXPECT_EQ(timeline.synchroniser.clockOffset().value(), 2.5);
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 0.001);
  EXPECT_EQ(timeline.listener.at(0, "s1_age"), 0.002) << "stamped streams stay";
  for (const Fault& fault : timeline.synchroniser.faults()) EXPECT_EQ(fault.severity, Severity::warning) << fault.what;
}

TEST_F(ClockOffsetTest, CorrectionWorksInAnEpisodeShorterThanTheMeasurement) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.correct_clock_offset = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.synchroniser.push(0, makeNumber(0, at(5.0), 1.0));
  timeline.elbow(-9994.0, 0.0, 6.0);
  timeline.advance(100.0);
  timeline.end(200.0);
  ASSERT_EQ(timeline.listener.rows().size(), 1U);
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 0.001);
}

TEST_F(ClockOffsetTest, CorrectionMeasuresAnewAfterAJump) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.correct_clock_offset = true;
  Timeline timeline(configuration);
  RestartingListener listener(timeline.synchroniser);
  timeline.begin();
  for (int i = 0; i < 400; ++i) {
    const double now = 10.0 * i;
    timeline.synchroniser.push(0, makeNumber(0, at(now), i));
    timeline.elbow(now + (i < 200 ? 3000.0 : 8000.0) + 1.0, i, now + 1.0);
    timeline.synchroniser.advance(at(now), listener);
  }
  timeline.synchroniser.end(at(5000.0), listener);
  ASSERT_EQ(listener.episodes.size(), 2U);
  ASSERT_EQ(listener.episodes[0].rows.size(), 200U);
  ASSERT_EQ(listener.episodes[1].rows.size(), 200U);
  for (const Row& row : listener.episodes[0].rows) {
    EXPECT_EQ(row.values[4], row.values[0]) << "each joint state has its own command";
    EXPECT_EQ(row.values[5], 0.001);
  }
  // The command received with the first joint state after the jump was received before it; the next is corrected.
  for (std::size_t i = 2; i < 200; ++i) EXPECT_EQ(listener.episodes[1].rows[i].values[5], 0.001) << i;
  EXPECT_EQ(timeline.synchroniser.clockOffset().value(), -8.0);
}

TEST_F(ClockOffsetTest, UnstampedJointStatesAreKeyedByReceipt) {
  timeline_.begin();
  timeline_.synchroniser.push(makeJointState(0, at(10.0), {"elbow"}, {1.0}));
  timeline_.synchroniser.push(makeJointState(0, at(20.0), {"elbow"}, {2.0}));
  timeline_.end(500.0);
  ASSERT_EQ(timeline_.listener.rows().size(), 2U);
  EXPECT_EQ(timeline_.listener.rows()[0].stamp, at(10.0));
  EXPECT_TRUE(std::isnan(timeline_.listener.at(0, "receipt_delay"))) << "nobody knows it";
  EXPECT_EQ(timeline_.faultWith("joint states"),
            "joint states have no stamps: their rows are placed by receipt, and the transport delay is in them");
  EXPECT_EQ(timeline_.synchroniser.clockOffset().value(), 0.0);
}

TEST_F(ClockOffsetTest, AZeroStampFromAPublisherThatStampsIsDropped) {
  timeline_.begin();
  joint(0.0, 1.0);
  timeline_.synchroniser.push(makeJointState(0, at(11.0), {"elbow"}, {2.0}));
  timeline_.number(0, 1.0, 1.0);
  StreamSample sample = makeNumber(0, at(12.0), 2.0);
  timeline_.synchroniser.push(0, sample);
  sample.arrival.publisher = "/another";  // has not stamped so far
  sample.arrival.receipt = at(13.0);
  timeline_.synchroniser.push(0, sample);
  timeline_.end(500.0);
  EXPECT_EQ(rows(), 1U);
  EXPECT_EQ(timeline_.counter("zero_stamps"), 2U);
  EXPECT_EQ(timeline_.synchroniser.streams()[0].dropped, 1U);
  EXPECT_EQ(timeline_.synchroniser.streams()[0].received, 3U);
  EXPECT_EQ(timeline_.faultWith("stream s0"),
            "stream s0 (/s0) had a message with stamp 0 from a publisher that stamped its messages before; it was "
            "dropped");
  EXPECT_EQ(timeline_.faultWith("a joint state"),
            "a joint state came with stamp 0 from a publisher that stamped its messages before; it was dropped");
}

}  // namespace
}  // namespace demo_logger::testing_support
