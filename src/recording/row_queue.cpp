#include "row_queue.h"

#include <algorithm>
#include <utility>

namespace demo_logger {

void DecidedRows::add(Nanoseconds stamp) {
  stamps_.insert(std::upper_bound(stamps_.begin(), stamps_.end(), stamp), stamp);
  if (stamps_.size() > kCapacity) stamps_.pop_front();
}

bool DecidedRows::contains(Nanoseconds stamp) const {
  return std::binary_search(stamps_.begin(), stamps_.end(), stamp);
}

bool DecidedRows::anyWithin(Nanoseconds begin, Nanoseconds end) const {
  const auto first = std::lower_bound(stamps_.begin(), stamps_.end(), begin);
  return first != stamps_.end() && *first < end;
}

void DecidedRows::prune(Nanoseconds horizon) {
  while (!stamps_.empty() && stamps_.front() < horizon) stamps_.pop_front();
}

RowQueue::Admission RowQueue::admit(PendingRow row) {
  const Nanoseconds stamp = row.row.stamp;
  if (rows_.count(stamp) != 0 || decided_.contains(stamp)) return Admission::duplicate;
  if (any_released_ && stamp <= last_released_) return Admission::late;
  rows_.emplace_hint(rows_.end(), stamp, std::move(row));
  by_receipt_.push_back(stamp);
  return Admission::admitted;
}

PendingRow* RowQueue::nextToDecide() {
  while (!by_receipt_.empty()) {
    const auto row = rows_.find(by_receipt_.front());
    if (row != rows_.end() && !row->second.decided) return &row->second;
    by_receipt_.pop_front();
  }
  return nullptr;
}

PendingRow* RowQueue::first() { return rows_.empty() ? nullptr : &rows_.begin()->second; }

void RowQueue::decided(PendingRow& row) {
  row.decided = true;
  decided_.add(row.row.stamp);
}

PendingRow RowQueue::release() {
  PendingRow row = std::move(rows_.begin()->second);
  rows_.erase(rows_.begin());
  any_released_ = true;
  last_released_ = row.row.stamp;
  return row;
}

void RowQueue::clear() { *this = RowQueue(); }

}  // namespace demo_logger
