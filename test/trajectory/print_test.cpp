#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <limits>

#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

TEST(PrintTest, NumbersAreShortUnlessDecimalsAreAskedFor) {
  EXPECT_EQ(print(0.5), "0.5");
  EXPECT_EQ(print(1.0), "1");
  EXPECT_EQ(print(2.0 / 3.0), "0.666667");
  EXPECT_EQ(print(1e-5), "1e-05");
  EXPECT_EQ(print(0.5, 3), "0.500");
  EXPECT_EQ(print(-12.3456, 1), "-12.3");
}

TEST(PrintTest, NumbersThatDifferArePrintedDifferentlyWhereThatMatters) {
  EXPECT_EQ(print(1234.567891), print(1234.567892));
  EXPECT_EQ(printExactly(1234.567891), "1234.567891");
  EXPECT_EQ(printExactly(1234.567892), "1234.567892");
  EXPECT_EQ(printExactly(0.1), "0.1");
  EXPECT_EQ(printExactly(-std::numeric_limits<double>::max()), "-1.7976931348623157e+308");
}

TEST(PrintTest, NoNumberIsTooLong) {
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(print(-largest, 3).size(), 1 + 309 + 1 + 3);
  EXPECT_EQ(print(largest), "1.79769e+308");
  EXPECT_EQ(print(std::numeric_limits<double>::infinity(), 3), "inf");
}

TEST(PrintTest, TheLocaleChangesNothing) {
  if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr) GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
  EXPECT_EQ(print(0.5), "0.5");
  EXPECT_EQ(print(0.5, 2), "0.50");
  std::setlocale(LC_NUMERIC, "C");
}

TEST(PrintTest, WhatIsNoNumberHasNoSign) {
  const double negative = std::copysign(std::numeric_limits<double>::quiet_NaN(), -1.0);
  EXPECT_EQ(print(negative), "nan");
  EXPECT_EQ(printExactly(negative), "nan");
  EXPECT_EQ(print(negative, 3), "nan");
}

}  // namespace
}  // namespace demo_logger
