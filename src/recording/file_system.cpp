#include "file_system.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace demo_logger {

namespace {

template <typename Result>
Result orError(Result result) {
  return result < 0 ? static_cast<Result>(-errno) : result;
}

}  // namespace

int FileSystem::create(const std::filesystem::path& file) {
  return orError(::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0640));
}

int FileSystem::open(const std::filesystem::path& file) {
  // Without O_NONBLOCK a named pipe would hold us until somebody opens its other end.
  const int descriptor = orError(::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (descriptor >= 0 && (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode))) {
    ::close(descriptor);
    return -EINVAL;
  }
  return descriptor;
}

int FileSystem::close(int descriptor) { return orError(::close(descriptor)); }

int FileSystem::lock(int descriptor) { return orError(::flock(descriptor, LOCK_EX | LOCK_NB)); }

ssize_t FileSystem::write(int descriptor, const char* bytes, std::size_t size, off_t offset) {
  return orError(::pwrite(descriptor, bytes, size, offset));
}

int FileSystem::truncate(int descriptor, off_t size) { return orError(::ftruncate(descriptor, size)); }

int FileSystem::reserve(int descriptor, off_t size) {
  return orError(::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, size));
}

int FileSystem::syncData(int descriptor) { return orError(::fdatasync(descriptor)); }

int FileSystem::syncDirectory(const std::filesystem::path& directory) {
  const int descriptor = orError(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (descriptor < 0) {
    return descriptor;
  }
  const int result = orError(::fsync(descriptor));
  ::close(descriptor);
  return result;
}

int FileSystem::rename(const std::filesystem::path& from, const std::filesystem::path& to) {
  const int result = orError(::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE));
  if (result != -EINVAL && result != -ENOSYS) {
    return result;
  }
  // A file system that cannot rename exclusively: a hard link is as exclusive, and the file never lacks a name.
  const int linked = orError(::link(from.c_str(), to.c_str()));
  return linked < 0 ? linked : orError(::unlink(from.c_str()));
}

int FileSystem::replace(const std::filesystem::path& from, const std::filesystem::path& to) {
  return orError(::rename(from.c_str(), to.c_str()));
}

int FileSystem::remove(const std::filesystem::path& file) { return orError(::unlink(file.c_str())); }

bool FileSystem::exists(const std::filesystem::path& file) {
  struct stat status {};
  return ::lstat(file.c_str(), &status) == 0;
}

std::int64_t FileSystem::freeSpace(const std::filesystem::path& directory) {
  struct statvfs status {};
  const int result = orError(::statvfs(directory.c_str(), &status));
  return result < 0 ? result : static_cast<std::int64_t>(status.f_bavail * status.f_frsize);
}

FileSystem& operatingSystem() {
  static FileSystem file_system;
  return file_system;
}

FileDescriptor::FileDescriptor(FileDescriptor&& other) noexcept
    : file_system_(other.file_system_), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  if (this != &other) {
    reset();
    file_system_ = other.file_system_;
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

void FileDescriptor::reset() {
  if (descriptor_ >= 0) {
    file_system_->close(std::exchange(descriptor_, -1));
  }
}

bool isSameFile(int descriptor, const std::filesystem::path& file) {
  struct stat by_descriptor {};
  struct stat by_name {};
  return ::fstat(descriptor, &by_descriptor) == 0 && ::lstat(file.c_str(), &by_name) == 0 &&
         by_descriptor.st_dev == by_name.st_dev && by_descriptor.st_ino == by_name.st_ino;
}

std::string errorText(int error) { return std::generic_category().message(std::abs(error)); }

}  // namespace demo_logger
