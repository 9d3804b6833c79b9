#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/trajectory/metadata.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// The most important first.
enum class DiskFaultKind { removed, rows, sidecar, sync, begin, recovery };

/// What the disk refused, each kind once with its count, and whether it still does. For several threads.
class DiskFaults {
 public:
  /// `what` of the first time is kept as the fault, that of the last time tells the present state. `lasting`: until
  /// over() is called.
  void report(DiskFaultKind kind, Nanoseconds stamp, const std::string& what, bool lasting);
  void over(DiskFaultKind kind);

  std::optional<std::string> present() const;
  std::vector<Fault> all() const;

 private:
  struct Entry {
    Fault fault;
    bool present = false;
    std::string latest;
  };

  mutable std::mutex mutex_;
  std::map<DiskFaultKind, Entry> entries_;
};

}  // namespace demo_logger
