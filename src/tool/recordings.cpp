#include "src/tool/recordings.h"

#include <algorithm>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

std::vector<std::filesystem::path> recordingsIn(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.is_regular_file() && entry.path().extension() == ".csv") {
      files.push_back(entry.path());
    }
  }
  if (files.empty()) {
    throw FileError(directory.string() + ": no recording (*.csv) in this directory");
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

std::vector<std::filesystem::path> findRecordings(const std::vector<std::string>& paths) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path path : paths) {
    if (std::filesystem::is_directory(path)) {
      const std::vector<std::filesystem::path> found = recordingsIn(path);
      files.insert(files.end(), found.begin(), found.end());
    } else if (std::filesystem::exists(path)) {
      files.push_back(path);
    } else {
      throw FileError(path.string() + ": no such file or directory");
    }
  }
  return files;
}

}  // namespace demo_logger
