#include "src/pipelines/findings.h"

#include <gtest/gtest.h>

#include <locale>

namespace demo_logger {
namespace {

TEST(FindingsTest, OnlyTheFirstFewOfAKindAreToldTheRestAreCounted) {
  Findings findings(2);
  for (int i = 0; i < 5; ++i) {
    findings.add("gap", i == 4 ? Severity::error : Severity::warning, "gap " + std::to_string(i));
  }
  findings.add("jump", Severity::error, "jump 0");
  const std::vector<Finding> told = findings.take();
  ASSERT_EQ(told.size(), 4U);
  EXPECT_EQ(told[1].sentence, "gap 1");
  EXPECT_EQ(told[2].sentence, "and 3 more of this kind.") << "stands behind those it counts";
  EXPECT_EQ(told[2].severity, Severity::error) << "as grave as the gravest that is not told";
  EXPECT_EQ(told[3].sentence, "jump 0");
}

TEST(FindingsTest, NumbersAreShortAndCarryTheirUnit) {
  EXPECT_EQ(formatDuration(0.0045), "4.5 ms");
  EXPECT_EQ(formatDuration(12.3456), "12.35 s");
  EXPECT_EQ(formatInstant(1234.5678), "at 1234.568 s");
  EXPECT_EQ(formatShare(0.0315), "3.15 %");
  EXPECT_EQ(formatCount(1, "row"), "1 row");
  EXPECT_EQ(formatCount(2, "row"), "2 rows");
  EXPECT_EQ(formatNames({"a"}), "a");
  EXPECT_EQ(formatNames({"a", "b"}), "a and b");
  EXPECT_EQ(formatNames({"a", "b", "c"}), "a and 2 more");
}

}  // namespace
}  // namespace demo_logger
