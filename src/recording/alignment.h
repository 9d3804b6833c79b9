#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "demo_logger/recording/stream_configuration.h"
#include "stream_buffer.h"

namespace demo_logger {

/// How the messages of one stream become the values of a row.
struct AlignmentRule {
  Alignment alignment = Alignment::hold;
  Nanoseconds max_gap = 0;                 // `linear` does not bridge more
  std::size_t width = 0;                   // values per message
  std::optional<std::size_t> orientation;  // index of the first of the components x y z w
};

/// What chooseFrom() took.
struct Chosen {
  StreamMessage* message = nullptr;  // the (earlier) message used
  StreamMessage* later = nullptr;    // the other one, where two were interpolated
  bool unbridged = false;            // `linear` had an earlier message, and no later one near enough
  double age = 0.0;                  // [s] row − effective stamp of the (earlier) message; NaN before the first
};

/// Writes the values of a row at `instant` into values[0 … width), NaN where the rule gives none.
Chosen chooseFrom(StreamBuffer& buffer, const AlignmentRule& rule, Nanoseconds instant, double* values);

/// Row times, `begin` included and `end` not.
struct Reach {
  Nanoseconds begin = 0;
  Nanoseconds end = 0;
};

/// The rows whose values or age change when a message at `effective` joins those of `buffer`.
Reach reachOf(Nanoseconds effective, const StreamBuffer& buffer, const AlignmentRule& rule);

}  // namespace demo_logger
