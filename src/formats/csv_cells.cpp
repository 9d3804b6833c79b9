#include "csv_cells.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace demo_logger {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && isBlank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

std::string lowerCase(std::string_view text) {
  std::string lower;
  for (const char c : text) {
    lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return lower;
}

}  // namespace

std::vector<std::string_view> splitCells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) {
      return cells;
    }
    line.remove_prefix(comma + 1);
  }
}

CellKind parseCell(std::string_view cell, double& value) {
  if (cell.size() <= 4) {
    const std::string word = lowerCase(cell);
    if (word.empty() || word == "nan" || word == "-nan" || word == "+nan" || word == "na") {
      value = std::numeric_limits<double>::quiet_NaN();
      return CellKind::number;
    }
  }
  if (cell.size() > 1 && cell.front() == '+' && cell[1] != '-') {
    cell.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (end != cell.data() + cell.size() || error == std::errc::invalid_argument) {
    return CellKind::text;
  }
  if (error == std::errc::result_out_of_range) {
    return CellKind::beyond_range;
  }
  if (std::isinf(value)) {
    return CellKind::infinity;
  }
  return std::isnan(value) ? CellKind::text : CellKind::number;  // nan(…) carries a payload that would be lost
}

}  // namespace demo_logger
