#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/column.h"

namespace demo_logger {

/// A directory of the test's own, removed at its end.
class RecordingDirectory {
 public:
  RecordingDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "recording_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~RecordingDirectory() { std::filesystem::remove_all(path_); }
  RecordingDirectory(const RecordingDirectory&) = delete;
  RecordingDirectory& operator=(const RecordingDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Names of the files in it, in order, separated by a space.
  std::string listing(const std::string& below = "") const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_ / below)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    std::string list;
    for (const std::string& name : names) {
      list += (list.empty() ? "" : " ") + name;
    }
    return list;
  }

 private:
  std::filesystem::path path_;
};

inline std::string readFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void writeFile(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// A CSV read as simply as can be, independently of the code under test: the header, then numbers.
struct Table {
  std::string header;
  std::vector<std::vector<double>> rows;
};

inline Table readTable(const std::filesystem::path& file) {
  Table table;
  std::istringstream text(readFile(file));
  std::getline(text, table.header);
  for (std::string line; std::getline(text, line);) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      row.push_back(cell == "NaN" ? std::nan("") : std::stod(cell));
    }
    table.rows.push_back(row);
  }
  return table;
}

constexpr Nanoseconds kStart = 1'600'000'000'000'000'000;
constexpr Nanoseconds kMillisecond = 1'000'000;

inline std::vector<Column> jointColumns(std::size_t count = 2) {
  std::vector<Column> columns;
  for (std::size_t i = 0; i < count; ++i) {
    columns.push_back(Column{"q_joint" + std::to_string(i), "rad", Role::state, Interpolation::linear, ""});
  }
  return columns;
}

/// Row `k` of a 1 kHz recording, whose every value can be told from its place: k + 0.001 times the column.
inline Row knownRow(std::uint64_t k, std::size_t columns = 2) {
  Row row;
  row.stamp = row.receipt = kStart + static_cast<Nanoseconds>(k) * kMillisecond;
  for (std::size_t i = 0; i < columns; ++i) {
    row.values.push_back(static_cast<double>(k) + 0.001 * static_cast<double>(i));
  }
  return row;
}

/// That `table` holds exactly the known rows first … first + count − 1.
inline void expectKnownRows(const Table& table, std::uint64_t first, std::uint64_t count) {
  ASSERT_EQ(table.rows.size(), count);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Row expected = knownRow(first + i, table.rows[i].size() - 1);
    ASSERT_EQ(table.rows[i][0], static_cast<double>(i) / 1000.0) << "in row " << i;
    for (std::size_t column = 0; column < expected.values.size(); ++column) {
      ASSERT_EQ(table.rows[i][column + 1], expected.values[column]) << "in row " << i;
    }
  }
}

}  // namespace demo_logger
