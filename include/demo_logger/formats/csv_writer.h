#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// The text of a demonstration's CSV (doc/file_format.md), appended to a buffer that the caller writes out:
/// shortest digits that read back bit-equal, `.` whatever the locale, exactly `NaN` where a value is missing, a comma
/// between cells and a line feed behind each row.

/// The first line: `time` and the names of `columns`, which must be portable (column_names.h).
std::string csvHeader(const std::vector<Column>& columns);

/// One cell. An infinity becomes NaN, since most readers of CSV stumble over it; returns false then.
bool appendNumber(std::string& buffer, double value);

/// The cell of `time`, from integer nanoseconds since the first row. Reading it back and rounding to nanoseconds gives
/// the same integer for 48 days (2²² s, whose double neighbours are half a nanosecond apart).
void appendTime(std::string& buffer, Nanoseconds since_first);

/// One row: the time and `count` values. Returns how many of the values were infinite and became NaN.
std::size_t appendRow(std::string& buffer, double time, const double* values, std::size_t count);
std::size_t appendRow(std::string& buffer, Nanoseconds since_first, const double* values, std::size_t count);

}  // namespace demo_logger
