#include "demo_logger/recording/clock_watch.h"

namespace demo_logger {

bool ClockWatch::Line::isLeftBy(const ClockReading& reading) const {
  const Nanoseconds advance = reading.stamp - newest.stamp;
  if (advance < -kJump) return true;
  const Nanoseconds steady_advance = std::max<Nanoseconds>(reading.steady - newest.steady, 0);
  return advance - steady_advance > kJump && advance / kFastestPlayback > steady_advance &&
         reading.stamp - reading.steady - largest_lead > kJump;
}

void ClockWatch::Line::extend(const ClockReading& reading) {
  largest_lead = std::max(largest_lead, reading.stamp - reading.steady);
  if (reading.stamp > newest.stamp) newest = reading;
}

ClockWatch::Verdict ClockWatch::judge(const ClockReading& reading) {
  if (!line_) {
    line_.emplace(reading);
    return Verdict::on_the_line;
  }
  if (!line_->isLeftBy(reading)) {
    line_->extend(reading);
    suspect_.reset();
    return Verdict::on_the_line;
  }
  if (suspect_ && suspect_->stamp == reading.stamp) return Verdict::repeats_suspect;
  if (suspect_ && !Line(*suspect_).isLeftBy(reading)) {
    // Where the steady clock went back too (simulated time starts anew), the stamps alone tell by how much.
    const Nanoseconds elapsed = std::max<Nanoseconds>(suspect_->steady - line_->newest.steady, 0);
    jump_ = suspect_->stamp - line_->newest.stamp - elapsed;
    line_.emplace(*suspect_);
    line_->extend(reading);
    suspect_.reset();
    return Verdict::jumped;
  }
  suspect_ = reading;
  return Verdict::suspect;
}

std::optional<Nanoseconds> ClockWatch::newest() const {
  if (!line_) return std::nullopt;
  return line_->newest.stamp;
}

}  // namespace demo_logger
