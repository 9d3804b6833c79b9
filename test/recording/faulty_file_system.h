#pragma once

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <limits>
#include <thread>

#include "src/recording/file_system.h"

namespace demo_logger {

/// The real file system, made to fail as the test says.
class FaultyFileSystem : public FileSystem {
 public:
  std::atomic<std::int64_t> room{std::numeric_limits<std::int64_t>::max()};  // bytes, then the disk is full
  std::atomic<std::size_t> longest_write{std::numeric_limits<std::size_t>::max()};
  std::atomic<bool> interrupts{false};  // every other write meets a signal
  std::atomic<int> write_error{0};
  std::atomic<int> sync_error{0};
  std::atomic<int> rename_error{0};
  std::atomic<bool> writes_hang{false};  // until it is false again
  std::atomic<bool> syncs_hang{false};
  std::atomic<bool> sees_no_file{false};  // as if every file appeared just after it was looked for
  std::atomic<int> writes{0};
  std::atomic<int> refusals{0};

  ssize_t write(int descriptor, const char* bytes, std::size_t size, off_t offset) override {
    const int count = ++writes;
    waitWhile(writes_hang);
    if (interrupts && count % 2 == 1) {
      return -EINTR;
    }
    if (write_error != 0) {
      ++refusals;
      return -write_error;
    }
    const std::int64_t fits = std::min<std::int64_t>(room, static_cast<std::int64_t>(size));
    if (fits <= 0) {
      ++refusals;
      return -ENOSPC;
    }
    const ssize_t written = FileSystem::write(
        descriptor, bytes, std::min<std::size_t>(static_cast<std::size_t>(fits), longest_write), offset);
    room -= written;
    return written;
  }
  int reserve(int descriptor, off_t size) override {
    return room <= 0 ? -ENOSPC : FileSystem::reserve(descriptor, size);
  }
  int syncData(int descriptor) override {
    waitWhile(syncs_hang);
    return sync_error != 0 ? -sync_error : FileSystem::syncData(descriptor);
  }
  int rename(const std::filesystem::path& from, const std::filesystem::path& to) override {
    return rename_error != 0 ? -rename_error : FileSystem::rename(from, to);
  }
  bool exists(const std::filesystem::path& file) override { return !sees_no_file && FileSystem::exists(file); }
  std::int64_t freeSpace(const std::filesystem::path& directory) override {
    return std::min<std::int64_t>(room, FileSystem::freeSpace(directory));
  }

 private:
  static void waitWhile(const std::atomic<bool>& hangs) {
    while (hangs) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
};

}  // namespace demo_logger
