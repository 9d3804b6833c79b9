// What a row holds of a stream, by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "timeline.h"

namespace demo_logger::testing_support {
namespace {

TEST(AlignmentTest, HoldGivesTheLastMessageAtOrBeforeTheRow) {
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.begin();
  timeline.number(0, 0.0, 1.0);
  timeline.number(0, 10.0, 2.0);
  timeline.number(0, 20.0, 3.0);
  timeline.elbow(9.0, 0.0);
  timeline.elbow(10.0, 0.0);
  timeline.elbow(19.0, 0.0);
  timeline.end(200.0);
  ASSERT_EQ(timeline.listener.rows().size(), 3U);
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(timeline.listener.at(1, "s0_value"), 2.0) << "a message at the very instant is in force";
  EXPECT_EQ(timeline.listener.at(2, "s0_value"), 2.0);
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 0.009);
  EXPECT_EQ(timeline.listener.at(1, "s0_age"), 0.0);
  EXPECT_EQ(timeline.listener.at(2, "s0_age"), 0.009);
}

TEST(AlignmentTest, NothingIsFilledInBeforeTheFirstMessage) {
  Timeline timeline(numberStreams({Alignment::hold, Alignment::linear, Alignment::nearest}));
  timeline.begin();
  timeline.elbow(0.0, 0.0);
  timeline.elbow(10.0, 0.0);
  for (std::size_t stream = 0; stream < 3; ++stream) timeline.number(stream, 11.0, 5.0);
  timeline.end(200.0);
  for (const char* column : {"s0_value", "s0_age", "s1_value", "s1_age"}) {
    EXPECT_TRUE(std::isnan(timeline.listener.at(1, column))) << column;
  }
  EXPECT_EQ(timeline.listener.at(1, "s2_value"), 5.0) << "the nearest message may be a later one";
  EXPECT_EQ(timeline.listener.at(1, "s2_age"), -0.001) << "and its age is negative then";
  EXPECT_EQ(timeline.counter("unbridged_gaps"), 0U) << "what never began has no gap";
}

TEST(AlignmentTest, LinearLiesBetweenTheNeighbours) {
  Timeline timeline(numberStreams({Alignment::linear}));
  timeline.begin();
  timeline.number(0, 0.0, 1.0);
  timeline.number(0, 10.0, 3.0);
  timeline.elbow(2.5, 0.0);
  timeline.elbow(10.0, 0.0);
  timeline.end(200.0);
  EXPECT_DOUBLE_EQ(timeline.listener.at(0, "s0_value"), 1.5);
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 0.0025) << "the age is that of the earlier neighbour";
  EXPECT_EQ(timeline.listener.at(1, "s0_value"), 3.0) << "at its own instant a message needs no later neighbour";
  EXPECT_EQ(timeline.listener.at(1, "s0_age"), 0.0);
  EXPECT_EQ(timeline.counter("unbridged_gaps"), 0U);
}

TEST(AlignmentTest, LinearIsMissingWithoutALaterNeighbourInTime) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::linear});
  configuration.max_wait = 0.1;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.number(0, 0.0, 1.0);
  timeline.elbow(5.0, 0.0, /*receipt_ms=*/6.0);
  timeline.number(0, 10.0, 3.0, /*receipt_ms=*/106.000001);
  timeline.elbow(6.0, 0.0, /*receipt_ms=*/6.1);
  timeline.end(300.0);
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "s0_value"))) << "the neighbour came 1 ns after the wait of 100 ms";
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 0.005);
  EXPECT_DOUBLE_EQ(timeline.listener.at(1, "s0_value"), 2.2) << "but within that of the next row";
  EXPECT_EQ(timeline.counter("unbridged_gaps"), 1U);
  EXPECT_EQ(timeline.faultWith("interpolated"),
            "stream s0 (/s0) could not be interpolated: no later message came in time, or more than max_gap (0.5 "
            "s) after the earlier one; such values are NaN");
}

TEST(AlignmentTest, LinearDoesNotBridgeMoreThanMaxGap) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::linear});
  configuration.max_gap = 0.02;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.number(0, 0.0, 1.0);
  timeline.number(0, 20.0, 3.0);
  timeline.number(0, 40.000001, 5.0);
  timeline.elbow(10.0, 0.0);
  timeline.elbow(30.0, 0.0);
  timeline.end(200.0);
  EXPECT_DOUBLE_EQ(timeline.listener.at(0, "s0_value"), 2.0) << "a gap of exactly max_gap is bridged";
  EXPECT_TRUE(std::isnan(timeline.listener.at(1, "s0_value"))) << "one of 1 ns more is not";
  EXPECT_EQ(timeline.counter("unbridged_gaps"), 1U);
}

TEST(AlignmentTest, NearestTakesTheEarlierOfTwoEquallyClose) {
  Timeline timeline(numberStreams({Alignment::nearest}));
  timeline.begin();
  timeline.number(0, 0.0, 1.0);
  timeline.number(0, 10.0, 2.0);
  timeline.elbow(4.0, 0.0);
  timeline.elbow(5.0, 0.0);
  timeline.elbow(6.0, 0.0);
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 1.0);
  EXPECT_EQ(timeline.listener.at(1, "s0_value"), 1.0);
  EXPECT_EQ(timeline.listener.at(1, "s0_age"), 0.005);
  EXPECT_EQ(timeline.listener.at(2, "s0_value"), 2.0);
  EXPECT_EQ(timeline.listener.at(2, "s0_age"), -0.004);
}

TEST(AlignmentTest, LatencyMovesAMessageToWhenItHappened) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold, Alignment::hold});
  configuration.streams[0].latency = 0.008;
  configuration.streams[1].latency = -0.008;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.number(0, 10.0, 1.0);  // happened at 2
  timeline.number(1, 0.0, 1.0);   // takes effect at 8
  timeline.elbow(1.0, 0.0);
  timeline.elbow(5.0, 0.0);
  timeline.elbow(9.0, 0.0);
  timeline.end(200.0);
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "s0_value")));
  EXPECT_EQ(timeline.listener.at(1, "s0_age"), 0.003);
  EXPECT_TRUE(std::isnan(timeline.listener.at(1, "s1_value")));
  EXPECT_EQ(timeline.listener.at(2, "s1_age"), 0.001);
}

TEST(AlignmentTest, ALongLatencyLengthensTheWaitOfEveryRow) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold});
  configuration.max_wait = 0.01;
  configuration.streams[0].latency = 0.2;
  Timeline timeline(configuration);
  timeline.begin();
  timeline.elbow(0.0, 0.0, /*receipt_ms=*/0.0);
  timeline.number(0, 199.0, 7.0, /*receipt_ms=*/210.0);  // of −1 ms, within 10 ms + 200 ms
  timeline.advance(209.0);
  EXPECT_TRUE(timeline.listener.rows().empty());
  timeline.advance(210.0);
  ASSERT_EQ(timeline.listener.rows().size(), 1U);
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 7.0);
}

StreamSample makeTurnAboutZ(double stamp_ms, double angle) {
  return makeStreamSample(StreamType::pose, at(stamp_ms), at(stamp_ms + 1.0),
                          {stamp_ms, 0.0, 0.0, 0.0, 0.0, std::sin(angle / 2.0), std::cos(angle / 2.0)});
}

TEST(AlignmentTest, OrientationsTurnAtConstantSpeedAlongTheShorterArc) {
  SynchroniserConfiguration configuration;
  configuration.streams.push_back(makeStream("hand", StreamType::pose, Alignment::linear));
  Timeline timeline(configuration);
  timeline.begin();
  timeline.synchroniser.push(0, makeTurnAboutZ(0.0, 0.0));
  StreamSample same_turn_other_sign = makeTurnAboutZ(10.0, 1.2);
  for (std::size_t i = 3; i < 7; ++i) same_turn_other_sign.values[i] *= -1.0;
  timeline.synchroniser.push(0, same_turn_other_sign);
  timeline.elbow(2.5, 0.0);
  timeline.end(200.0);
  EXPECT_NEAR(timeline.listener.at(0, "hand_x"), 2.5, 1e-15);
  EXPECT_NEAR(timeline.listener.at(0, "hand_qz"), std::sin(0.15), 1e-15) << "a quarter of 1.2 rad is 0.3 rad";
  EXPECT_NEAR(timeline.listener.at(0, "hand_qw"), std::cos(0.15), 1e-15);
  EXPECT_EQ(timeline.counter("non_unit_quaternions"), 0U);
}

TEST(AlignmentTest, AQuaternionThatIsNoRotationIsKeptAndReported) {
  SynchroniserConfiguration configuration;
  configuration.streams.push_back(makeStream("hand", StreamType::pose, Alignment::hold));
  Timeline timeline(configuration);
  timeline.begin();
  timeline.synchroniser.push(0,
                             makeStreamSample(StreamType::pose, at(0.0), at(1.0), {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0}));
  timeline.elbow(1.0, 0.0);
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.at(0, "hand_qw"), 2.0);
  EXPECT_EQ(timeline.counter("non_unit_quaternions"), 1U);
  EXPECT_EQ(timeline.faultWith("quaternion"),
            "stream hand (/hand) sent an orientation whose quaternion has length 2, expected 1; it is recorded "
            "as it came");
}

TEST(AlignmentTest, OfEqualStampsTheLastReceivedReplaces) {
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.begin();
  timeline.number(0, 0.0, 1.0, /*receipt_ms=*/3.0);
  timeline.number(0, 0.0, 2.0, /*receipt_ms=*/2.0);
  timeline.elbow(1.0, 0.0);
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), 1.0) << "received at 3 ms, the other at 2 ms";
}

TEST(AlignmentTest, ValuesThatAreNotFiniteAreMissing) {
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.begin();
  timeline.number(0, 0.0, std::numeric_limits<double>::infinity());
  timeline.elbow(1.0, -std::numeric_limits<double>::infinity());
  timeline.end(200.0);
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "s0_value")));
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 0.001) << "the message was there, only its value was not";
  EXPECT_TRUE(std::isnan(timeline.listener.at(0, "q_elbow")));
  EXPECT_EQ(timeline.counter("non_finite_values"), 2U);
  EXPECT_EQ(timeline.faultWith("stream s0"), "stream s0 (/s0) sent a value that is not finite; it is recorded as NaN");
  EXPECT_EQ(timeline.faultWith("joint elbow"),
            "joint elbow came with a position that is not finite; it is recorded as NaN");
}

TEST(AlignmentTest, EpochStampsKeepTheirNanosecond) {
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.begin();
  timeline.synchroniser.push(0, makeNumber(kToday + 1, kToday + 2, 1.0));
  timeline.synchroniser.push(makeJointState(kToday + 4, kToday + 5, {"elbow"}, {0.0}));
  timeline.end(200.0);
  EXPECT_EQ(timeline.listener.at(0, "s0_age"), 3e-9);
  EXPECT_EQ(timeline.listener.at(0, "receipt_delay"), 1e-9);
}

}  // namespace
}  // namespace demo_logger::testing_support
