#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>

namespace demo_logger {

/// A bar on stderr for work over a second, if a person watches.
class Progress {
 public:
  explicit Progress(std::string what)
      : what_(std::move(what)), begin_(Clock::now()), watched_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) {
      std::fprintf(stderr, "\r%*s\r", kWidth + 12 + static_cast<int>(what_.size()), "");
    }
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(std::uint64_t done, std::uint64_t all) {
    if (!watched_ || all == 0 || Clock::now() - begin_ < std::chrono::seconds(1)) {
      return;
    }
    const std::string filled(kWidth * done / all, '#');
    std::fprintf(stderr, "\r%s [%-*s] %3d %%", what_.c_str(), kWidth, filled.c_str(),
                 static_cast<int>(100 * done / all));
    shown_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kWidth = 40;

  std::string what_;
  Clock::time_point begin_;
  bool watched_;
  bool shown_ = false;
};

}  // namespace demo_logger
