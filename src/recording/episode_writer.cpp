#include "demo_logger/recording/episode_writer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "disk_faults.h"
#include "episode_name.h"
#include "publish.h"
#include "reservation_files.h"
#include "row_writer.h"
#include "sidecar_file.h"

namespace demo_logger {

/// Two threads beside the caller's: RowWriter's, so that rows are in the kernel within flush_interval; and this one's,
/// which syncs and looks after the sidecar, so that a disk which takes its time over fdatasync delays no write.
class EpisodeWriter::Implementation {
 public:
  Implementation(EpisodeReservation::Files& files, std::vector<Column> columns, const Metadata& metadata,
                 const EpisodeWriterOptions& options)
      : options_(options),
        file_system_(files.file_system),
        directory_(files.directory),
        id_(files.id),
        columns_(std::move(columns)),
        metadata_(metadata),
        sidecar_(file_system_, partFiles(directory_, id_).sidecar, std::move(files.sidecar)),
        rows_(file_system_, std::move(files.data), partFiles(directory_, id_).data, columns_, options, faults_),
        syncing_([this] { syncLoop(); }) {}

  ~Implementation() {
    if (syncing_.joinable()) {
      stopThreads();
      metadata_.status = kNotFinished;
      try {
        finish(metadata_);
      } catch (const FileError&) {
        // The parts stay, and recover() will find them.
      }
    }
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void write(const Row& row) { rows_.write(row); }

  void update(const Metadata& metadata) {
    const std::lock_guard<std::mutex> lock(mutex_);
    metadata_ = metadata;
  }

  std::filesystem::path finish(Metadata metadata) {
    stopThreads();
    sync();
    if (rows_.progress().written == 0) {
      return removeParts();
    }
    return publish(file_system_, directory_, id_, sidecar_, [&](const std::string& id) {
      metadata.id = id;
      return sidecarText(completed(metadata), columns_);
    });
  }

  const std::string& id() const { return id_; }
  std::filesystem::path file() const { return finalFiles(directory_, id_).data; }
  WritingProgress progress() const { return rows_.progress(); }
  const DiskFaults& faults() const { return faults_; }

  std::optional<std::uint64_t> bytesFree() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return bytes_free_;
  }

 private:
  static constexpr char kNotFinished[] = "interrupted: not finished";

  void syncLoop() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!closing_) {
      Metadata metadata = metadata_;
      lock.unlock();
      sync();
      metadata.id = id_;
      metadata.status = kNotFinished;
      updateSidecar(metadata);
      lock.lock();
      closing_changed_.wait_for(lock, std::chrono::duration<double>(options_.sync_interval),
                                [this] { return closing_; });
    }
  }

  void sync() {
    const WritingProgress progress = rows_.progress();
    if (const int result = rows_.syncData(); result != 0) {
      faults_.report(DiskFaultKind::sync, progress.last_written_stamp,
                     "disk error: " + partFiles(directory_, id_).data.string() + " could not be synced (" +
                         errorText(result) + "); the rows of the last second may be lost if the power fails.",
                     /*lasting=*/false);
    }
    if (!rows_.hasItsName()) {
      faults_.report(DiskFaultKind::removed, progress.last_written_stamp,
                     partFiles(directory_, id_).data.string() +
                         " has been removed or replaced while it is recorded: its rows are lost when the episode "
                         "ends. Stop now and start again.",
                     /*lasting=*/true);
    }
    const std::int64_t bytes_free = file_system_.freeSpace(directory_);
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_free_ = bytes_free < 0 ? std::nullopt : std::optional<std::uint64_t>(bytes_free);
  }

  void updateSidecar(const Metadata& metadata) {
    if (const int result = sidecar_.replace(sidecarText(completed(metadata), columns_)); result == 0) {
      faults_.over(DiskFaultKind::sidecar);
    } else {
      const bool full = result == -ENOSPC || result == -EDQUOT;
      const std::int64_t bytes_free = std::max<std::int64_t>(0, file_system_.freeSpace(directory_));
      faults_.report(DiskFaultKind::sidecar, rows_.progress().last_written_stamp,
                     (full ? "disk full: " : "disk error: ") + sidecar_.file().string() +
                         " could not be brought up to date (" + errorText(result) + ", " + std::to_string(bytes_free) +
                         " bytes free); it is tried again each second.",
                     /*lasting=*/true);
    }
  }

  /// What follows from the rows. A sidecar speaks of the rows that are in the file.
  Metadata completed(Metadata metadata) const {
    const WritingProgress progress = rows_.progress();
    metadata.rows = progress.written;
    if (progress.written > 0) {
      metadata.start_stamp = progress.first_stamp;
      metadata.duration = toSeconds(progress.last_written_stamp - progress.first_stamp);
    }
    metadata.counters["rows_not_written"] = progress.not_written;
    const std::vector<Fault> faults = faults_.all();
    metadata.faults.insert(metadata.faults.end(), faults.begin(), faults.end());
    return metadata;
  }

  void stopThreads() {
    if (!syncing_.joinable()) {
      return;
    }
    rows_.close();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      closing_ = true;
    }
    closing_changed_.notify_one();
    syncing_.join();
  }

  std::filesystem::path removeParts() {
    const EpisodeFiles parts = partFiles(directory_, id_);
    file_system_.remove(parts.sidecar);
    file_system_.remove(parts.data);
    if (rows_.progress().given > 0) {
      throw FileError(id_ + ": none of its " + std::to_string(rows_.progress().given) + " rows could be written. " +
                      faults_.present().value_or("Is there room for rows in memory?"));
    }
    return {};
  }

  const EpisodeWriterOptions options_;
  FileSystem& file_system_;
  const std::filesystem::path directory_;
  const std::string id_;
  const std::vector<Column> columns_;
  DiskFaults faults_;

  mutable std::mutex mutex_;  // nobody holds it while waiting for the disk
  std::condition_variable closing_changed_;
  Metadata metadata_;
  std::optional<std::uint64_t> bytes_free_;
  bool closing_ = false;

  SidecarFile sidecar_;  // of the syncing thread, and of finish() when that has ended
  RowWriter rows_;
  std::thread syncing_;
};

EpisodeWriter::EpisodeWriter(const std::filesystem::path& directory, const std::vector<Column>& columns,
                             const Metadata& metadata)
    : EpisodeWriter(EpisodeReservation(directory), columns, metadata) {}

EpisodeWriter::EpisodeWriter(EpisodeReservation reservation, std::vector<Column> columns, const Metadata& metadata,
                             const EpisodeWriterOptions& options)
    : implementation_(std::make_unique<Implementation>(*reservation.files_, std::move(columns), metadata, options)) {}

EpisodeWriter::~EpisodeWriter() = default;

const std::string& EpisodeWriter::id() const { return implementation_->id(); }
std::filesystem::path EpisodeWriter::file() const { return implementation_->file(); }
void EpisodeWriter::write(const Row& row) { implementation_->write(row); }
void EpisodeWriter::update(const Metadata& metadata) { implementation_->update(metadata); }
std::uint64_t EpisodeWriter::rows() const { return implementation_->progress().given; }
std::uint64_t EpisodeWriter::rowsNotWritten() const { return implementation_->progress().not_written; }
std::uint64_t EpisodeWriter::bytes() const { return implementation_->progress().bytes; }
std::optional<std::uint64_t> EpisodeWriter::bytesFree() const { return implementation_->bytesFree(); }
std::optional<std::string> EpisodeWriter::fault() const { return implementation_->faults().present(); }
std::vector<Fault> EpisodeWriter::faults() const { return implementation_->faults().all(); }

Nanoseconds EpisodeWriter::lastStamp() const { return implementation_->progress().last_stamp; }

double EpisodeWriter::duration() const {
  const WritingProgress progress = implementation_->progress();
  return toSeconds(progress.last_stamp - progress.first_stamp);
}

std::filesystem::path EpisodeWriter::finish(Metadata metadata) { return implementation_->finish(std::move(metadata)); }

}  // namespace demo_logger
