#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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
  /// Brings everything to the disk and closes: nothing more can be written, and commit() can hardly fail.
  void finish();
  /// The file now has its name, finished if it was not. To be called once.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool overwrite_;
  bool committed_ = false;
  int descriptor_ = -1;  // -1: finished
};

/// Files that appear under their names together or not at all.
class AtomicFiles {
 public:
  /// A file that is now written, and finished before the next is added: only one is open, however many there are.
  AtomicFile& add(const std::filesystem::path& path, bool overwrite);
  /// All files are on the disk before the first gets its name. If one cannot have its own, those that had theirs lose
  /// it again, unless they replaced a file. To be called once.
  void commit();

 private:
  struct Entry {
    std::filesystem::path path;
    bool replaces = false;
    std::unique_ptr<AtomicFile> file;
  };
  std::vector<Entry> entries_;
};

/// The whole of it in one call.
void writeFileAtomically(const std::filesystem::path& path, std::string_view content, bool overwrite = false);

/// rename() that never replaces a file, even one that appears at this moment.
void renameWithoutReplacing(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace demo_logger
