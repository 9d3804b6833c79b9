#include "demo_logger/formats/csv_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace demo_logger {
namespace {

// The longest shortest double is -2.2250738585072014e-308: 24 characters; one more for the comma or line feed.
constexpr std::size_t kLongestCell = 25;

char* writeNumber(char* position, double value) {
  if (!std::isfinite(value)) {
    return std::copy_n("NaN", 3, position);  // to_chars would print -nan for sqrt(-1)
  }
  return std::to_chars(position, position + kLongestCell, value).ptr;
}

}  // namespace

std::string csvHeader(const std::vector<Column>& columns) {
  std::string header = "time";
  for (const Column& column : columns) {
    header += ',';
    header += column.name;
  }
  header += '\n';
  return header;
}

bool appendNumber(std::string& buffer, double value) {
  char text[kLongestCell];
  buffer.append(text, static_cast<std::size_t>(writeNumber(text, value) - text));
  return !std::isinf(value);
}

void appendTime(std::string& buffer, Nanoseconds since_first) { appendNumber(buffer, toSeconds(since_first)); }

std::size_t appendRow(std::string& buffer, double time, const double* values, std::size_t count) {
  const std::size_t start = buffer.size();
  buffer.resize(start + (count + 1) * kLongestCell);
  char* position = writeNumber(buffer.data() + start, time);
  std::size_t infinities = 0;
  for (std::size_t i = 0; i < count; ++i) {
    *position++ = ',';
    position = writeNumber(position, values[i]);
    infinities += std::isinf(values[i]) ? 1 : 0;
  }
  *position++ = '\n';
  buffer.resize(static_cast<std::size_t>(position - buffer.data()));
  return infinities;
}

std::size_t appendRow(std::string& buffer, Nanoseconds since_first, const double* values, std::size_t count) {
  return appendRow(buffer, toSeconds(since_first), values, count);
}

}  // namespace demo_logger
