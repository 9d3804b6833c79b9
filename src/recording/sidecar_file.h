#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "file_system.h"

namespace demo_logger {

/// The sidecar while its episode is open: replaced whole each time, under flock from the moment it has its name.
class SidecarFile {
 public:
  /// `descriptor` holds the lock on `file`.
  SidecarFile(FileSystem& file_system, std::filesystem::path file, FileDescriptor descriptor);

  /// Writes and syncs a new file with some reserve behind its text, and renames it over the old one. Returns 0 or
  /// −errno; the old file then stays.
  int replace(std::string_view text);
  /// The last time. On a disk without room for a new file beside the old one, the text goes into the old one's reserve.
  int replaceForGood(std::string_view text);
  /// Whether that has ever succeeded.
  bool hasText() const { return size_ > 0; }
  /// After replaceForGood().
  void giveReserveBack();

  const std::filesystem::path& file() const { return file_; }

 private:
  int writeNew(std::string_view text);
  int overwrite(std::string_view text);

  FileSystem& file_system_;
  std::filesystem::path file_;
  FileDescriptor descriptor_;
  off_t size_ = 0;
};

}  // namespace demo_logger
