#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/episode_reservation.h"
#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// How an EpisodeWriter goes about it. The defaults are what the file format promises (doc/file_format.md).
struct EpisodeWriterOptions {
  double flush_interval = 0.04;  // [s] at most until a row is in the kernel, where a SIGKILL cannot reach it
  double sync_interval = 1.0;    // [s] between fdatasync, and between updates of the sidecar
  double retry_interval = 1.0;   // [s] between attempts on a full disk
  std::size_t queue_bytes = 64 * 1024 * 1024;  // rows that wait in memory for the disk; more are counted, not written
  /// When the queue is full and the disk only slow, write() waits: for sources that can wait, such as a bag.
  bool may_wait = false;
};

/// Writes one episode to disk as it happens, from a thread of its own:
///   demo_000001.csv.part and demo_000001.json.part, the next free number in `directory`, under flock. Rows reach the
///   kernel at least every 50 ms and the disk each second; finish() renames the data first, the sidecar last.
/// Whatever happens, every complete row stays readable. On a full disk rows wait in memory, as many as the bounded
/// queue holds, and are written when there is room again; those beyond are counted as not written.
class EpisodeWriter {
 public:
  /// Creates the directory where needed and both part files. Throws FileError.
  EpisodeWriter(const std::filesystem::path& directory, const std::vector<Column>& columns, const Metadata& metadata);
  /// The same with a number taken before. Does not wait for the disk.
  EpisodeWriter(EpisodeReservation reservation, std::vector<Column> columns, const Metadata& metadata,
                const EpisodeWriterOptions& options = {});
  /// Without finish(): closes the parts as interrupted ("interrupted: not finished") and renames them all the same.
  ~EpisodeWriter();
  EpisodeWriter(const EpisodeWriter&) = delete;
  EpisodeWriter& operator=(const EpisodeWriter&) = delete;

  const std::string& id() const;       // "demo_000001"
  std::filesystem::path file() const;  // the final name of the CSV
  void write(const Row& row);          // never blocks on the disk (unless may_wait)
  /// Kept for the sidecar, which is brought up to date on disk each second and at the end.
  void update(const Metadata& metadata);

  std::uint64_t rows() const;  // given to write()
  double duration() const;     // [s] from the first of them to the last
  Nanoseconds lastStamp() const;
  std::uint64_t rowsNotWritten() const;
  std::optional<std::string> fault() const;  // "disk full: …", nothing while all is well
  /// Every fault so far, the present one included; each kind once, stamped with the row that it was first met at.
  std::vector<Fault> faults() const;
  /// In the file, and left on the disk when it was last looked at (each second); nothing where that is not known.
  std::uint64_t bytes() const;
  std::optional<std::uint64_t> bytesFree() const;

  /// Flushes, syncs, renames. Returns the final CSV, whose number is another one than id() where that has been taken
  /// by a file put there meanwhile. Fields of `metadata` that follow from the rows (id, rows, duration, start_stamp,
  /// the counter rows_not_written, the disk's faults) are filled in. Without a single row both parts are removed and
  /// the path is empty. Throws FileError if the data could not be renamed; the part then stays. To be called once.
  std::filesystem::path finish(Metadata metadata);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Space left for recordings in `directory` [bytes]; of the nearest directory above it where it does not exist yet.
/// Throws FileError.
std::uintmax_t freeSpace(const std::filesystem::path& directory);

/// What recover() did with one left-over pair of parts.
struct Recovered {
  std::filesystem::path file;  // the final CSV
  std::uint64_t rows = 0;
  std::uint64_t dropped_bytes = 0;  // of an incomplete last row
};

/// Finishes the part files in `directory` that no one holds, as "interrupted: killed". A recorder's open episode is
/// left alone. Parts without a complete row are moved to discarded/. What cannot be known any more, because the
/// sidecar is lost too, follows from the CSV's header, with a fault that says so. Throws FileError.
std::vector<Recovered> recover(const std::filesystem::path& directory);

/// Moves a finished episode's files to `directory`/discarded, never over others: demo_000001 becomes demo_000001_2
/// there. Returns the CSV's new place. Throws FileError.
std::filesystem::path discardEpisode(const std::filesystem::path& directory, const std::string& id);

}  // namespace demo_logger
