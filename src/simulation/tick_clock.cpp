#include "demo_logger/simulation/tick_clock.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace demo_logger {
namespace {

constexpr Nanoseconds kLongestCatchUp = 100'000'000;

}  // namespace

TickClock::TickClock(const Configuration& configuration, Nanoseconds steady_now, Nanoseconds ros_now)
    : configuration_(configuration),
      stamp_(configuration.own_time ? configuration.first_stamp : ros_now),
      due_(steady_now) {}

void TickClock::advance(Nanoseconds steady_now, Nanoseconds ros_now) {
  const Nanoseconds period = configuration_.period;
  const bool unpaced = configuration_.own_time && configuration_.speed == 0.0;
  const Nanoseconds delay = unpaced ? 0 : steady_now - due_;
  largest_delay_ = std::max(largest_delay_, delay);
  if (delay > period) ++overruns_;

  stamp_ += period;
  if (configuration_.own_time) {
    due_ = unpaced ? steady_now : due_ + std::llround(static_cast<double>(period) / configuration_.speed);
    if (delay > kLongestCatchUp) {
      ++jumps_;
      due_ = steady_now;
    }
    return;
  }
  due_ += period;
  const Nanoseconds due_by_ros = stamp_ - (ros_now - steady_now);
  const Nanoseconds drift = due_by_ros - due_;
  if (delay > kLongestCatchUp || std::abs(drift) > kLongestCatchUp) {
    ++jumps_;
    resume(steady_now + period, ros_now + period);
    return;
  }
  due_ += std::clamp(drift, -period / 1000, period / 1000);
}

void TickClock::resume(Nanoseconds steady_now, Nanoseconds ros_now) {
  due_ = steady_now;
  if (!configuration_.own_time) stamp_ = ros_now;
}

}  // namespace demo_logger
