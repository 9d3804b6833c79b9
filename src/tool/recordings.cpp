#include "src/tool/recordings.h"

#include <algorithm>
#include <iostream>

#include "demo_logger/trajectory/error.h"
#include "src/tool/verbs.h"

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

int lookAtRecordings(const std::vector<std::string>& paths, bool json,
                     const std::function<Looked(const std::filesystem::path&)>& look) {
  int exit_code = kDone;
  nlohmann::ordered_json recordings = nlohmann::ordered_json::array();
  for (const std::filesystem::path& file : findRecordings(paths)) {
    try {
      Looked looked = look(file);
      exit_code = std::max(exit_code, looked.exit_code);
      recordings.push_back(std::move(looked.json));
    } catch (const Error& error) {
      exit_code = kNotDone;
      std::cerr << error.what() << '\n';
      recordings.push_back({{"file", file.string()}, {"error", error.what()}});
    }
  }
  if (json) {
    std::cout << nlohmann::ordered_json{{"recordings", recordings}}.dump(2) << '\n';
  }
  return exit_code;
}

}  // namespace demo_logger
