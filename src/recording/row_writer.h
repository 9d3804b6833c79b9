#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "data_file.h"
#include "demo_logger/recording/episode_writer.h"
#include "disk_faults.h"
#include "file_system.h"
#include "row_batch.h"

namespace demo_logger {

/// How far an episode's data has come.
struct WritingProgress {
  std::uint64_t given = 0;        // rows
  std::uint64_t written = 0;      // rows, in the kernel
  std::uint64_t not_written = 0;  // rows, for want of room on the disk and in memory
  std::uint64_t bytes = 0;        // in the file
  Nanoseconds first_stamp = 0;
  Nanoseconds last_stamp = 0;          // of the last row given
  Nanoseconds last_written_stamp = 0;  // of the last row in the file
};

/// Formats rows and writes them into the CSV from a thread of its own, so that write() never waits for the disk.
class RowWriter {
 public:
  /// `file` is what `descriptor` is called, for the faults. The file system and the faults outlive this.
  RowWriter(FileSystem& file_system, FileDescriptor descriptor, std::filesystem::path file,
            const std::vector<Column>& columns, const EpisodeWriterOptions& options, DiskFaults& faults);
  ~RowWriter() { close(); }
  RowWriter(const RowWriter&) = delete;
  RowWriter& operator=(const RowWriter&) = delete;

  void write(const Row& row);
  WritingProgress progress() const;
  /// May be called while rows are written. Returns 0 or −errno.
  int syncData() { return data_.syncData(); }
  /// Whether the file still has its name. May be called while rows are written.
  bool hasItsName() const { return data_.isCalled(file_); }
  /// Writes what waits, trying a full disk once more only, and ends the thread. Nothing can be written afterwards.
  void close();

 private:
  void run();
  void writeBatch();
  std::size_t appendText();
  void advance(std::size_t rows, Nanoseconds last_stamp);
  void giveUp(std::size_t rows);
  bool hasRoom() const;  // for one more row; under the mutex
  void noteRefusal(bool refused);
  void reportRefusal(std::size_t waiting);
  void waitForRoom();
  bool isClosing() const;

  FileSystem& file_system_;
  const std::filesystem::path file_;
  const EpisodeWriterOptions options_;
  DiskFaults& faults_;
  const std::size_t column_count_;

  // Of the thread alone.
  DataFile data_;
  RowBatch batch_;
  std::string text_;  // formatted, not yet in the file
  bool header_written_ = false;
  bool gave_up_ = false;

  mutable std::mutex mutex_;  // nobody holds it while waiting for the disk
  std::condition_variable rows_waiting_;
  std::condition_variable closing_changed_;
  std::condition_variable progressed_;
  RowBatch queue_;
  std::uint64_t waiting_ = 0;  // rows in queue_ and in batch_
  bool refused_ = false;       // what was written last
  WritingProgress progress_;
  bool closing_ = false;

  std::thread thread_;
};

}  // namespace demo_logger
