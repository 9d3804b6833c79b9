#pragma once

#include <string>

namespace demo_logger {

// Numbers in sentences for people, with `.` whatever the locale.

/// Six significant digits at most: 0.5, 1e-05, 1234.5.
std::string print(double number);
/// Always so many decimals: 0.500.
std::string print(double number, int decimals);

}  // namespace demo_logger
