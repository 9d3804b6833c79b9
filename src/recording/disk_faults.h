#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/trajectory/metadata.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// What the disk refused, each kind once with its count, and whether it still does. For several threads.
class DiskFaults {
 public:
  /// `kind` tells faults apart whose sentences differ in numbers alone, such as the bytes left. `lasting`: until
  /// over() is called.
  void report(const std::string& kind, Nanoseconds stamp, const std::string& what, bool lasting);
  void over(const std::string& kind);

  std::optional<std::string> present() const;
  std::vector<Fault> all() const;

 private:
  struct Entry {
    std::string kind;
    Fault fault;
    bool present = false;
    std::string latest;
  };

  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace demo_logger
