#include "demo_logger/recording/episode_reservation.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "episode_name.h"
#include "reservation_files.h"

namespace demo_logger {

namespace {

void createDirectory(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  // A file in the place of the directory or of one above it gives different codes; both mean the same to the user.
  if (error == std::errc::not_a_directory || error == std::errc::file_exists ||
      (!error && !std::filesystem::is_directory(directory, error))) {
    throw FileError(directory.string() + ": there is a file of that name, expected a directory for the recordings. " +
                    "Remove it or choose another output directory.");
  }
  if (error) {
    throw FileError(directory.string() + ": the directory for the recordings cannot be created: " + error.message() +
                    ". Choose another output directory.");
  }
}

/// Creates and locks `file`; an empty descriptor where the name is taken.
FileDescriptor take(FileSystem& file_system, const std::filesystem::path& file) {
  const int created = file_system.create(file);
  if (created == -EEXIST) {
    return {};
  }
  if (created < 0) {
    throw FileError(file.string() + " cannot be created: " + errorText(created) +
                    ". Recordings need a directory that can be written to; choose another output directory.");
  }
  FileDescriptor descriptor(file_system, created);
  const int locked = file_system.lock(created);
  // Between the two calls a recovery may have taken the file for one left behind.
  if (locked == -EWOULDBLOCK || (locked == 0 && !isSameFile(created, file))) {
    return {};
  }
  if (locked < 0) {
    file_system.remove(file);
    throw FileError(file.string() + " cannot be locked: " + errorText(locked) +
                    ". Recordings need a file system with flock; choose another output directory.");
  }
  return descriptor;
}

}  // namespace

EpisodeReservation::Files::~Files() {
  const EpisodeFiles parts = partFiles(directory, id);
  if (sidecar) {
    file_system.remove(parts.sidecar);
  }
  if (data) {
    file_system.remove(parts.data);
  }
}

EpisodeReservation::EpisodeReservation(const std::filesystem::path& directory, FileSystem* file_system)
    : files_(new Files{file_system != nullptr ? *file_system : operatingSystem(), directory, {}, {}, {}}) {
  createDirectory(directory);
  for (std::uint64_t number = nextEpisodeNumber(directory);; ++number) {
    files_->id = episodeId(number);
    const EpisodeFiles parts = partFiles(directory, files_->id);
    const EpisodeFiles finals = finalFiles(directory, files_->id);
    files_->data = take(files_->file_system, parts.data);
    if (!files_->data) {
      continue;
    }
    // Whoever held this number a moment ago may have finished with it since the directory was read.
    if (!files_->file_system.exists(finals.data) && !files_->file_system.exists(finals.sidecar)) {
      files_->sidecar = take(files_->file_system, parts.sidecar);
      if (files_->sidecar) {
        return;
      }
    }
    files_->file_system.remove(parts.data);
    files_->data.reset();
  }
}

EpisodeReservation::~EpisodeReservation() = default;
EpisodeReservation::EpisodeReservation(EpisodeReservation&&) noexcept = default;
EpisodeReservation& EpisodeReservation::operator=(EpisodeReservation&&) noexcept = default;

const std::string& EpisodeReservation::id() const { return files_->id; }

std::filesystem::path EpisodeReservation::file() const { return finalFiles(files_->directory, files_->id).data; }

}  // namespace demo_logger
