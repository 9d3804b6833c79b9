#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demo_logger/formats/demonstration_file.h"

namespace demo_logger {

/// A table of joint positions that is no demonstration, as `ik` writes them: without `time`, or with words in its
/// column `status`. It has no sidecar.
struct PlainTable {
  LoadedDemonstration numbers;      // without times: a column `time` is one like any other; NaN for a word
  std::vector<std::string> status;  // the word of each row; empty for a number, and without that column
};

/// Whether `file` is one, by its header and its first row.
bool isPlainTable(const std::filesystem::path& file);

/// Throws FileError for what CsvReader refuses.
PlainTable readPlainTable(const std::filesystem::path& file);

/// As it stands in a file.
std::string textOf(const Demonstration& numbers, const std::vector<std::string>& status);

}  // namespace demo_logger
