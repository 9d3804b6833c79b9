#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/derived_columns.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// An episode from its start to its end: first a number that is taken, from its first row on a file that grows.
class OpenEpisode {
 public:
  using DerivedColumnsList = std::vector<std::unique_ptr<DerivedColumns>>;

  /// `derived` outlives the episode.
  OpenEpisode(EpisodeReservation reservation, Metadata metadata, const EpisodeWriterOptions& options,
              const DerivedColumnsList& derived);

  /// The columns are known: those `recorded`, whose names are portable already (`original_names`: what some of them
  /// were), then the derived ones, whose names are made so.
  void open(const std::vector<Column>& recorded, const std::map<std::string, std::string>& original_names);
  /// Derives the row's other values and hands it to the disk's threads.
  void write(const Row& row);

  /// What the derived columns have to say.
  std::vector<Fault> faults() const;

  const std::string& id() const;
  std::filesystem::path file() const;

  /// Nullptr before the first row.
  const EpisodeWriter* writer() const { return writer_.get(); }
  /// Keeps the metadata for the sidecar, for the case that nothing more can be told.
  void save(const Metadata& metadata);
  std::unique_ptr<EpisodeWriter> takeWriter() { return std::move(writer_); }

  Metadata metadata;  // what was said about the episode; what is counted is added when it is saved

 private:
  const EpisodeWriterOptions options_;
  const DerivedColumnsList& derived_;
  std::optional<EpisodeReservation> reservation_;
  std::unique_ptr<EpisodeWriter> writer_;
  Row complete_row_;  // kept for its memory
};

}  // namespace demo_logger
