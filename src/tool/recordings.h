#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace demo_logger {

/// The CSV files meant by what the user named: files as they are, of directories every *.csv in them, in the order of
/// their names. Throws FileError for what is not there, and for a directory without any.
std::vector<std::filesystem::path> findRecordings(const std::vector<std::string>& paths);

/// Calls `look` with each of them. One that cannot be read is said on stderr and does not keep the others from their
/// turn. With `json` what `look` returns is printed as {"recordings": […]}, an unreadable one as its file and "error".
/// Returns the worst of the exit codes: kNotDone if any could not be read, else what `look` says.
struct Looked {
  int exit_code = 0;
  nlohmann::ordered_json json;
};
int lookAtRecordings(const std::vector<std::string>& paths, bool json,
                     const std::function<Looked(const std::filesystem::path&)>& look);

}  // namespace demo_logger
