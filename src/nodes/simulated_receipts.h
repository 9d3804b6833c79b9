#pragma once

#include "demo_logger/recording/sample.h"

namespace demo_logger {

/// Receipts in simulated time, which moves in ticks and may be set back (a simulation reset, a bag played in a loop).
/// Messages placed in the order of their arrival get receipts that tell this order, a nanosecond apart within a tick;
/// `steady` goes on where the simulated clock is set back by more than a second.
class SimulatedReceipts {
 public:
  void place(Arrival& arrival) {
    if (arrival.receipt < last_ - kNanosecondsPerSecond) {
      carried_ += last_ - arrival.receipt;
    } else if (arrival.receipt <= last_) {
      arrival.receipt = last_ + 1;
    }
    last_ = arrival.receipt;
    arrival.steady = arrival.receipt + carried_;
  }

 private:
  Nanoseconds last_ = 0;
  Nanoseconds carried_ = 0;
};

}  // namespace demo_logger
