#pragma once

#include <algorithm>
#include <optional>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// A stamp, and the steady clock when it was received.
struct ClockReading {
  Nanoseconds stamp = 0;
  Nanoseconds steady = 0;
};

/// Watches the clock of the joint states' stamps for jumps. A reading steps away from the line when its stamp is
///   more than 1 s before the newest stamp so far, or
///   more than 1 s further ahead of it than the steady clock, and as much further ahead of the steady clock than any
///   before: after a stall in which messages were lost, the stamps only catch up with what they were. Nor is it a step
///   when the stamps run at up to kFastestPlayback times the steady clock, as in a recording played back fast.
/// One reading away from the line is suspect. If the next continues it, the clock has jumped; if the next is on the
/// line again, it was an outlier.
class ClockWatch {
 public:
  static constexpr Nanoseconds kJump = kNanosecondsPerSecond;
  static constexpr Nanoseconds kFastestPlayback = 5;

  enum class Verdict {
    on_the_line,      // a suspect before it was an outlier
    suspect,          // so was one before it
    repeats_suspect,  // the same stamp again, which tells nothing
    jumped,           // it continues the suspect: both are the new line
  };
  Verdict judge(const ClockReading& reading);

  /// By how much the clock jumped when judge() last said so.
  Nanoseconds jump() const { return jump_; }
  /// The newest stamp on the line.
  std::optional<Nanoseconds> newest() const;

 private:
  struct Line {
    ClockReading newest;
    Nanoseconds largest_lead;  // of the stamps over the steady clock

    explicit Line(const ClockReading& first) : newest(first), largest_lead(first.stamp - first.steady) {}
    bool isLeftBy(const ClockReading& reading) const;
    void extend(const ClockReading& reading);
  };

  std::optional<Line> line_;
  std::optional<ClockReading> suspect_;
  Nanoseconds jump_ = 0;
};

}  // namespace demo_logger
