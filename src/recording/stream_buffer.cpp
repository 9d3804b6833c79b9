#include "stream_buffer.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace demo_logger {
namespace {

Nanoseconds gapBetween(const StreamBuffer::Messages::value_type& earlier,
                       const StreamBuffer::Messages::value_type& later, std::uint64_t episode) {
  const bool both = earlier.second.received_in == episode && later.second.received_in == episode;
  return both ? later.first - earlier.first : 0;
}

}  // namespace

bool StreamBuffer::insert(Nanoseconds effective, StreamMessage message) {
  if (messages_.size() == kCapacity && messages_.count(effective) == 0) {
    if (effective < messages_.begin()->first) return false;
    forgetFirst();
    messages_.insert_or_assign(messages_.end(), effective, std::move(message));
    return false;
  }
  messages_.insert_or_assign(messages_.end(), effective, std::move(message));
  return true;
}

StreamBuffer::Neighbours StreamBuffer::around(Nanoseconds instant) {
  Neighbours neighbours;
  const auto after = messages_.upper_bound(instant);
  if (after != messages_.end()) neighbours.after = &*after;
  if (after != messages_.begin()) neighbours.at_or_before = &*std::prev(after);
  return neighbours;
}

void StreamBuffer::prune(Nanoseconds horizon) {
  // A row at the horizon may need the last message at or before it.
  while (messages_.size() > 1 && std::next(messages_.begin())->first <= horizon) forgetFirst();
}

void StreamBuffer::forgetFirst() {
  const auto first = messages_.begin();
  const auto second = std::next(first);
  if (second != messages_.end()) {
    const std::uint64_t episode = second->second.received_in;
    if (episode != gap_episode_) {
      gap_episode_ = episode;
      largest_forgotten_gap_ = 0;
    }
    largest_forgotten_gap_ = std::max(largest_forgotten_gap_, gapBetween(*first, *second, episode));
  }
  messages_.erase(first);
}

void StreamBuffer::clear() {
  while (!messages_.empty()) forgetFirst();
}

StreamBuffer::Messages StreamBuffer::extractSince(std::uint64_t first) {
  Messages extracted;
  for (auto message = messages_.begin(); message != messages_.end();) {
    const auto next = std::next(message);
    if (message->second.sequence >= first) extracted.insert(messages_.extract(message));
    message = next;
  }
  return extracted;
}

Nanoseconds StreamBuffer::largestGapIn(std::uint64_t episode) const {
  Nanoseconds largest = gap_episode_ == episode ? largest_forgotten_gap_ : 0;
  if (messages_.empty()) return largest;
  for (auto earlier = messages_.begin(), later = std::next(earlier); later != messages_.end(); ++earlier, ++later) {
    largest = std::max(largest, gapBetween(*earlier, *later, episode));
  }
  return largest;
}

}  // namespace demo_logger
