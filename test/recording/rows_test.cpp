// When rows are released, in which order, and which joint states make none.

#include <gtest/gtest.h>

#include "timeline.h"

namespace demo_logger::testing_support {
namespace {

std::vector<double> positionsOf(const Timeline& timeline) {
  std::vector<double> positions;
  for (const Row& row : timeline.listener.rows()) positions.push_back(row.values[0]);
  return positions;
}

using Positions = std::vector<double>;

TEST(RowsTest, ARowIsReleasedWhenItsWaitIsOver) {
  SynchroniserConfiguration configuration;
  configuration.max_wait = 0.1;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.elbow(0.0, 1.0, /*receipt_ms=*/5.0);
  timeline.advance(104.0);
  EXPECT_TRUE(timeline.listener.rows().empty());
  timeline.advance(105.0);
  EXPECT_EQ(positionsOf(timeline), Positions({1.0}));
  EXPECT_EQ(timeline.listener.rows()[0].stamp, at(0.0));
  EXPECT_EQ(timeline.listener.rows()[0].receipt, at(5.0));
}

TEST(RowsTest, JointStatesReorderedWithinTheWaitArePutIntoOrder) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.elbow(0.0, 0.0, 1.0);
  timeline.elbow(20.0, 2.0, 21.0);
  timeline.elbow(10.0, 1.0, 31.0);
  timeline.elbow(30.0, 3.0, 32.0);
  timeline.end(500.0);
  EXPECT_EQ(positionsOf(timeline), Positions({0.0, 1.0, 2.0, 3.0}));
  EXPECT_EQ(timeline.counter("late_rows"), 0U);
}

TEST(RowsTest, JointStatesBehindAReleasedRowAreLate) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.elbow(20.0, 2.0, 21.0);
  timeline.elbow(10.0, 1.0, 122.0);
  timeline.end(500.0);
  EXPECT_EQ(positionsOf(timeline), Positions({2.0}));
  EXPECT_EQ(timeline.counter("late_rows"), 1U);
  EXPECT_EQ(
      timeline.faultWith("dropped"),
      "a joint state came when later ones had become rows, 0.010 s behind them; it was dropped. A longer max_wait "
      "leaves more time to put them into order");
}

TEST(RowsTest, OfEqualStampsTheFirstIsKept) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.elbow(0.0, 1.0, 1.0);
  timeline.elbow(0.0, 2.0, 2.0);
  timeline.elbow(0.0, 3.0, 300.0);
  timeline.end(500.0);
  EXPECT_EQ(positionsOf(timeline), Positions({1.0}));
  EXPECT_EQ(timeline.counter("duplicate_rows"), 2U);
  EXPECT_EQ(timeline.counter("late_rows"), 0U);
}

TEST(RowsTest, ARowThatWaitsForAnEarlierOneKeepsItsOwnDeadline) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.max_wait = 0.1;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.number(0, 0.0, 1.0, 1.0);
  timeline.elbow(20.0, 2.0, /*receipt_ms=*/20.0);
  timeline.elbow(10.0, 1.0, /*receipt_ms=*/100.0);  // must be released first, at 200
  timeline.number(0, 15.0, 9.0, /*receipt_ms=*/150.0);
  timeline.end(500.0);
  EXPECT_EQ(positionsOf(timeline), Positions({1.0, 2.0}));
  EXPECT_EQ(timeline.listener.at(1, "s0_value"), 1.0) << "the message came after 120 ms";
  EXPECT_EQ(timeline.synchroniser.streams()[0].late, 1U);
}

TEST(RowsTest, StreamsThatPromiseOrderReleaseRowsEarly) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold, Alignment::linear});
  for (StreamConfiguration& stream : configuration.streams) stream.in_order = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.elbow(10.0, 1.0);
  timeline.number(0, 9.0, 1.0);
  timeline.number(1, 10.0, 1.0, 11.5);
  timeline.advance(12.0);
  EXPECT_TRUE(timeline.listener.rows().empty()) << "the held stream may still send a message of 10 ms";
  timeline.number(0, 10.000001, 2.0, 13.0);
  timeline.advance(13.0);
  EXPECT_EQ(positionsOf(timeline), Positions({1.0}));
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(timeline.listener.at(0, "s1_value"), 1.0);
}

TEST(RowsTest, WithoutStreamsRowsStillWaitForReorderedJointStates) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.elbow(10.0, 1.0);
  timeline.advance(50.0);
  EXPECT_TRUE(timeline.listener.rows().empty());
}

TEST(RowsTest, AMessageThatBreaksThePromiseOfOrderIsDroppedAndReported) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.streams[0].in_order = true;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.number(0, 10.0, 1.0, 11.0);
  timeline.number(0, 5.0, 2.0, 12.0);
  timeline.elbow(7.0, 0.0, 13.0);
  timeline.end(500.0);
  EXPECT_TRUE(timeline.listener.rows()[0].values[4] != timeline.listener.rows()[0].values[4]);
  EXPECT_EQ(timeline.synchroniser.streams()[0].dropped, 1U);
  EXPECT_EQ(timeline.faultWith("in_order"),
            "stream s0 (/s0) is declared in_order, but a message came 0.005000 s behind the one before it; it was "
            "dropped. Without in_order it would be put into order");
}

TEST(RowsTest, AGapInTheJointStatesIsReported) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  timeline.elbow(0.0, 0.0);
  timeline.elbow(500.0, 0.0);
  timeline.elbow(1234.0, 0.0);
  timeline.end(2000.0);
  EXPECT_EQ(timeline.faultWith("gap"),
            "a gap of 0.734 s in the joint states; were messages lost, or did the robot pause?");
  EXPECT_EQ(timeline.listener.rows().size(), 3U) << "and nothing is filled in";
}

TEST(RowsTest, LostJointStatesAreAGapMeasuredByTheirUsualPace) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  for (int ms = 0; ms < 400; ++ms) {
    if (ms >= 100 && ms < 230) continue;  // 130 lost in a row, far less than max_gap
    if (ms == 300) continue;              // a single one lost is no gap yet
    timeline.elbow(ms, 0.0);
  }
  timeline.end(2000.0);
  EXPECT_EQ(timeline.faultWith("gap"),
            "a gap of 0.131 s in the joint states, which come every 0.001 s; were messages lost, or did the robot "
            "pause?");
  EXPECT_EQ(timeline.counter("gaps"), 1U);
}

TEST(RowsTest, AnUnevenPaceIsNoGap) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  for (int k = 0; k < 200; ++k) timeline.elbow(10.0 * k + 8.0 * (k % 3), 0.0);  // every 6 to 18 ms
  timeline.end(5000.0);
  EXPECT_EQ(timeline.counter("gaps"), 0U);
  EXPECT_EQ(timeline.listener.rows().size(), 200U);
}

TEST(RowsTest, AMessagePushedBehindTheWatermarkCountsAsReceivedJustAfterIt) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  Timeline timeline(configuration);
  timeline.begin();
  timeline.elbow(0.0, 0.0, /*receipt_ms=*/0.0);
  timeline.elbow(1.0, 1.0, /*receipt_ms=*/1.0);
  timeline.advance(100.0);  // the first row is final
  timeline.number(0, -5.0, 3.0, /*receipt_ms=*/100.0);
  timeline.end(500.0);
  EXPECT_TRUE(timeline.listener.at(0, "s0_value") != 3.0);
  EXPECT_EQ(timeline.listener.at(1, "s0_value"), 3.0);
  EXPECT_EQ(timeline.counter("pushed_late"), 1U);
  EXPECT_EQ(timeline.faultWith("dealt with"),
            "a message reached the recorder when its time of receipt had been dealt with; it counts as received then. "
            "Is the machine overloaded?");
}

TEST(RowsTest, TheMetadataOfAStreamTellsWhatBecameOfItsMessages) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.streams[0].latency = 0.001;
  Timeline timeline(configuration);
  timeline.begin(0.0);
  for (const double ms : {10.0, 20.0, 21.0, 50.0}) {
    StreamSample sample = makeNumber(at(ms), at(ms + ms / 10.0), ms);
    sample.arrival.publisher = "/device";
    sample.arrival.frame_id = "tool";
    timeline.synchroniser.push(0, sample);
  }
  timeline.elbow(15.0, 0.0);
  timeline.elbow(25.0, 0.0);
  timeline.number(0, 12.0, 12.0, /*receipt_ms=*/300.0);  // would have changed the row at 15 ms
  timeline.number(0, 20.5, 20.5, /*receipt_ms=*/300.0);  // is hidden from the row at 25 ms by the message of 21 ms
  timeline.synchroniser.push(0, makeTwist(at(40.0), at(41.0), 0.0));
  timeline.end(500.0);
  const StreamMetadata stream = timeline.synchroniser.streams().at(0);
  EXPECT_EQ(stream.name, "s0");
  EXPECT_EQ(stream.topic, "/s0");
  EXPECT_EQ(stream.type, "number");
  EXPECT_EQ(stream.align, "hold");
  EXPECT_EQ(stream.latency, 0.001);
  EXPECT_EQ(stream.publishers, std::vector<std::string>({"/device"}));
  EXPECT_TRUE(stream.stamped);
  EXPECT_EQ(stream.received, 7U);
  EXPECT_EQ(stream.used, 2U) << "those of 10 ms and 21 ms";
  EXPECT_EQ(stream.late, 1U);
  EXPECT_EQ(stream.dropped, 1U) << "the twist";
  EXPECT_EQ(stream.largest_gap, 0.029) << "from 21 ms to 50 ms";
  EXPECT_EQ(stream.receipt_delay.min, 0.001);
  EXPECT_NEAR(stream.receipt_delay.median, 0.00355, 1e-12) << "between 2.1 ms and 5 ms";
  EXPECT_EQ(stream.receipt_delay.max, 0.288);
  EXPECT_EQ(timeline.counter("malformed_stream_messages"), 1U);
  EXPECT_EQ(timeline.faultWith("twist"),
            "stream s0 (/s0) sent a twist with 6 values, expected a number; it was dropped");
  EXPECT_EQ(timeline.faultWith("frame_id"), "stream s0 (/s0) changed its frame_id from 'tool' to ''");
}

}  // namespace
}  // namespace demo_logger::testing_support
