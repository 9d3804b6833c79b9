#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include "src/nodes/live_recorder.h"

namespace demo_logger {

/// What /diagnostics says of a recorder: joint states, recording, clock, losses, and each stream.
class RecordingDiagnostics {
 public:
  RecordingDiagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const LiveRecorder& recorder,
                       bool correct_clock_offset);

  /// To be called each second.
  void publish();

 private:
  using Report = diagnostic_updater::DiagnosticStatusWrapper;

  void reportJointStates(Report& report);
  void reportRecording(Report& report) const;
  void reportClock(Report& report) const;
  void reportLosses(Report& report) const;
  void reportStream(std::size_t source, Report& report) const;

  const LiveRecorder& recorder_;
  const bool correct_clock_offset_;
  const ros::SteadyTime begin_;
  ros::SteadyTime heard_;  // when the number of joint states was last seen to grow
  std::uint64_t joint_states_ = 0;
  std::uint64_t joint_states_before_ = 0;
  ros::SteadyTime reported_;
  diagnostic_updater::Updater updater_;
};

}  // namespace demo_logger
