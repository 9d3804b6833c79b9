#include "demo_logger/formats/csv_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "csv_cells.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "demo_logger/trajectory/quotation.h"
#include "line_reader.h"

namespace demo_logger {
namespace {

std::string megabytes(std::size_t bytes) { return std::to_string(bytes >> 20U) + " MB"; }

// The first few names, for a message.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 6;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    list += (i == 0 ? "" : ", ") + names[i];
  }
  return names.size() > kShown ? list + ", … (" + std::to_string(names.size()) + " columns)" : list;
}

}  // namespace

class CsvReader::Implementation {
 public:
  Implementation(const std::filesystem::path& file, CsvExpectation expectation)
      : file_(file.string()), lines_(file), expectation_(std::move(expectation)) {
    readHeader();
  }

  bool next(std::vector<double>& row) {
    std::string_view text;
    if (!nextLine(text)) {
      if (!any_row_) {
        fail(
            "the file has a header and no rows; expected at least one row of numbers. Was the recording stopped at "
            "once?");
      }
      return false;
    }
    row.resize(names_.size());
    for (auto& [column, word] : words_) word.clear();
    if (!parseQuickly(text, row)) {
      parseWithCare(text, row);
    }
    checkTime(row);
    if (!lines_.endedWithLineFeed()) {
      notes_.push_back(file_ + ":" + std::to_string(line_) +
                       ": ends without a line feed; if the file was cut, the last number of its last row is wrong.");
    }
    any_row_ = true;
    return true;
  }

  std::optional<std::size_t> find(std::string_view name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
      return std::nullopt;
    }
    return static_cast<std::size_t>(found - names_.begin());
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& notes() const { return notes_; }
  std::size_t line() const { return line_; }

  const std::string& word(std::size_t column) const {
    static const std::string none;
    const auto found = words_.find(column);
    return found == words_.end() ? none : found->second;
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const {
    throw FileError(file_ + ":" + std::to_string(std::max<std::size_t>(line_, 1)) + ": " + sentence);
  }

  void readHeader() {
    std::string_view text;
    switch (lines_.next(kLongestHeader, text)) {
      case LineReader::Outcome::end:
        throw FileError(file_ + ": is empty, expected a header line of column names and rows of numbers.");
      case LineReader::Outcome::too_long:
        fail("the first line is longer than " + megabytes(kLongestHeader) +
             ", expected a header line of column names. Is this a CSV file?");
      case LineReader::Outcome::line:
        break;
    }
    line_ = 1;
    if (text.substr(0, 3) == "\xef\xbb\xbf") {
      text.remove_prefix(3);
    }
    checkHeaderText(text);
    for (std::string_view cell : splitCells(text)) {
      if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
        cell = cell.substr(1, cell.size() - 2);
      }
      names_.emplace_back(cell);
    }
    checkNames();
    checkExpectation();
  }

  void checkHeaderText(std::string_view text) const {
    if (text.find('\0') != std::string_view::npos) {
      fail("the header holds a NUL byte, expected column names as UTF-8 text. Is it UTF-16, or not a CSV file?");
    }
    if (text.substr(0, text.find_last_not_of('\r') + 1).find('\r') != std::string_view::npos) {
      fail("lines end in CR alone, expected LF or CR LF. Save the file with line ends of Unix or Windows.");
    }
    if (text.find(',') == std::string_view::npos && text.find_first_of(";\t") != std::string_view::npos) {
      fail("the header has semicolons or tabs and no commas, expected a comma between cells and a point in numbers.");
    }
    if (!text.empty() && (text.front() == '#' || text.front() == '%')) {
      fail("the file starts with a comment, expected a header line of column names. Remove the comment lines.");
    }
  }

  void checkNames() const {
    std::set<std::string_view> seen;
    bool all_numbers = true;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      const std::string& name = names_[i];
      if (name.empty()) {
        fail("column " + std::to_string(i + 1) + " has no name" +
             (i + 1 == names_.size() && i > 0 ? "; does the header end with a comma?" : "; every column needs one."));
      }
      if (!seen.insert(name).second) {
        fail("two columns are named " + inQuotes(name) + "; names must be unique. Rename one of them.");
      }
      double number = 0.0;
      all_numbers = all_numbers && parseCell(name, number) == CellKind::number;
    }
    if (all_numbers) {
      fail("the first line holds numbers, expected a header line of column names.");
    }
  }

  void checkExpectation() {
    time_ = find("time");
    for (const std::string& name : expectation_.words) {
      if (const auto column = find(name)) words_[*column];
    }
    if (!time_ && expectation_.time) {
      fail("there is no column `time`, expected the seconds since the first row; found " + listed(names_) + ".");
    }
    for (const std::string& name : expectation_.columns) {
      if (!find(name)) {
        fail("there is no column `" + name + "`; found " + listed(names_) + ".");
      }
    }
  }

  // The next line that is not blank; blank ones are fine at the end of the file only.
  bool nextLine(std::string_view& text) {
    std::size_t blank = 0;
    while (true) {
      const LineReader::Outcome outcome = lines_.next(kLongestRow, text);
      if (outcome == LineReader::Outcome::end) {
        return false;
      }
      ++line_;
      if (outcome == LineReader::Outcome::too_long) {
        fail("the line is longer than " + megabytes(kLongestRow) + ", expected a row of " +
             std::to_string(names_.size()) + " numbers. Is the file damaged?");
      }
      if (!text.empty() && text.back() == '\r') {
        text.remove_suffix(1);
      }
      if (!text.empty()) {
        break;
      }
      blank = blank == 0 ? line_ : blank;
    }
    if (blank != 0) {
      line_ = blank;
      fail("the line is empty, expected a row of " + std::to_string(names_.size()) + " numbers. Remove the line.");
    }
    return true;
  }

  // The usual row: numbers and commas, nothing else. False for anything to be looked at more closely.
  static bool parseQuickly(std::string_view text, std::vector<double>& row) {
    const char* position = text.data();
    const char* const end = position + text.size();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto [next, error] = std::from_chars(position, end, row[i]);
      const bool last = i + 1 == row.size();
      if (error != std::errc() || !std::isfinite(row[i])) {
        if (end - position < 3 || std::string_view(position, 3) != "NaN" || next != position + 3) {
          return false;
        }
        row[i] = std::numeric_limits<double>::quiet_NaN();
      }
      if (last ? next != end : next == end || *next != ',') {
        return false;
      }
      position = next + 1;
    }
    return true;
  }

  void parseWithCare(std::string_view text, std::vector<double>& row) {
    const std::vector<std::string_view> cells = splitCells(text);
    const std::size_t whole = cells.size() - (cells.back().empty() ? 1 : 0);
    if (!lines_.endedWithLineFeed() && whole < names_.size()) {
      fail("the row ends after " + std::to_string(whole) + " of " + std::to_string(names_.size()) +
           " cells and without a line feed; the file was cut here. Remove this last line to use the rows before it.");
    }
    for (std::size_t i = 0; i < std::min(cells.size(), names_.size()); ++i) {
      parseInto(row[i], cells[i], i);
    }
    if (cells.size() != names_.size()) {
      fail("the row has " + std::to_string(cells.size()) + (cells.size() == 1 ? " cell" : " cells") + ", expected " +
           std::to_string(names_.size()) + " as in the header." +
           (cells.size() < names_.size() ? " Was the line cut?"
            : cells.back().empty()       ? " Does it end with a comma?"
                                         : " Is a comma used as decimal mark?"));
    }
  }

  void parseInto(double& value, std::string_view cell, std::size_t index) {
    const std::string column = "column " + std::to_string(index + 1) + " (" + names_[index] + ")";
    if (cell.find('\0') != std::string_view::npos) {
      fail(column + " holds a NUL byte, expected a number. Was the power lost while the file was written?");
    }
    switch (parseCell(cell, value)) {
      case CellKind::number:
        return;
      case CellKind::infinity:
        fail(column + " is " + inQuotes(cell) + ", expected a finite number, or NaN where the value is missing.");
      case CellKind::beyond_range:
        fail(column + " is " + inQuotes(cell) +
             ", expected a number within the range of a double (5e-324 to 1.8e308).");
      case CellKind::text:
        if (const auto allowed = words_.find(index); allowed != words_.end()) {
          allowed->second = cell;
          value = std::numeric_limits<double>::quiet_NaN();
          return;
        }
        fail(column + " is " + inQuotes(cell) + ", expected a number, or NaN where the value is missing." +
             hintFor(cell));
    }
  }

  std::string hintFor(std::string_view cell) const {
    if (!lines_.endedWithLineFeed()) {
      return " The file ends here without a line feed; was it cut?";
    }
    if (cell.front() == '#' || cell.front() == '%') {
      return " Remove the comment lines.";
    }
    if (cell.front() == '"') {
      return " Write numbers without quotes.";
    }
    if (line_ == 2) {
      return " Remove a second line of units or names.";
    }
    return "";
  }

  void checkTime(const std::vector<double>& row) {
    if (!time_ || !expectation_.time) {
      return;
    }
    const double time = row[*time_];
    if (std::isnan(time)) {
      fail("column " + std::to_string(*time_ + 1) + " (time) is missing, expected the seconds since the first row.");
    }
    if (any_row_ && time <= last_time_) {
      fail("time " + printExactly(time) + " s " +
           (time == last_time_ ? "is that of the row before; times must strictly increase. Was a row written twice?"
                               : "does not follow " + printExactly(last_time_) +
                                     " s; times must strictly increase. Were two recordings joined?"));
    }
    last_time_ = time;
  }

  std::string file_;
  LineReader lines_;
  CsvExpectation expectation_;
  std::vector<std::string> names_;
  std::vector<std::string> notes_;
  std::map<std::size_t, std::string> words_;  // of the columns that may have some, in the row last read
  std::optional<std::size_t> time_;
  std::size_t line_ = 0;
  double last_time_ = 0.0;
  bool any_row_ = false;
};

CsvReader::CsvReader(const std::filesystem::path& file, CsvExpectation expectation)
    : implementation_(std::make_unique<Implementation>(file, std::move(expectation))) {}
CsvReader::~CsvReader() = default;
CsvReader::CsvReader(CsvReader&&) noexcept = default;
CsvReader& CsvReader::operator=(CsvReader&&) noexcept = default;

const std::vector<std::string>& CsvReader::names() const { return implementation_->names(); }
std::optional<std::size_t> CsvReader::find(std::string_view name) const { return implementation_->find(name); }
bool CsvReader::next(std::vector<double>& row) { return implementation_->next(row); }
std::size_t CsvReader::line() const { return implementation_->line(); }
const std::string& CsvReader::word(std::size_t column) const { return implementation_->word(column); }
const std::vector<std::string>& CsvReader::notes() const { return implementation_->notes(); }

}  // namespace demo_logger
