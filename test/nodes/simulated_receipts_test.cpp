#include "src/nodes/simulated_receipts.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

constexpr Nanoseconds kTick = 5'000'000;

Arrival place(SimulatedReceipts& receipts, Nanoseconds receipt) {
  Arrival arrival;
  arrival.receipt = receipt;
  receipts.place(arrival);
  return arrival;
}

TEST(SimulatedReceiptsTest, MessagesOfOneTickKeepTheOrderOfTheirArrival) {
  SimulatedReceipts receipts;
  const Nanoseconds now = 100 * kNanosecondsPerSecond;
  EXPECT_EQ(place(receipts, now).receipt, now);
  EXPECT_EQ(place(receipts, now).receipt, now + 1);
  EXPECT_EQ(place(receipts, now).receipt, now + 2);
  EXPECT_EQ(place(receipts, now + kTick).receipt, now + kTick);
}

TEST(SimulatedReceiptsTest, AMessageOfTheTickBeforeStaysBehindThoseThatCameEarlier) {
  SimulatedReceipts receipts;
  const Nanoseconds now = 100 * kNanosecondsPerSecond;
  place(receipts, now);
  EXPECT_EQ(place(receipts, now - kTick).receipt, now + 1);
}

TEST(SimulatedReceiptsTest, AResetSetsTheReceiptBackAndLetsTheSteadyClockGoOn) {
  SimulatedReceipts receipts;
  place(receipts, 100 * kNanosecondsPerSecond);
  const Arrival reset = place(receipts, 10 * kNanosecondsPerSecond);
  EXPECT_EQ(reset.receipt, 10 * kNanosecondsPerSecond);
  EXPECT_EQ(reset.steady, 100 * kNanosecondsPerSecond);
  const Arrival later = place(receipts, 10 * kNanosecondsPerSecond + kTick);
  EXPECT_EQ(later.receipt, 10 * kNanosecondsPerSecond + kTick);
  EXPECT_EQ(later.steady, 100 * kNanosecondsPerSecond + kTick);
}

TEST(SimulatedReceiptsTest, AJumpAheadIsOneOfTheSteadyClockToo) {
  SimulatedReceipts receipts;
  place(receipts, 10 * kNanosecondsPerSecond);
  EXPECT_EQ(place(receipts, 100 * kNanosecondsPerSecond).steady, 100 * kNanosecondsPerSecond);
}

}  // namespace
}  // namespace demo_logger
