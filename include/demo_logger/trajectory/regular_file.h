#pragma once

#include <filesystem>
#include <string>

namespace demo_logger {

/// Refuses what may never end, or has no content: a device, a pipe, a socket, a directory, also at the end of a
/// symbolic link. What is not there is left to its reader to miss. Throws FileError:
///   demo.json: is a device, expected <expected>
void requireRegularFile(const std::filesystem::path& file, const std::string& expected);

}  // namespace demo_logger
