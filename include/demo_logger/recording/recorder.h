#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/derived_columns.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/recording/synchroniser.h"

namespace demo_logger {

enum class RecorderState { idle, recording, saving };

struct RecorderConfiguration {
  std::filesystem::path output_directory = "demos";
  SynchroniserConfiguration synchroniser;
  Metadata metadata;       // channel, task, operator, robot, effort, parameters, software: copied into each episode
  bool autostart = true;   // an episode begins with the first joint state, and again after a clock jump
  double split_gap = 0.0;  // [s] a longer pause in the joint states ends the episode and begins the next; 0: never
};

/// What ~start, ~stop, ~discard and ~label answer.
struct Reply {
  bool success = false;
  std::string message;  // one sentence
  std::string id;
  std::filesystem::path file;
  std::uint64_t rows = 0;
};

struct RecorderStatus {
  RecorderState state = RecorderState::idle;
  std::string id;
  std::filesystem::path file;
  std::uint64_t rows = 0;
  double duration = 0.0;      // [s] of the open episode
  double rate = 0.0;          // [Hz] rows per second of the open episode
  double minutes_left = 0.0;  // until the disk is full at the present rate; infinite when unknown
  std::vector<Fault> faults;
};

/// The recorder without ROS: idle → recording → saving → idle. Feed it samples and the watermark; it synchronises,
/// derives, writes. Used by the node with live messages and by the import with a bag. Not thread-safe.
class Recorder {
 public:
  /// Recovers what a killed recorder left in the output directory. Throws ConfigurationError, FileError.
  Recorder(RecorderConfiguration configuration, std::vector<std::unique_ptr<DerivedColumns>> derived);
  ~Recorder();

  void push(JointStateSample sample);
  void push(std::size_t stream, StreamSample sample);
  void advance(Nanoseconds watermark);

  /// An episode begins at `now`. Fails while one is open.
  Reply start(Nanoseconds now, const std::string& channel, const std::string& task, const std::string& operator_name,
              const std::string& notes);
  /// Ends it, with what was received until `now`. `outcome` is success, failure or unknown.
  Reply stop(Nanoseconds now, const std::string& outcome, const std::string& notes);
  /// Ends the open episode, or takes the last one, and moves it to discarded/.
  Reply discard(Nanoseconds now);
  /// Changes outcome, task, operator, notes (those not empty) of the episode `id`, "" for the open or the last one.
  Reply label(const std::string& id, const std::string& outcome, const std::string& task,
              const std::string& operator_name, const std::string& notes);
  /// Takes part in every later episode's metadata (the teleop map arrives late).
  void setTeleopMap(const TeleopMapMetadata& map);

  /// Losses before the recorder (the node's ring) belong into the counters too.
  void countLost(const std::string& counter, std::uint64_t total);

  RecorderStatus status() const;
  const Synchroniser& synchroniser() const;
  /// Every finished episode of this recorder, oldest first.
  const std::vector<std::filesystem::path>& finished() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
