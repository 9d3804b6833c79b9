#include "discarded.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "episode_name.h"
#include "sidecar_edit.h"

namespace demo_logger {

namespace {

/// demo_000001.csv.part → demo_000001_2.csv.part for 2.
std::filesystem::path attemptedName(const std::filesystem::path& file, unsigned attempt) {
  const std::string name = file.filename().string();
  const std::size_t dot = std::min(name.find('.'), name.size());
  return attempt == 1 ? name : name.substr(0, dot) + "_" + std::to_string(attempt) + name.substr(dot);
}

}  // namespace

std::vector<std::filesystem::path> moveToDiscarded(FileSystem& file_system, const std::filesystem::path& directory,
                                                   const std::vector<std::filesystem::path>& files) {
  const std::filesystem::path discarded = discardedDirectory(directory);
  std::error_code error;
  std::filesystem::create_directories(discarded, error);
  if (error) {
    throw FileError(discarded.string() + " cannot be created: " + error.message() + "; nothing was discarded.");
  }
  std::vector<std::filesystem::path> from = files;
  std::vector<std::filesystem::path> moved(files.size());
  for (unsigned attempt = 1;; ++attempt) {
    const auto isTaken = [&](const std::filesystem::path& file) {
      return file_system.exists(discarded / attemptedName(file, attempt));
    };
    if (std::any_of(files.begin(), files.end(), isTaken)) {
      continue;
    }
    int result = 0;
    for (std::size_t i = 0; i < files.size() && result == 0; ++i) {
      if (!file_system.exists(from[i])) {
        continue;
      }
      const std::filesystem::path to = discarded / attemptedName(files[i], attempt);
      result = file_system.rename(from[i], to);
      if (result == 0) {
        moved[i] = from[i] = to;
      } else if (result != -EEXIST) {
        throw FileError(from[i].string() + " cannot be moved to " + to.string() + ": " + errorText(result) + ".");
      }
    }
    if (result == 0) {
      file_system.syncDirectory(discarded);
      file_system.syncDirectory(directory);
      return moved;
    }
  }
}

std::filesystem::path discardEpisode(const std::filesystem::path& directory, const std::string& id) {
  requireFinishedEpisode(directory, id);
  const EpisodeFiles files = finalFiles(directory, id);
  const std::vector<std::filesystem::path> moved =
      moveToDiscarded(operatingSystem(), directory, {files.data, files.sidecar});
  const std::string new_id = moved.front().stem().string();
  if (new_id != id && !moved.back().empty()) {
    setSidecarTexts(moved.back(), {{"id", new_id}});
  }
  return moved.front();
}

}  // namespace demo_logger
