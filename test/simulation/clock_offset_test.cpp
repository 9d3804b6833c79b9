#include "demo_logger/simulation/clock_offset.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

/// A publisher at 10 Hz whose messages are received `delay` after their stamp.
ClockOffset observeFor(Nanoseconds duration, Nanoseconds delay) {
  ClockOffset clock;
  for (Nanoseconds receipt = 0; receipt <= duration; receipt += 100 * kMillisecond) {
    clock.observe(receipt - delay, receipt);
  }
  return clock;
}

TEST(ClockOffsetTest, IsDecidedAfterASecondOfMessages) {
  EXPECT_FALSE(observeFor(900 * kMillisecond, 5000 * kMillisecond).value());
  EXPECT_EQ(observeFor(1000 * kMillisecond, 5000 * kMillisecond).value(), 5000 * kMillisecond);
}

TEST(ClockOffsetTest, NeedsFiveMessages) {
  ClockOffset clock;
  for (int i = 0; i < 4; ++i) clock.observe(0, (5000 + 1000 * i) * kMillisecond);
  EXPECT_FALSE(clock.value());
  clock.observe(0, 9000 * kMillisecond);
  EXPECT_EQ(clock.value(), 7000 * kMillisecond) << "the median of 5, 6, 7, 8 and 9 s";
}

TEST(ClockOffsetTest, TakesUsualTransportForEqualClocks) {
  EXPECT_EQ(observeFor(1000 * kMillisecond, 100 * kMillisecond).value(), 0);
  EXPECT_EQ(observeFor(1000 * kMillisecond, -20 * kMillisecond).value(), 0);
  EXPECT_EQ(observeFor(1000 * kMillisecond, 101 * kMillisecond).value(), 101 * kMillisecond);
  EXPECT_EQ(observeFor(1000 * kMillisecond, -21 * kMillisecond).value(), -21 * kMillisecond);
}

TEST(ClockOffsetTest, IsFrozenOnceDecided) {
  ClockOffset clock = observeFor(1000 * kMillisecond, 0);
  for (int i = 0; i < 100; ++i) clock.observe(0, 60'000 * kMillisecond);
  EXPECT_EQ(clock.value(), 0);
}

}  // namespace
}  // namespace demo_logger
