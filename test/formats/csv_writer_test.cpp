#include "demo_logger/formats/csv_writer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace demo_logger {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string rowOf(double time, const std::vector<double>& values) {
  std::string text;
  appendRow(text, time, values.data(), values.size());
  return text;
}

TEST(CsvWriterTest, WritesHeaderAndRowsWithCommasAndLineFeeds) {
  EXPECT_EQ(csvHeader({{"q_elbow", "rad", {}, {}, ""}, {"u_vx", "m/s", {}, {}, ""}}), "time,q_elbow,u_vx\n");
  EXPECT_EQ(csvHeader({}), "time\n");
  EXPECT_EQ(rowOf(0.125, {1.0, -0.1, 1e-9}), "0.125,1,-0.1,1e-09\n");
  EXPECT_EQ(rowOf(0.0, {}), "0\n");
}

TEST(CsvWriterTest, EveryNaNIsTheSameWord) {
  EXPECT_EQ(rowOf(0.0, {kNaN, -kNaN, std::copysign(kNaN, -1.0), std::nan("17"), std::sqrt(-1.0)}),
            "0,NaN,NaN,NaN,NaN,NaN\n");
}

TEST(CsvWriterTest, InfinitiesBecomeNaNAndAreCounted) {
  std::string text;
  const double values[] = {kInfinity, 2.0, -kInfinity, kNaN};
  EXPECT_EQ(appendRow(text, 1.0, values, 4), 2U);
  EXPECT_EQ(text, "1,NaN,2,NaN,NaN\n");
  EXPECT_FALSE(appendNumber(text, kInfinity));
  EXPECT_TRUE(appendNumber(text, kNaN)) << "a missing value is no loss";
}

TEST(CsvWriterTest, AppendsToWhatIsThere) {
  std::string text = "time,q\n";
  const double value = 0.5;
  appendRow(text, Nanoseconds{0}, &value, 1);
  appendRow(text, Nanoseconds{1'000'000}, &value, 1);
  EXPECT_EQ(text, "time,q\n0,0.5\n0.001,0.5\n");
}

TEST(CsvWriterTest, TheWidestNumbersFitTheirCell) {
  const double widest = -std::numeric_limits<double>::min();
  EXPECT_EQ(rowOf(widest, {widest, std::numeric_limits<double>::lowest(), -5e-324}),
            "-2.2250738585072014e-308,-2.2250738585072014e-308,-1.7976931348623157e+308,-5e-324\n");
}

RC_GTEST_PROP(CsvWriterTest, EveryBitPatternReadsBackBitEqual, ()) {
  const auto bits = *rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>());
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof(value));
  RC_PRE(std::isfinite(value));
  std::string text;
  appendNumber(text, value);
  const double back = std::strtod(text.c_str(), nullptr);  // the C library's, an independent reader
  RC_ASSERT(std::memcmp(&back, &value, sizeof(value)) == 0);
}

RC_GTEST_PROP(CsvWriterTest, TimeIsExactToTheNanosecond, ()) {
  constexpr Nanoseconds kLongest = (Nanoseconds{1} << 22U) * kNanosecondsPerSecond;
  const Nanoseconds since_first = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<Nanoseconds>(0, kLongest));
  std::string text;
  appendTime(text, since_first);
  RC_ASSERT(std::llround(std::strtold(text.c_str(), nullptr) * 1e9L) == since_first);
}

}  // namespace
}  // namespace demo_logger
