#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "demo_logger/recording/episode_label.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/metadata.h"
#include "episode_closer.h"

namespace demo_logger {

/// The episodes that a recorder has ended: those being saved, those saved, and what can still be done to them.
class EpisodeArchive {
 public:
  explicit EpisodeArchive(std::filesystem::path directory) : directory_(std::move(directory)) {}

  /// Saves an episode here and now; those ended before it come first.
  const ClosedEpisode& add(std::unique_ptr<EpisodeWriter> writer, const Metadata& metadata);
  /// Saves it in the background.
  void addLater(std::unique_ptr<EpisodeWriter> writer, Metadata metadata);
  /// Takes note of those saved meanwhile.
  void collect();
  void wait();
  bool isSaving() const { return closer_.busy(); }

  /// Moves the last finished one to discarded/ and returns its id and new place. Throws FileError.
  ClosedEpisode discardLast();
  /// Changes the label of episode `id`, "" for the last one, and returns its id. Throws ConfigurationError, FileError.
  std::string label(const std::string& id, const EpisodeLabel& label);

  /// The last one ended, saved or not; nothing in it before the first.
  const ClosedEpisode& last() const { return last_; }
  const std::vector<std::filesystem::path>& finished() const { return finished_; }
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  void note(ClosedEpisode closed);

  const std::filesystem::path directory_;
  EpisodeCloser closer_;
  ClosedEpisode last_;
  std::vector<std::filesystem::path> finished_;
  std::vector<Fault> faults_;
};

}  // namespace demo_logger
