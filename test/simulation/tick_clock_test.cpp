#include "demo_logger/simulation/tick_clock.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;
constexpr Nanoseconds kEpoch = 1'700'000'000 * kNanosecondsPerSecond;

TEST(TickClockTest, StampsAreExactlyOnePeriodApart) {
  TickClock clock({kMillisecond, false, 1.0}, 0, kEpoch + 123);
  EXPECT_EQ(clock.stamp(), kEpoch + 123);
  EXPECT_EQ(clock.due(), 0);
  clock.advance(0, kEpoch + 123);
  EXPECT_EQ(clock.stamp(), kEpoch + 123 + kMillisecond);
  EXPECT_EQ(clock.due(), kMillisecond);
}

TEST(TickClockTest, StampsStayWithARosClockThatDriftsAgainstTheSteadyOne) {
  TickClock clock({kMillisecond, false, 1.0}, 0, kEpoch);
  const double drift = 50e-6;  // a usual quartz against network time
  Nanoseconds ros_now = kEpoch;
  for (int k = 0; k < 3'600'000; ++k) {  // an hour, which would drift by 180 ms
    const Nanoseconds steady_now = clock.due();
    ros_now = kEpoch + steady_now + static_cast<Nanoseconds>(drift * static_cast<double>(steady_now));
    clock.advance(steady_now, ros_now);
  }
  EXPECT_LE(std::abs(clock.stamp() - kMillisecond - ros_now), 2000) << "[ns]";
  EXPECT_EQ(clock.jumps(), 0U);
}

TEST(TickClockTest, ALateLoopCatchesUpTickByTickAndTheOverrunsAreCounted) {
  TickClock clock({kMillisecond, false, 1.0}, 0, kEpoch);
  const Nanoseconds stalled_until = 10 * kMillisecond;
  int ticks = 0;
  while (clock.due() < stalled_until) {
    clock.advance(stalled_until, kEpoch + stalled_until);
    ++ticks;
  }
  EXPECT_EQ(ticks, 10) << "no tick is left out";
  EXPECT_EQ(clock.overruns(), 9U) << "late by 10, 9, … 2 ms; the last by a period is not an overrun";
  EXPECT_EQ(clock.largestDelay(), 10 * kMillisecond);
  EXPECT_EQ(clock.jumps(), 0U);
}

TEST(TickClockTest, AfterALongStallItGoesOnFromNow) {
  TickClock clock({kMillisecond, false, 1.0}, 0, kEpoch);
  const Nanoseconds stalled_until = 5 * kNanosecondsPerSecond;
  clock.advance(stalled_until, kEpoch + stalled_until);
  EXPECT_EQ(clock.stamp(), kEpoch + stalled_until + kMillisecond);
  EXPECT_EQ(clock.due(), stalled_until + kMillisecond);
  EXPECT_EQ(clock.jumps(), 1U);
}

TEST(TickClockTest, AfterAJumpOfTheRosClockStampsAreOnTheNewTime) {
  TickClock clock({kMillisecond, false, 1.0}, 0, kEpoch);
  const Nanoseconds new_epoch = kEpoch - 3600 * kNanosecondsPerSecond;
  clock.advance(0, new_epoch);
  EXPECT_EQ(clock.stamp(), new_epoch + kMillisecond);
  EXPECT_EQ(clock.jumps(), 1U);
}

TEST(TickClockTest, OwnTimeStartsAtASecondAndRunsAtItsSpeed) {
  TickClock clock({kMillisecond, true, 2.0}, 0, kEpoch);
  EXPECT_EQ(clock.stamp(), kNanosecondsPerSecond) << "a zero stamp would mean none";
  clock.advance(0, kEpoch);
  EXPECT_EQ(clock.stamp(), kNanosecondsPerSecond + kMillisecond);
  EXPECT_EQ(clock.due(), kMillisecond / 2);
}

TEST(TickClockTest, AsFastAsItGoesNothingIsLate) {
  TickClock clock({kMillisecond, true, 0.0}, 0, kEpoch);
  for (int k = 0; k < 100; ++k) clock.advance(k * 7 * kMillisecond, kEpoch);
  EXPECT_EQ(clock.stamp(), kNanosecondsPerSecond + 100 * kMillisecond);
  EXPECT_EQ(clock.overruns(), 0U);
}

TEST(TickClockTest, APauseLeavesAGapInRosTimeAndNoneInOwnTime) {
  TickClock following({kMillisecond, false, 1.0}, 0, kEpoch);
  following.resume(9 * kNanosecondsPerSecond, kEpoch + 9 * kNanosecondsPerSecond);
  EXPECT_EQ(following.stamp(), kEpoch + 9 * kNanosecondsPerSecond);

  TickClock own({kMillisecond, true, 1.0}, 0, kEpoch);
  own.resume(9 * kNanosecondsPerSecond, kEpoch);
  EXPECT_EQ(own.stamp(), kNanosecondsPerSecond);
  EXPECT_EQ(own.due(), 9 * kNanosecondsPerSecond);
}

}  // namespace
}  // namespace demo_logger
