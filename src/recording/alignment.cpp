#include "alignment.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "demo_logger/trajectory/interpolation.h"
#include "demo_logger/trajectory/not_a_number.h"

namespace demo_logger {
namespace {

using Entry = StreamBuffer::Messages::value_type;

Chosen take(Entry& entry, Nanoseconds instant, double* values) {
  std::copy(entry.second.values.begin(), entry.second.values.end(), values);
  return {&entry.second, nullptr, false, toSeconds(instant - entry.first)};
}

void interpolate(const Entry& before, const Entry& after, const AlignmentRule& rule, Nanoseconds instant,
                 double* values) {
  const double fraction = fractionBetween(before.first, instant, after.first);
  const std::vector<double>& from = before.second.values;
  const std::vector<double>& to = after.second.values;
  for (std::size_t i = 0; i < rule.width; ++i) {
    const double value = interpolateLinearly(from[i], to[i], fraction);
    values[i] = std::isfinite(value) ? value : kNaN;  // neighbours near the limits of double overflow
  }
  if (rule.orientation) {
    const std::size_t first = *rule.orientation;
    Eigen::Map<Eigen::Vector4d>(values + first) = interpolateSpherically(
        Eigen::Map<const Eigen::Vector4d>(&from[first]), Eigen::Map<const Eigen::Vector4d>(&to[first]), fraction);
  }
}

Chosen chooseLinear(StreamBuffer::Neighbours neighbours, const AlignmentRule& rule, Nanoseconds instant,
                    double* values) {
  auto [before, after] = neighbours;
  if (before == nullptr) return {nullptr, nullptr, false, kNaN};
  if (before->first == instant) return take(*before, instant, values);
  const double age = toSeconds(instant - before->first);
  if (after == nullptr || after->first - before->first > rule.max_gap) return {nullptr, nullptr, true, age};
  interpolate(*before, *after, rule, instant, values);
  return {&before->second, &after->second, false, age};
}

}  // namespace

Chosen chooseFrom(StreamBuffer& buffer, const AlignmentRule& rule, Nanoseconds instant, double* values) {
  std::fill_n(values, rule.width, kNaN);
  const StreamBuffer::Neighbours neighbours = buffer.around(instant);
  Entry* const before = neighbours.at_or_before;
  Entry* const after = neighbours.after;
  switch (rule.alignment) {
    case Alignment::hold:
      if (before != nullptr) return take(*before, instant, values);
      break;
    case Alignment::linear:
      return chooseLinear(neighbours, rule, instant, values);
    case Alignment::nearest: {
      const bool before_is_closer =
          before != nullptr && (after == nullptr || instant - before->first <= after->first - instant);
      if (before_is_closer) return take(*before, instant, values);
      if (after != nullptr) return take(*after, instant, values);
      break;
    }
  }
  return {nullptr, nullptr, false, kNaN};
}

Reach reachOf(Nanoseconds effective, const StreamBuffer& buffer, const AlignmentRule& rule) {
  constexpr Nanoseconds kBeginning = std::numeric_limits<Nanoseconds>::min();
  constexpr Nanoseconds kEnd = std::numeric_limits<Nanoseconds>::max();
  const StreamBuffer::Messages& messages = buffer.messages();
  const auto next = messages.upper_bound(effective);
  const auto not_before = messages.lower_bound(effective);
  const bool is_last = next == messages.end();
  const bool is_first = not_before == messages.begin();
  const Nanoseconds after = is_last ? kEnd : next->first;
  const Nanoseconds before = is_first ? kBeginning : std::prev(not_before)->first;
  switch (rule.alignment) {
    case Alignment::hold:
      return {effective, after};
    case Alignment::linear: {
      const bool bridges_back = !is_first && effective - before <= rule.max_gap;
      const bool bridges_on = !is_last && after - effective <= rule.max_gap;
      // One that takes the place of another leaves the age as it is, so across a gap it changes nothing.
      const bool replaces = not_before != next;
      return {bridges_back ? before + 1 : effective, bridges_on || !replaces ? after : effective + 1};
    }
    case Alignment::nearest:
      // Of two equally close the earlier is taken, so a row in the very middle belongs to the earlier neighbour.
      return {is_first ? kBeginning : before + (effective - before) / 2 + 1,
              is_last ? kEnd : effective + (after - effective) / 2 + 1};
  }
  return {effective, after};
}

}  // namespace demo_logger
