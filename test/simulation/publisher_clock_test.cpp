#include "demo_logger/simulation/publisher_clock.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

/// A publisher at 10 Hz whose messages are received `delay` after their stamp.
PublisherClock observeFor(Nanoseconds duration, Nanoseconds delay) {
  PublisherClock clock;
  for (Nanoseconds receipt = 0; receipt <= duration; receipt += 100 * kMillisecond) {
    clock.observe(receipt - delay, receipt);
  }
  return clock;
}

TEST(PublisherClockTest, IsDecidedAfterASecondOfMessages) {
  EXPECT_FALSE(observeFor(900 * kMillisecond, 5000 * kMillisecond).offset());
  EXPECT_EQ(observeFor(1000 * kMillisecond, 5000 * kMillisecond).offset(), 5000 * kMillisecond);
}

TEST(PublisherClockTest, NeedsFiveMessages) {
  PublisherClock clock;
  for (int i = 0; i < 4; ++i) clock.observe(0, (5000 + 1000 * i) * kMillisecond);
  EXPECT_FALSE(clock.offset());
  clock.observe(0, 9000 * kMillisecond);
  EXPECT_EQ(clock.offset(), 7000 * kMillisecond) << "the median of 5, 6, 7, 8 and 9 s";
}

TEST(PublisherClockTest, TakesUsualTransportForEqualClocks) {
  EXPECT_EQ(observeFor(1000 * kMillisecond, 100 * kMillisecond).offset(), 0);
  EXPECT_EQ(observeFor(1000 * kMillisecond, -20 * kMillisecond).offset(), 0);
  EXPECT_EQ(observeFor(1000 * kMillisecond, 101 * kMillisecond).offset(), 101 * kMillisecond);
  EXPECT_EQ(observeFor(1000 * kMillisecond, -21 * kMillisecond).offset(), -21 * kMillisecond);
}

TEST(PublisherClockTest, IsFrozenOnceDecidedHoweverStaleMessagesBecome) {
  PublisherClock clock = observeFor(1000 * kMillisecond, 0);
  for (int i = 0; i < 100; ++i) clock.observe(0, 60'000 * kMillisecond);
  EXPECT_EQ(clock.offset(), 0);
}

TEST(PublisherClockTest, IsJudgedAnewWhenFiveMessagesInARowWouldComeFromTheFuture) {
  PublisherClock clock = observeFor(1000 * kMillisecond, 3000 * kMillisecond);  // a second of stale messages
  Nanoseconds receipt = 2000 * kMillisecond;
  for (int i = 0; i < 4; ++i, receipt += 100 * kMillisecond) clock.observe(receipt, receipt);
  EXPECT_EQ(clock.offset(), 3000 * kMillisecond) << "four are not enough";
  clock.observe(receipt, receipt);
  EXPECT_FALSE(clock.offset());
  for (int i = 0; i < 10; ++i, receipt += 100 * kMillisecond) clock.observe(receipt, receipt);
  clock.observe(receipt, receipt);
  EXPECT_EQ(clock.offset(), 0);
}

}  // namespace
}  // namespace demo_logger
