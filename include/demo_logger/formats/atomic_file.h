#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace demo_logger {

/// A file that appears under its name whole or not at all: written beside it under a temporary name (created
/// exclusively, mode 0640, no symbolic link followed), synced, then renamed. All functions throw FileError with the
/// path and the system's reason.
class AtomicFile {
 public:
  /// `overwrite` false: commit() refuses to replace what is there; the constructor already does, to save the work.
  AtomicFile(std::filesystem::path path, bool overwrite);
  /// Without commit(): removes what was written.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);
  /// Brings everything written so far to the disk, so that commit() can hardly fail.
  void sync();
  /// The file now has its name. To be called once.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool overwrite_;
  int descriptor_ = -1;
};

/// The whole of it in one call.
void writeFileAtomically(const std::filesystem::path& path, std::string_view content, bool overwrite = false);

/// rename() that never replaces a file, even one that appears at this moment.
void renameWithoutReplacing(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace demo_logger
