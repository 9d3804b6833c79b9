#include "src/recording/delay_statistics.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

TEST(DelayStatisticsTest, NothingWasDelayedWithoutMessages) {
  const DelaySummary summary = DelayStatistics().summary();
  EXPECT_EQ(summary.min, 0.0);
  EXPECT_EQ(summary.median, 0.0);
  EXPECT_EQ(summary.max, 0.0);
}

TEST(DelayStatisticsTest, OfFewDelaysTheMedianIsExact) {
  DelayStatistics statistics;
  for (const Nanoseconds milliseconds : {5, -1, 3, 9}) statistics.add(milliseconds * 1'000'000);
  EXPECT_EQ(statistics.summary().min, -0.001);
  EXPECT_EQ(statistics.summary().median, 0.004) << "between 3 ms and 5 ms";
  EXPECT_EQ(statistics.summary().max, 0.009);
}

TEST(DelayStatisticsTest, OfManyDelaysOldAndNewCountAlike) {
  // Delays that grow from 0 ms to 1000 ms: were later ones kept more often, the median would be above 500 ms.
  constexpr int kDelays = 1'000'000;
  DelayStatistics statistics;
  for (int i = 0; i <= kDelays; ++i) statistics.add(Nanoseconds{i} * 1000);
  EXPECT_EQ(statistics.summary().min, 0.0);
  EXPECT_EQ(statistics.summary().max, 1.0);
  const double kept_apart = 1.0 / (DelayStatistics::kKept / 2);
  EXPECT_NEAR(statistics.summary().median, 0.5, kept_apart);
}

}  // namespace
}  // namespace demo_logger
