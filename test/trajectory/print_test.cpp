#include <gtest/gtest.h>

#include <clocale>
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

}  // namespace
}  // namespace demo_logger
