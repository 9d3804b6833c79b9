#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "file_system.h"
#include "sidecar_file.h"

namespace demo_logger {

/// Gives the parts of episode `id` their final names, data first, sidecar last, and syncs the directory. `text` makes
/// the sidecar of the id it is given: where a final name has been taken meanwhile, the next free number is used;
/// nothing is ever overwritten. A sidecar that cannot be brought up to date keeps its last text.
/// Returns the final CSV. Throws FileError; what could not be renamed keeps its name.
std::filesystem::path publish(FileSystem& file_system, const std::filesystem::path& directory, const std::string& id,
                              SidecarFile& sidecar, const std::function<std::string(const std::string& id)>& text);

}  // namespace demo_logger
