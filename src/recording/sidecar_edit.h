#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace demo_logger {

/// Sets top-level texts of a finished episode's sidecar; the file changes whole or not at all, and keeps everything
/// else. Throws FileError.
void setSidecarTexts(const std::filesystem::path& sidecar, const std::map<std::string, std::string>& texts);

/// Throws FileError where `directory` has no finished episode `id`, or `id` could lead elsewhere.
void requireFinishedEpisode(const std::filesystem::path& directory, const std::string& id);

}  // namespace demo_logger
