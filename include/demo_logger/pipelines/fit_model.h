#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/pipelines/model_calibration.h"
#include "demo_logger/robot/robot_description.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

struct TimeSpan {
  double from = 0.0;  // [s] since the first row
  double to = 0.0;
};

struct FitOptions {
  std::optional<EffortMetadata> effort;  // what the efforts mean; nothing: what the recordings' metadata says
  double max_gap = 0.1;                  // [s] nothing is concluded across a longer silence of the joints
  /// What is known already. A value with a deviation is where the fit starts, and holds it so firmly; one without is
  /// known, and stays (friction of zero does not where friction is asked for explicitly: a fit that left it out writes
  /// that).
  ModelCalibration start;
  std::vector<TimeSpan> hand_free;  // where no hand touched the arm; empty: to be found
  std::optional<bool> friction;     // to be fitted; nothing: if the efforts are those of the motors
  bool bodies = false;              // every body is fitted, not the payload alone
  /// How far the fitted model may be off where no hand is, in parts of what a joint usually bears (root mean square).
  double model_error = 0.1;
  double least_duration = 2.0;  // [s] without a hand, in which the arm moves, or stands without friction
};

struct FitResult {
  std::string undetermined;  // why nothing could be fitted; empty: it could
  ModelCalibration calibration;
  struct Part {
    std::size_t recording = 0;
    TimeSpan span;
  };
  std::vector<Part> hand_free;         // what was used
  double duration = 0.0;               // [s] of it
  std::size_t rows = 0;                // that tell of at least one joint
  std::vector<double> residual_start;  // per joint, root mean square there [N m or N], as the start has it
  std::vector<double> residual;        // ditto, of the arm as `calibration` has it
  std::vector<std::string> doubts;     // a sentence for each joint that given parts without a hand do not agree with
  std::vector<std::string> findings;   // a sentence for each quantity: what it is, or why it is not known
};

/// Finds out by how much an arm differs from its description, from recordings in which, for a while, no hand touches
/// it: what the efforts are beyond M q̈ + C q̇ + g is then
///   payload:  four columns, linear in its mass m and m c
///   + torque bias + damping q̇ + friction tanh(q̇ / v)          for each joint
/// by least squares, each quantity held to its start by a ridge of its own (a prior standard deviation in its unit:
/// 1 kg; 0.1 kg m; of the joint's effort limit 2 % bias, 5 % friction, and 5 % damping at the velocity limit).
/// Residuals are not independent from row to row; each joint's are counted as the variance of their means over half a
/// second says, and so are the deviations that come with the values.
///
/// What the data do not tell stays as the start has it, a payload that chance alone would show once in a hundred times
/// is none, and one whose mass is hardly told is put where a payload can be; the rest is fitted anew to that, so that
/// what is written is what was fitted, and the residual its own.
///
/// Where no hand is, if not told: the longest part of the recordings, in windows of a quarter of a second, that one set
/// of values explains to within `model_error` (or five times the noise of the sensors), sought from each stretch of two
/// seconds, or of one if that finds none; then only what lies within three times the residual that is usual there.
/// Assumed is, so, that a hand's torque does not look like a payload, a bias or friction for longer than the hand is
/// away: it goes wrong where someone rests a steady weight on the tool for most of the recording. A joint that stands
/// still with friction says nothing of the torque on it, and does not count.
///
/// With `bodies`, where no hand is and after all that, the ten mass properties of every body take the payload's place,
/// each held to the description's by 30 % of its mass, 3 cm of its centre and as much of its radius of gyration (the
/// last one by a payload besides). Most of them are only known together; what is found is what torques need, the ridge
/// decides the rest. Bodies that cannot be are replaced by the nearest that can, near as the data have it.
///
/// With them, a payload of the start goes into the last body; bodies that the start states stay, and those that it
/// gives deviations are held by these.
///
/// Throws as addHumanTorque does; also ConfigurationError for an effort that no arm bears.
FitResult fitModel(const RobotDescription& robot, const std::vector<const Demonstration*>& recordings,
                   const FitOptions& options = {});

}  // namespace demo_logger
