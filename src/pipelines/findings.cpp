#include "findings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/print.h"

namespace demo_logger {

void Findings::add(const std::string& kind, Severity severity, const std::string& sentence) {
  if (++count_[kind] <= shown_) {
    findings_.push_back({kind, severity, sentence});
    return;
  }
  Rest& rest = rest_[kind];
  ++rest.count;
  rest.severity = std::max(rest.severity, severity);
}

std::vector<Finding> Findings::take() {
  for (const auto& [kind, rest] : rest_) {
    const auto last = std::find_if(findings_.rbegin(), findings_.rend(),
                                   [&kind = kind](const Finding& finding) { return finding.kind == kind; });
    findings_.insert(last.base(), {kind, rest.severity, "and " + std::to_string(rest.count) + " more of this kind."});
  }
  rest_.clear();
  count_.clear();
  return std::exchange(findings_, {});
}

std::string formatNumber(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 4);
  (void)error;  // 32 characters hold any double at four digits
  return {text, end};
}

std::string formatDuration(double seconds) {
  const bool small = std::abs(seconds) < 1.0;
  return small ? formatNumber(1e3 * seconds) + " ms" : formatNumber(seconds) + " s";
}

std::string formatInstant(double seconds) { return "at " + print(seconds, 3) + " s"; }

std::string formatShare(double share) { return formatNumber(100.0 * share) + " %"; }

std::string formatCount(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string formatNames(const std::vector<std::string>& names) {
  if (names.size() == 1) {
    return names[0];
  }
  return names[0] + " and " + (names.size() == 2 ? names[1] : std::to_string(names.size() - 1) + " more");
}

}  // namespace demo_logger
