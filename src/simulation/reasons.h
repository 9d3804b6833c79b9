#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace demo_logger {

/// Why the arm does not do what it was told, collected during one tick. Said once each; the first few only, so that a
/// hostile publisher cannot make them long.
class Reasons {
 public:
  void add(const std::string& reason) {
    if (std::find(reasons_.begin(), reasons_.end(), reason) != reasons_.end()) return;
    if (reasons_.size() < kMost) {
      reasons_.push_back(reason);
    } else {
      more_ = true;
    }
  }

  void addAll(const Reasons& others) {
    for (const std::string& reason : others.reasons_) add(reason);
  }

  bool empty() const { return reasons_.empty(); }

  std::string text() const {
    std::string text;
    for (const std::string& reason : reasons_) text += (text.empty() ? "" : "; ") + reason;
    return more_ ? text + "; and more" : text;
  }

 private:
  static constexpr std::size_t kMost = 8;
  std::vector<std::string> reasons_;
  bool more_ = false;
};

}  // namespace demo_logger
