#include "disk_faults.h"

#include <algorithm>

namespace demo_logger {

void DiskFaults::report(DiskFaultKind kind, Nanoseconds stamp, const std::string& what, bool lasting) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Entry& entry = entries_.try_emplace(kind, Entry{Fault{stamp, what, 0, Severity::error}, lasting, what}).first->second;
  ++entry.fault.count;
  entry.present = lasting;
  entry.latest = what;
}

void DiskFaults::over(DiskFaultKind kind) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (const auto entry = entries_.find(kind); entry != entries_.end()) {
    entry->second.present = false;
  }
}

std::optional<std::string> DiskFaults::present() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto entry =
      std::find_if(entries_.begin(), entries_.end(), [](const auto& known) { return known.second.present; });
  return entry == entries_.end() ? std::nullopt : std::optional<std::string>(entry->second.latest);
}

std::vector<Fault> DiskFaults::all() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Fault> faults;
  faults.reserve(entries_.size());
  for (const auto& [kind, entry] : entries_) {
    faults.push_back(entry.fault);
  }
  return faults;
}

}  // namespace demo_logger
