#pragma once

#include <string>

namespace demo_logger {

// Numbers in sentences for people, with `.` whatever the locale. What is no number is nan, without a sign.

/// Six significant digits at most: 0.5, 1e-05, 1234.5.
std::string print(double number);
/// As many digits as tell it from every other number: 0.1, 1234.567891.
std::string printExactly(double number);
/// Always so many decimals: 0.500.
std::string print(double number, int decimals);

}  // namespace demo_logger
