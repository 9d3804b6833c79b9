#include "row_writer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

#include "demo_logger/formats/csv_writer.h"

namespace demo_logger {

namespace {

constexpr std::size_t kTextBytes = 256 * 1024;  // formatted at once

std::chrono::duration<double> seconds(double value) { return std::chrono::duration<double>(value); }

}  // namespace

RowWriter::RowWriter(FileSystem& file_system, FileDescriptor descriptor, std::filesystem::path file,
                     const std::vector<Column>& columns, const EpisodeWriterOptions& options, DiskFaults& faults)
    : file_system_(file_system),
      file_(std::move(file)),
      options_(options),
      faults_(faults),
      column_count_(columns.size()),
      data_(file_system, std::move(descriptor)),
      batch_(columns.size()),
      text_(csvHeader(columns)),
      queue_(columns.size()),
      thread_([this] { run(); }) {}

void RowWriter::write(const Row& row) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    if (progress_.given == 0) {
      progress_.first_stamp = row.stamp;
    }
    if (options_.may_wait) {
      progressed_.wait(lock, [this] { return hasRoom() || refused_; });
    }
    progress_.last_stamp = row.stamp;
    ++progress_.given;
    if (!hasRoom()) {
      ++progress_.not_written;
      return;
    }
    ++waiting_;
    queue_.add(row);
  }
  rows_waiting_.notify_one();
}

bool RowWriter::hasRoom() const { return (waiting_ + 1) * queue_.bytesPerRow() <= options_.queue_bytes; }

WritingProgress RowWriter::progress() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return progress_;
}

void RowWriter::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  rows_waiting_.notify_one();
  closing_changed_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void RowWriter::run() {
  bool last = false;
  while (!last) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      rows_waiting_.wait(lock, [this] { return closing_ || queue_.size() > 0; });
      // Rows gather meanwhile, so that one call writes many.
      closing_changed_.wait_for(lock, seconds(options_.flush_interval), [this] { return closing_; });
      last = closing_;
      std::swap(queue_, batch_);
    }
    writeBatch();
    batch_.clear();
  }
}

void RowWriter::writeBatch() {
  if (gave_up_) {
    giveUp(batch_.size());
    return;
  }
  std::size_t formatted = 0;
  std::size_t written = 0;
  while (written < batch_.size()) {
    for (; formatted < batch_.size() && text_.size() < kTextBytes; ++formatted) {
      appendRow(text_, batch_.stamp(formatted) - progress_.first_stamp, batch_.values(formatted), column_count_);
    }
    const bool last_try = isClosing();
    if (const std::size_t rows = appendText(); rows > 0) {
      written += rows;
      advance(rows, batch_.stamp(written - 1));
    }
    noteRefusal(data_.error() != 0);
    if (data_.error() == 0) {
      faults_.over(DiskFaultKind::rows);
      continue;
    }
    reportRefusal(batch_.size() - written);
    if (last_try) {
      giveUp(batch_.size() - written);
      return;
    }
    waitForRoom();
  }
}

/// Returns how many rows reached the file.
std::size_t RowWriter::appendText() {
  const std::size_t bytes = data_.append(text_);
  auto lines =
      static_cast<std::size_t>(std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(bytes), '\n'));
  text_.erase(0, bytes);
  if (lines > 0 && !header_written_) {
    header_written_ = true;
    --lines;
  }
  return lines;
}

void RowWriter::advance(std::size_t rows, Nanoseconds last_stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_ -= rows;
  progress_.written += rows;
  progress_.last_written_stamp = last_stamp;
  progress_.bytes = static_cast<std::uint64_t>(data_.size());
}

/// What comes after a row that is lost at the end is lost too: a shorter recording is better than one with a hole.
void RowWriter::giveUp(std::size_t rows) {
  gave_up_ = true;
  text_.clear();
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_ -= rows;
  progress_.not_written += rows;
}

void RowWriter::noteRefusal(bool refused) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    refused_ = refused;
  }
  progressed_.notify_one();
}

void RowWriter::reportRefusal(std::size_t waiting) {
  const int error = data_.error();
  const std::int64_t free_bytes = std::max<std::int64_t>(0, file_system_.freeSpace(file_.parent_path()));
  const bool full = error == ENOSPC || error == EDQUOT;
  faults_.report(DiskFaultKind::rows, batch_.stamp(batch_.size() - waiting),
                 (full ? "disk full: " : "disk error: ") + file_.string() + " takes no more rows (" + errorText(error) +
                     ", " + std::to_string(free_bytes) + " bytes free); what is in it stays readable, " +
                     std::to_string(waiting) + " rows or more wait in memory, and writing is tried again " +
                     (full ? "until there is room." : "until it works."),
                 /*lasting=*/true);
}

void RowWriter::waitForRoom() {
  std::unique_lock<std::mutex> lock(mutex_);
  closing_changed_.wait_for(lock, seconds(options_.retry_interval), [this] { return closing_; });
}

bool RowWriter::isClosing() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return closing_;
}

}  // namespace demo_logger
