#include "disk_faults.h"

#include <algorithm>

namespace demo_logger {

void DiskFaults::report(const std::string& kind, Nanoseconds stamp, const std::string& what, bool lasting) {
  const std::lock_guard<std::mutex> lock(mutex_);
  auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.kind == kind; });
  if (entry == entries_.end()) {
    entry = entries_.insert(entry, Entry{kind, Fault{stamp, what, 0, Severity::error}, lasting, what});
  }
  ++entry->fault.count;
  entry->present = lasting;
  entry->latest = what;
}

void DiskFaults::over(const std::string& kind) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Entry& entry : entries_) {
    entry.present = entry.present && entry.kind != kind;
  }
}

std::optional<std::string> DiskFaults::present() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [](const Entry& e) { return e.present; });
  return entry == entries_.end() ? std::nullopt : std::optional<std::string>(entry->latest);
}

std::vector<Fault> DiskFaults::all() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Fault> faults;
  for (const Entry& entry : entries_) {
    faults.push_back(entry.fault);
  }
  return faults;
}

}  // namespace demo_logger
