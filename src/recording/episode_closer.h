#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// An episode that has been saved, or could not be.
struct ClosedEpisode {
  std::string id;
  std::filesystem::path file;     // empty: it had no row, or failed
  std::uint64_t rows = 0;         // in the file
  std::uint64_t not_written = 0;  // rows that found no room
  double duration = 0.0;          // [s]
  Nanoseconds last_stamp = 0;     // of its last row
  std::string error;
};

/// Finishes it here and now, waiting for the disk.
ClosedEpisode closeEpisode(std::unique_ptr<EpisodeWriter> writer, const Metadata& metadata);

/// Finishes episodes, one after the other, in a thread of its own, for those who must not wait for the disk.
class EpisodeCloser {
 public:
  EpisodeCloser() : thread_([this] { run(); }) {}
  /// Finishes what it was given.
  ~EpisodeCloser();
  EpisodeCloser(const EpisodeCloser&) = delete;
  EpisodeCloser& operator=(const EpisodeCloser&) = delete;

  /// Waits only when several others have not been finished yet, so that threads and memory stay bounded.
  void close(std::unique_ptr<EpisodeWriter> writer, Metadata metadata);
  bool busy() const;
  void wait();
  /// Those finished since this was last asked, oldest first.
  std::vector<ClosedEpisode> collect();

 private:
  struct Job {
    std::unique_ptr<EpisodeWriter> writer;
    Metadata metadata;
  };

  void run();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;  // the first one is at work
  std::vector<ClosedEpisode> closed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace demo_logger
