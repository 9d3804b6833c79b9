#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace demo_logger {

/// The parts between the commas, without blanks around them; one empty part for an empty line.
std::vector<std::string_view> splitCells(std::string_view line);

enum class CellKind { number, infinity, beyond_range, text };

/// What a cell without blanks holds: a number, or NaN for an empty cell, nan or na in any case.
CellKind parseCell(std::string_view cell, double& value);

}  // namespace demo_logger
