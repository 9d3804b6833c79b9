#include "demo_logger/trajectory/print.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

constexpr int kSignificantDigits = 6;
constexpr int kMostDecimals = 20;
// The largest double has 309 digits before its point.
constexpr std::size_t kLongest = std::numeric_limits<double>::max_exponent10 + kMostDecimals + 4;

constexpr const char* kNotANumber = "nan";  // whatever its sign, which to_chars would print

std::string text(double number, std::chars_format format, int precision) {
  if (std::isnan(number)) return kNotANumber;
  std::array<char, kLongest> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, format, precision).ptr;
  return {digits.data(), end};
}

}  // namespace

std::string print(double number) { return text(number, std::chars_format::general, kSignificantDigits); }

std::string printExactly(double number) {
  if (std::isnan(number)) return kNotANumber;
  std::array<char, kLongest> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

std::string print(double number, int decimals) {
  return text(number, std::chars_format::fixed, std::min(decimals, kMostDecimals));
}

}  // namespace demo_logger
