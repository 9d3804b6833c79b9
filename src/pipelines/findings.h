#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "demo_logger/pipelines/check.h"

namespace demo_logger {

/// Collects findings and keeps only the first few of each kind; the rest are counted and told in one sentence.
class Findings {
 public:
  explicit Findings(std::size_t shown) : shown_(shown) {}

  void add(const std::string& kind, Severity severity, const std::string& sentence);
  /// All of them; for each kind that had more, one more that says how many.
  std::vector<Finding> take();

 private:
  struct Rest {
    std::size_t count = 0;
    Severity severity = Severity::warning;
  };

  std::size_t shown_;
  std::vector<Finding> findings_;
  std::map<std::string, std::size_t> count_;
  std::map<std::string, Rest> rest_;
};

/// Four significant digits, whatever the locale.
std::string formatNumber(double value);
/// "12.34 s", "4.5 ms"
std::string formatDuration(double seconds);
/// "at 12.34 s": an instant of the recording, to the millisecond.
std::string formatInstant(double seconds);
/// "3.2 %"
std::string formatShare(double share);
/// "1 row", "7 rows"
std::string formatCount(std::size_t count, const std::string& thing);
/// "q_elbow", "q_elbow and q_wrist", "q_elbow and 6 more"
std::string formatNames(const std::vector<std::string>& names);

}  // namespace demo_logger
