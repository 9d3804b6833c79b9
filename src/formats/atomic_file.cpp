#include "demo_logger/formats/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr mode_t kFileMode = 0640;

std::string reason(int error) { return std::generic_category().message(error); }

FileError alreadyThere(const std::filesystem::path& path) {
  return FileError(path.string() + ": exists already and is not overwritten; choose another name or ask to overwrite.");
}

// An entry of any kind, a dangling symbolic link included.
bool isThere(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::symlink_status(path, error).type() != std::filesystem::file_type::not_found;
}

std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

// A name no other writer uses: not of this process by the count, not of another by its number.
std::filesystem::path temporaryBeside(const std::filesystem::path& path) {
  static std::atomic<unsigned> count{0};
  return folderOf(path) / ("." + path.filename().string().substr(0, 200) + "." + std::to_string(getpid()) + "." +
                           std::to_string(count++) + ".tmp");
}

// A rename is safe against power loss only when its folder has been synced. Some file systems cannot; so be it.
void syncFolder(const std::filesystem::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    fsync(descriptor);
    close(descriptor);
  }
}

}  // namespace

void renameWithoutReplacing(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) {
    return;
  }
  int error = errno;
  if (error == EINVAL || error == ENOSYS) {
    // A file system without this flag: an empty file created exclusively reserves the name, then is replaced.
    const int reservation = open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kFileMode);
    error = errno;
    if (reservation >= 0) {
      close(reservation);
      if (std::rename(from.c_str(), to.c_str()) == 0) {
        return;
      }
      error = errno;
      unlink(to.c_str());
    }
  }
  if (error == EEXIST) {
    throw alreadyThere(to);
  }
  throw FileError(to.string() + ": cannot be given its final name (" + reason(error) + "); the data is in " +
                  from.string() + ".");
}

AtomicFile::AtomicFile(std::filesystem::path path, bool overwrite)
    : path_(std::move(path)), temporary_(temporaryBeside(path_)), overwrite_(overwrite) {
  if (std::filesystem::is_directory(path_)) {
    throw FileError(path_.string() + ": is a directory; expected the name of a file to write.");
  }
  if (!overwrite_ && isThere(path_)) {
    throw alreadyThere(path_);
  }
  if (isThere(path_) && !std::filesystem::is_regular_file(path_) && !std::filesystem::is_symlink(path_)) {
    throw FileError(path_.string() +
                    ": is a device or the like, not a file that can be replaced; choose another name.");
  }
  descriptor_ = open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kFileMode);
  if (descriptor_ < 0) {
    throw FileError(path_.string() + ": cannot be created (" + reason(errno) +
                    "); expected an existing folder with the right to write in it.");
  }
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!committed_) unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    if (written < 0 && errno != EINTR) {
      throw FileError(path_.string() + ": cannot be written (" + reason(errno) + "); nothing was left behind.");
    }
    text.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
  }
}

void AtomicFile::finish() {
  if (descriptor_ < 0) return;
  if (fsync(descriptor_) != 0 && errno != EINVAL) {
    throw FileError(path_.string() + ": cannot be brought to the disk (" + reason(errno) +
                    "); nothing was left behind.");
  }
  close(descriptor_);
  descriptor_ = -1;
}

void AtomicFile::commit() {
  finish();
  if (overwrite_) {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
      throw FileError(path_.string() + ": cannot be replaced (" + reason(errno) + ").");
    }
  } else {
    renameWithoutReplacing(temporary_, path_);
  }
  committed_ = true;
  syncFolder(folderOf(path_));
}

AtomicFile& AtomicFiles::add(const std::filesystem::path& path, bool overwrite) {
  if (!entries_.empty()) entries_.back().file->finish();
  auto file = std::make_unique<AtomicFile>(path, overwrite);
  entries_.push_back({path, isThere(path), std::move(file)});
  return *entries_.back().file;
}

void AtomicFiles::commit() {
  if (!entries_.empty()) entries_.back().file->finish();
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    try {
      entry->file->commit();
    } catch (const FileError&) {
      for (auto named = entries_.begin(); named != entry; ++named) {
        if (!named->replaces) unlink(named->path.c_str());
      }
      throw;
    }
  }
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view content, bool overwrite) {
  AtomicFile file(path, overwrite);
  file.write(content);
  file.commit();
}

}  // namespace demo_logger
