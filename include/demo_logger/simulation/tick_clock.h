#pragma once

#include <cstdint>

#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// Says when the ticks of a real-time loop happen and what their stamps are. It is told the time and never asks.
///
/// Following the ROS clock, stamps are one period apart exactly, and the wake-ups, on the steady clock, are slewed by
/// up to a thousandth so that stamps stay with the ROS clock although both clocks drift. In a time of its own (`/clock`
/// mode) stamps count from 1 s (or another start), a zero stamp meaning none in ROS, at `speed` times the steady clock.
/// A loop that is late catches up tick by tick; one that is more than 0.1 s late, or whose ROS clock jumped by more, is
/// set to now, which is counted.
class TickClock {
 public:
  struct Configuration {
    Nanoseconds period = 1'000'000;
    bool own_time = false;
    double speed = 1.0;                               // own time only; 0: as fast as it goes
    Nanoseconds first_stamp = kNanosecondsPerSecond;  // own time only
  };

  TickClock(const Configuration& configuration, Nanoseconds steady_now, Nanoseconds ros_now);

  Nanoseconds stamp() const { return stamp_; }  // of the coming tick
  Nanoseconds due() const { return due_; }      // on the steady clock

  /// The coming tick starts now; after it, stamp() and due() are those of the next one.
  void advance(Nanoseconds steady_now, Nanoseconds ros_now);

  /// Goes on after a pause: the coming tick is now.
  void resume(Nanoseconds steady_now, Nanoseconds ros_now);

  std::uint64_t overruns() const { return overruns_; }         // ticks that started more than a period late
  std::uint64_t jumps() const { return jumps_; }               // times it was set to now
  Nanoseconds largestDelay() const { return largest_delay_; }  // of a tick's start
  void forgetLargestDelay() { largest_delay_ = 0; }

 private:
  Configuration configuration_;
  Nanoseconds stamp_ = 0;
  Nanoseconds due_ = 0;
  std::uint64_t overruns_ = 0;
  std::uint64_t jumps_ = 0;
  Nanoseconds largest_delay_ = 0;
};

}  // namespace demo_logger
