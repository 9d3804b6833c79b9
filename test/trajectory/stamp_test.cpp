#include "demo_logger/trajectory/stamp.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace demo_logger {
namespace {

TEST(StampTest, OneSecondIsABillionNanoseconds) {
  EXPECT_EQ(fromSeconds(1.5), 1'500'000'000);
  EXPECT_EQ(fromSeconds(-1e-9), -1);
  EXPECT_DOUBLE_EQ(toSeconds(250'000'000), 0.25);
}

RC_GTEST_PROP(StampTest, DurationsOfUpTo48DaysSurviveTheWayThroughADouble, ()) {
  constexpr Nanoseconds kLongest = (Nanoseconds{1} << 22U) * kNanosecondsPerSecond;
  const Nanoseconds duration = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<Nanoseconds>(-kLongest, kLongest));
  RC_ASSERT(fromSeconds(toSeconds(duration)) == duration);
}

}  // namespace
}  // namespace demo_logger
