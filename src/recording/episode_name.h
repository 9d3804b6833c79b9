#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace demo_logger {

/// The names of an episode's files: demo_000042.csv and .json, with `.part` behind them while it is open.
struct EpisodeFiles {
  std::filesystem::path data;
  std::filesystem::path sidecar;
};

EpisodeFiles finalFiles(const std::filesystem::path& directory, const std::string& id);
EpisodeFiles partFiles(const std::filesystem::path& directory, const std::string& id);

/// Where discarded episodes go: `directory`/discarded.
std::filesystem::path discardedDirectory(const std::filesystem::path& directory);

/// "demo_000042" for 42.
std::string episodeId(std::uint64_t number);

/// 42 for "demo_000042" and for anything that continues it after a dot, as demo_000042.csv.part does.
std::optional<std::uint64_t> episodeNumber(const std::string& file_name);

/// One more than the highest number that any file in `directory` or its discarded/ carries.
std::uint64_t nextEpisodeNumber(const std::filesystem::path& directory);

/// Throws FileError unless `id` consists of A-Z a-z 0-9 _ - alone, so that it can never lead out of a directory.
void requirePlainId(const std::string& id);

}  // namespace demo_logger
