#pragma once

#include <filesystem>
#include <vector>

#include "file_system.h"

namespace demo_logger {

/// Moves files, those of them that exist, to `directory`/discarded, all with the same end of their id (_2, _3, …) where
/// one of their names is taken there. Returns their new places, empty for those that did not exist. Throws FileError.
std::vector<std::filesystem::path> moveToDiscarded(FileSystem& file_system, const std::filesystem::path& directory,
                                                   const std::vector<std::filesystem::path>& files);

}  // namespace demo_logger
