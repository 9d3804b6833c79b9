#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>
#include <vector>

namespace demo_logger {

/// The lines of a file, one at a time, in memory for one line however long the file.
class LineReader {
 public:
  /// Throws FileError naming what is wrong: no such file, a directory, no right to read.
  explicit LineReader(const std::filesystem::path& file);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  enum class Outcome { line, end, too_long };

  /// The next line, without its line feed, valid until the next call. Stops at `limit` bytes without reading on.
  Outcome next(std::size_t limit, std::string_view& line);
  /// Whether the last line given was followed by a line feed; the last of a file may not be.
  bool endedWithLineFeed() const { return ended_with_line_feed_; }

 private:
  bool fill();

  std::filesystem::path file_;
  int descriptor_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // of what has not been given yet
  std::size_t end_ = 0;
  bool at_end_of_file_ = false;
  bool ended_with_line_feed_ = true;
};

}  // namespace demo_logger
