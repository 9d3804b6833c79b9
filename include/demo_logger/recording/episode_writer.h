#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// Writes one episode to disk as it happens, from a thread of its own:
///   demo_000001.csv.part and demo_000001.json.part, the next free number in `directory`, under flock. Rows reach the
///   kernel at least every 50 ms and the disk each second; finish() renames the data first, the sidecar last.
/// Whatever happens, every complete row stays readable. On a full disk rows are counted as not written and writing goes
/// on when there is room again; the queue in memory is bounded.
class EpisodeWriter {
 public:
  /// Creates the directory where needed and both part files. Throws FileError.
  EpisodeWriter(const std::filesystem::path& directory, const std::vector<Column>& columns, const Metadata& metadata);
  /// Without finish(): closes the parts as interrupted ("interrupted: not finished") and renames them all the same.
  ~EpisodeWriter();
  EpisodeWriter(const EpisodeWriter&) = delete;
  EpisodeWriter& operator=(const EpisodeWriter&) = delete;

  const std::string& id() const;       // "demo_000001"
  std::filesystem::path file() const;  // the final name of the CSV
  void write(const Row& row);          // never blocks on the disk
  /// Kept for the sidecar, which is brought up to date on disk each second and at the end.
  void update(const Metadata& metadata);
  std::uint64_t rows() const;  // given to write()
  std::uint64_t rowsNotWritten() const;
  std::optional<std::string> fault() const;  // "disk full: …", nothing while all is well

  /// Flushes, syncs, renames. Returns the final CSV. Fields of `metadata` that follow from the rows (id, rows,
  /// duration, start_stamp) are filled in. Throws FileError if the data could not be renamed; the part then stays.
  std::filesystem::path finish(Metadata metadata);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Space left for recordings in `directory` [bytes], and the bytes a minute of rows takes.
std::uintmax_t freeSpace(const std::filesystem::path& directory);

/// What recover() did with one left-over pair of parts.
struct Recovered {
  std::filesystem::path file;  // the final CSV
  std::uint64_t rows = 0;
  std::uint64_t dropped_bytes = 0;  // of an incomplete last row
};

/// Finishes the part files in `directory` that no one holds, as "interrupted: killed". A recorder's open episode is
/// left alone. Parts without a complete row are moved to discarded/. Throws FileError.
std::vector<Recovered> recover(const std::filesystem::path& directory);

/// Moves a finished episode's files to `directory`/discarded, never over others. Throws FileError.
std::filesystem::path discardEpisode(const std::filesystem::path& directory, const std::string& id);

}  // namespace demo_logger
