#include "sidecar_file.h"

#include <cerrno>
#include <utility>

namespace demo_logger {

namespace {

/// Room kept behind the text, so that the last words about a full disk still fit onto it.
constexpr off_t kReserve = 16384;

bool isFull(int result) { return result == -ENOSPC || result == -EDQUOT; }

int writeAll(FileSystem& file_system, int descriptor, std::string_view text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written =
        file_system.write(descriptor, text.data() + done, text.size() - done, static_cast<off_t>(done));
    if (written > 0) {
      done += static_cast<std::size_t>(written);
    } else if (written != -EINTR) {
      return written == 0 ? -ENOSPC : static_cast<int>(written);
    }
  }
  return 0;
}

}  // namespace

SidecarFile::SidecarFile(FileSystem& file_system, std::filesystem::path file, FileDescriptor descriptor)
    : file_system_(file_system), file_(std::move(file)), descriptor_(std::move(descriptor)) {}

int SidecarFile::replace(std::string_view text) {
  const int result = writeNew(text);
  if (result == 0) {
    size_ = static_cast<off_t>(text.size());
  }
  return result;
}

int SidecarFile::replaceForGood(std::string_view text) {
  int result = replace(text);
  if (isFull(result)) {
    result = overwrite(text);
  }
  return result;
}

void SidecarFile::giveReserveBack() {
  if (hasText()) {
    file_system_.truncate(descriptor_.get(), size_);
  }
}

int SidecarFile::writeNew(std::string_view text) {
  std::filesystem::path fresh = file_;
  fresh += ".new";
  file_system_.remove(fresh);  // of one who was killed at this very place
  FileDescriptor descriptor(file_system_, file_system_.create(fresh));
  if (!descriptor) {
    return descriptor.get();
  }
  int result = file_system_.lock(descriptor.get());
  if (result == 0) {
    result = writeAll(file_system_, descriptor.get(), text);
  }
  if (result == 0) {
    result = file_system_.reserve(descriptor.get(), static_cast<off_t>(text.size()) + kReserve);
    result = isFull(result) ? result : 0;  // a file system that knows no reserves is no reason to stop
  }
  if (result == 0) {
    result = file_system_.syncData(descriptor.get());
  }
  if (result == 0) {
    result = file_system_.replace(fresh, file_);
  }
  if (result != 0) {
    file_system_.remove(fresh);
    return result;
  }
  descriptor_ = std::move(descriptor);
  return 0;
}

int SidecarFile::overwrite(std::string_view text) {
  const auto size = static_cast<off_t>(text.size());
  if (file_system_.reserve(descriptor_.get(), size) != 0) {
    return -ENOSPC;  // a torn text would be worse than an old one
  }
  int result = writeAll(file_system_, descriptor_.get(), text);
  if (result == 0) {
    result = file_system_.truncate(descriptor_.get(), size);
  }
  if (result == 0) {
    size_ = size;
    result = file_system_.syncData(descriptor_.get());
  }
  return result;
}

}  // namespace demo_logger
