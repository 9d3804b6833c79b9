#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "file_system.h"

namespace demo_logger {

/// The CSV while it grows. What is in it always ends with a complete line, also after a write that failed half-way.
class DataFile {
 public:
  /// `descriptor` belongs to an empty file.
  DataFile(FileSystem& file_system, FileDescriptor descriptor);

  /// Appends `lines`, each with its line feed. Returns how many bytes of them are in the file now, a number of whole
  /// lines; where that is not all, error() says why, and the rest may be given again later.
  std::size_t append(std::string_view lines);

  int error() const { return error_; }  // errno of the last append, 0 when it went well
  off_t size() const { return size_; }
  /// May be called while another thread appends.
  int syncData() { return file_system_.syncData(descriptor_.get()); }
  bool isCalled(const std::filesystem::path& name) const { return isSameFile(descriptor_.get(), name); }

 private:
  FileSystem& file_system_;
  FileDescriptor descriptor_;
  off_t size_ = 0;
  int error_ = 0;
};

}  // namespace demo_logger
