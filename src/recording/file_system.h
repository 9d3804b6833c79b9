#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>

namespace demo_logger {

/// What the recording asks of the operating system. The tests replace it to let calls fail.
/// Each function gives what the call behind it gives, and −errno where that fails. All may be called from any thread.
class FileSystem {
 public:
  virtual ~FileSystem() = default;

  /// A new file to write to, mode 0640. Fails where anything of that name exists, a dangling symbolic link too.
  virtual int create(const std::filesystem::path& file);
  /// An existing regular file, never through a symbolic link.
  virtual int open(const std::filesystem::path& file);
  virtual int close(int descriptor);
  /// flock, exclusive: −EWOULDBLOCK where someone else holds the file.
  virtual int lock(int descriptor);
  virtual ssize_t write(int descriptor, const char* bytes, std::size_t size, off_t offset);
  virtual int truncate(int descriptor, off_t size);
  /// Keeps room on the disk for a file that may grow to `size`, without making it longer. May not be supported.
  virtual int reserve(int descriptor, off_t size);
  virtual int syncData(int descriptor);
  virtual int syncDirectory(const std::filesystem::path& directory);
  /// Never over another file: −EEXIST.
  virtual int rename(const std::filesystem::path& from, const std::filesystem::path& to);
  /// Over another file, at once.
  virtual int replace(const std::filesystem::path& from, const std::filesystem::path& to);
  virtual int remove(const std::filesystem::path& file);
  /// Anything of that name, a dangling symbolic link too.
  virtual bool exists(const std::filesystem::path& file);
  /// Bytes that this user may still write.
  virtual std::int64_t freeSpace(const std::filesystem::path& directory);
};

/// The real one.
FileSystem& operatingSystem();

/// Owns an open file; closing it gives its lock back.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  FileDescriptor(FileSystem& file_system, int descriptor) : file_system_(&file_system), descriptor_(descriptor) {}
  ~FileDescriptor() { reset(); }
  FileDescriptor(FileDescriptor&& other) noexcept;
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  int get() const { return descriptor_; }
  explicit operator bool() const { return descriptor_ >= 0; }
  void reset();

 private:
  FileSystem* file_system_ = nullptr;
  int descriptor_ = -1;
};

/// Whether `file` still is the file behind `descriptor`: it may have been renamed or replaced since it was opened.
bool isSameFile(int descriptor, const std::filesystem::path& file);

/// "No space left on device", for an errno with either sign.
std::string errorText(int error);

}  // namespace demo_logger
