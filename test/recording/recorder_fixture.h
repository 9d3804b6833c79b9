#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/recording/recorder.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {

/// A recorder of two joints and a twist, fed at 100 Hz by a robot whose every value can be told from its stamp:
/// at t seconds after kStart, q = (t, −t) and the commanded vx = t.
class RecorderTest : public testing::Test {
 protected:
  RecorderConfiguration configuration() const {
    RecorderConfiguration configuration;
    configuration.output_directory = directory_.path() / "demos";
    configuration.synchroniser.streams = {{"teleop_cmd", "teleop_cmd", StreamType::twist, Alignment::hold, 0.0, false}};
    configuration.metadata.channel = "teleoperation";
    configuration.metadata.task = "pour";
    configuration.metadata.software = "demo_logger 0.1.0";
    configuration.autostart = false;
    configuration.minimum_free_space = 0;
    return configuration;
  }

  void make(RecorderConfiguration configuration) {
    recorder_ = std::make_unique<Recorder>(std::move(configuration), std::move(derived_));
  }

  static Nanoseconds at(double seconds) { return kStart + fromSeconds(seconds); }

  Arrival arrival(Nanoseconds stamp) const {
    Arrival arrival;
    arrival.stamp = stamp + clock_skew_;
    arrival.receipt = stamp + kMillisecond;
    arrival.steady = arrival.receipt;
    return arrival;
  }

  JointStateSample jointState(double seconds) const {
    JointStateSample sample;
    sample.arrival = arrival(at(seconds));
    sample.names = {"shoulder", "elbow"};
    sample.position = {seconds, -seconds};
    return sample;
  }

  StreamSample command(double seconds) const {
    StreamSample sample;
    sample.arrival = arrival(at(seconds));
    sample.type = StreamType::twist;
    sample.values = {seconds, 0, 0, 0, 0, 0};
    return sample;
  }

  /// From `begin` until `end`, which is not included [s].
  void run(double begin, double end) {
    for (int tick = static_cast<int>(std::lround(begin * 100)); tick < std::lround(end * 100); ++tick) {
      const double seconds = tick / 100.0;
      recorder_->push(0, command(seconds));
      recorder_->push(jointState(seconds));
      recorder_->advance(at(seconds) + kMillisecond);
    }
  }

  std::filesystem::path file(const std::string& name) const { return directory_.path() / "demos" / name; }
  std::string listing(const std::string& below = "") const { return directory_.listing("demos/" + below); }
  Metadata saved(const std::string& id) const { return readSidecar(file(id + ".json")).metadata; }
  /// The values of the column q_shoulder: the seconds at which the rows were stamped.
  std::vector<double> secondsOf(const std::string& id) const {
    std::vector<double> seconds;
    for (const std::vector<double>& row : readTable(file(id + ".csv")).rows) {
      seconds.push_back(row[1]);
    }
    return seconds;
  }
  static std::vector<double> ticks(double begin, double end) {
    std::vector<double> seconds;
    for (int tick = static_cast<int>(std::lround(begin * 100)); tick < std::lround(end * 100); ++tick) {
      seconds.push_back(tick / 100.0);
    }
    return seconds;
  }

  RecordingDirectory directory_;
  Nanoseconds clock_skew_ = 0;  // of the joint states' and commands' stamps
  std::vector<std::unique_ptr<DerivedColumns>> derived_;
  std::unique_ptr<Recorder> recorder_;
};

}  // namespace demo_logger
