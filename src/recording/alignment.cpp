#include "alignment.h"

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "demo_logger/trajectory/interpolation.h"

namespace demo_logger {
namespace {

using Entry = StreamBuffer::Messages::value_type;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Chosen take(Entry& entry, Nanoseconds instant, double* values) {
  std::copy(entry.second.values.begin(), entry.second.values.end(), values);
  return {&entry.second, nullptr, false, toSeconds(instant - entry.first)};
}

void interpolate(const Entry& before, const Entry& after, const AlignmentRule& rule, Nanoseconds instant,
                 double* values) {
  const double fraction = fractionBetween(before.first, instant, after.first);
  const std::vector<double>& from = before.second.values;
  const std::vector<double>& to = after.second.values;
  for (std::size_t i = 0; i < rule.width; ++i) values[i] = interpolateLinearly(from[i], to[i], fraction);
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

bool decides(Nanoseconds newest, Alignment alignment, Nanoseconds instant) {
  // The last message held is that at the instant itself until a later one shows that none replaces it.
  return alignment == Alignment::hold ? newest > instant : newest >= instant;
}

}  // namespace demo_logger
