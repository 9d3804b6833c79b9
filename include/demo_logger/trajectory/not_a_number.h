#pragma once

#include <limits>

namespace demo_logger {

/// What stands for a value that is missing; never zero.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace demo_logger
