#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace demo_logger {

/// What is remarkable about rows of a table: of each kind the first row's sentence, and how many there are.
class RowNotes {
 public:
  explicit RowNotes(std::string file) : file_(std::move(file)) {}

  /// `line` as an editor counts, the header being 1.
  void add(const std::string& kind, std::size_t line, const std::string& sentence);
  bool empty() const { return notes_.empty(); }

  /// "poses.csv:18: the quaternion is zero (and 3 rows more)"
  std::vector<std::string> sentences() const;

 private:
  struct Note {
    std::size_t line;
    std::string sentence;
    std::size_t count;
  };
  std::string file_;
  std::map<std::string, Note> notes_;
};

}  // namespace demo_logger
