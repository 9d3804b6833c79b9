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

  /// Writes, syncs and renames a new file over the old one; on a full disk, where the new one has no room beside the
  /// old one, into the old one's reserve. Returns 0 or −errno; the old text then stays.
  int replace(std::string_view text);

  /// Whether replace() has ever succeeded.
  bool hasText() const { return size_ > 0; }
  /// When nothing more will be written.
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
