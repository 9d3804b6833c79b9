#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace demo_logger {

/// The CSV files meant by what the user named: files as they are, of directories every *.csv in them, in the order of
/// their names. Throws FileError for what is not there, and for a directory without any.
std::vector<std::filesystem::path> findRecordings(const std::vector<std::string>& paths);

}  // namespace demo_logger
