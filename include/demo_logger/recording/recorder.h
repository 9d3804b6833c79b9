#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
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
  double split_gap = 0.0;  // [s] a longer pause between the receipts of two joint states of the arm ends the episode
                           // and begins the next; 0: never, else more than max_wait
  std::string joint_states_topic = "joint_states";          // for sentences
  std::uintmax_t minimum_free_space = 16ULL * 1024 * 1024;  // [bytes] no episode begins with less
  EpisodeWriterOptions writer;
};

/// What ~start, ~stop, ~discard and ~label answer.
struct Reply {
  bool success = false;
  std::string message;  // one sentence
  std::string id;
  std::filesystem::path file;
  std::uint64_t rows = 0;
};

/// id, file, rows, duration and rate are those of the open episode, or of the last one.
struct RecorderStatus {
  RecorderState state = RecorderState::idle;
  std::string id;
  std::filesystem::path file;
  std::uint64_t rows = 0;
  double duration = 0.0;      // [s]
  double rate = 0.0;          // [Hz] rows per second
  double minutes_left = 0.0;  // until the disk is full at the present rate; infinite when unknown
  std::vector<Fault> faults;
};

/// The recorder without ROS: idle → recording → saving → idle. Feed it samples and the watermark; it synchronises,
/// derives, writes. Used by the node with live messages and by the import with a bag. Not thread-safe.
///
/// push() and advance() never wait for data to reach the disk: rows are written, and episodes that end by themselves
/// (clock jump, split_gap) saved, by threads of its own. start(), stop(), discard(), label(), close() do wait for it.
class Recorder {
 public:
  /// Recovers what a killed recorder left in the output directory. Throws ConfigurationError, and FileError where the
  /// output directory cannot be recorded into.
  Recorder(RecorderConfiguration configuration, std::vector<std::unique_ptr<DerivedColumns>> derived);
  /// Without close(): the open episode is saved as "interrupted: not finished", with the rows that are final.
  ~Recorder();

  void push(JointStateSample sample);
  void push(std::size_t stream, StreamSample sample);
  void advance(Nanoseconds watermark);

  /// An episode begins at `now`. Fails while one is open, for an unknown channel, and where the disk has no room.
  /// Empty arguments: those of the configuration. The id in the reply is taken; its files get rows when they are final.
  Reply start(Nanoseconds now, const std::string& channel, const std::string& task, const std::string& operator_name,
              const std::string& notes);
  /// Ends it, with what was received until `now`. `outcome` is success, failure or unknown (also if empty); the notes
  /// are added to those of the start. An episode without a row leaves no file, and the stop fails, naming the topic.
  Reply stop(Nanoseconds now, const std::string& outcome, const std::string& notes);
  /// Ends the open episode, or takes the last one, and moves it to discarded/.
  Reply discard(Nanoseconds now);
  /// Changes outcome, task, operator, notes (those not empty) of the episode `id`, "" for the open or the last one.
  Reply label(const std::string& id, const std::string& outcome, const std::string& task,
              const std::string& operator_name, const std::string& notes);
  /// The recorder goes down in order (SIGINT, SIGTERM, the end of a bag): the open episode is saved as complete, and
  /// none begins by itself any more. Succeeds with an empty id when none was open.
  Reply close(Nanoseconds now);

  /// Takes part in every later episode's metadata, and in the open one's unless it has a map already (the map arrives
  /// late).
  void setTeleopMap(const TeleopMapMetadata& map);

  /// Losses before the recorder (the node's ring) belong into the counters too: `total` since the node began, of which
  /// an episode shows its own share.
  void countLost(const std::string& counter, std::uint64_t total);

  RecorderStatus status() const;
  const Synchroniser& synchroniser() const;
  /// Every finished episode of this recorder that was not discarded, oldest first. One that ended by itself stands
  /// here when it is saved, at the latest after close().
  const std::vector<std::filesystem::path>& finished() const;
  /// What the constructor found and finished.
  const std::vector<Recovered>& recovered() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
