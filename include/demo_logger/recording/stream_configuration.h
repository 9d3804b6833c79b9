#pragma once

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/sample.h"
#include "demo_logger/trajectory/column.h"

namespace demo_logger {

/// Which message of a stream belongs to a row at time s (all times are effective stamps: stamp − latency).
///   hold:    the last one at or before s, never a later one
///   linear:  between the neighbours of s (slerp for orientations); NaN without a later neighbour in time, or across a
///            gap longer than max_gap
///   nearest: the closest one, the earlier of two equally close
enum class Alignment { hold, linear, nearest };

struct StreamConfiguration {
  std::string name;  // prefix of the columns; `teleop_cmd` is written as `u`
  std::string topic;
  std::optional<StreamType> type;  // fixes the columns before the first message, where the type can
  Alignment alignment = Alignment::hold;
  double latency = 0.0;  // [s] subtracted from every stamp; may be negative
  /// Stamps promised to increase strictly: what breaks the promise is dropped and counted. When every stream promises
  /// it, a row is released as soon as each has sent what decides it; joint states that arrive out of order are then
  /// late.
  bool in_order = false;
};

struct SynchroniserConfiguration {
  std::vector<std::string> joints;            // empty: those of the first valid message
  std::vector<std::string> prismatic_joints;  // those whose columns are in m, m/s and N
  std::vector<StreamConfiguration> streams;
  double max_wait = 0.1;              // [s] a row waits after its receipt for stragglers
  double max_gap = 0.5;               // [s] `linear` does not bridge more; a longer one between rows is a fault
  double wait_for_streams = 1.0;      // [s] an episode waits for the first message of joy and joint_command streams
  bool merge_joint_states = false;    // joints from other messages than the row's become linear streams of their own
  bool correct_clock_offset = false;  // move unstamped streams by the joint states' clock offset
};

/// Throws ConfigurationError naming the field, the value with its unit, and what was expected: a name that is empty,
/// not portable or given twice, a topic that is empty, a wait or gap that is negative or not finite, |latency| above 10
/// s, joy with `linear`, a joint that is empty or given twice, merge_joint_states without joints.
void validate(const SynchroniserConfiguration& configuration);

}  // namespace demo_logger
