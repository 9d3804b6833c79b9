#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace demo_logger {

/// What a CSV must hold to be of use.
struct CsvExpectation {
  std::vector<std::string> columns;     // beside `time`
  bool time = true;                     // a column `time` [s], finite and strictly increasing
  std::vector<std::string> words = {};  // columns in which a cell may be a word instead of a number
};

/// Reads a CSV of numbers row by row, in memory for one row: those this project writes, and those of others as far as
/// they leave no doubt. CR LF, a byte-order mark, blanks around cells, names in quotes, a leading +, blank lines at the
/// end, and a missing value as NaN or NA in any case or an empty cell are accepted. Anything else throws FileError,
/// which names file, line, column, what was found and what was expected; nothing is skipped or guessed.
class CsvReader {
 public:
  /// A longer header or row is refused before it fills the memory [bytes].
  static constexpr std::size_t kLongestHeader = 1U << 20U;
  static constexpr std::size_t kLongestRow = 16U << 20U;

  /// Reads the header. Throws also for a missing column, two of one name, a column without a name.
  explicit CsvReader(const std::filesystem::path& file, CsvExpectation expectation = {});
  ~CsvReader();
  CsvReader(CsvReader&&) noexcept;
  CsvReader& operator=(CsvReader&&) noexcept;

  const std::vector<std::string>& names() const;  // in the order of the file, `time` included
  std::optional<std::size_t> find(std::string_view name) const;

  /// One row, a cell per name; NaN where missing. False behind the last; a file without any row throws.
  bool next(std::vector<double>& row);
  /// Of the row last read; the header is line 1.
  std::size_t line() const;
  /// Of the row last read, where the expectation allows it and its number is NaN; empty if the cell is a number.
  const std::string& word(std::size_t column) const;

  /// After the last row: a sentence if the file ends without a line feed, so that its last number may have been cut.
  const std::vector<std::string>& notes() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
