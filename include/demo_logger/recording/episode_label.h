#pragma once

#include <filesystem>
#include <string>

namespace demo_logger {

/// What a person says about an episode. Empty: unchanged.
struct EpisodeLabel {
  std::string outcome;  // success, failure, unknown
  std::string task;
  std::string operator_name;
  std::string notes;
};

/// Throws ConfigurationError naming the value and those allowed.
void requireChannel(const std::string& channel);  // teleoperation, kinesthetic, vr, unknown
void requireOutcome(const std::string& outcome);  // success, failure, unknown

/// Rewrites the sidecar of the finished episode `id`, whole or not at all; everything else that stands in it stays,
/// also keys that this software does not know. Throws ConfigurationError, FileError.
void labelEpisode(const std::filesystem::path& directory, const std::string& id, const EpisodeLabel& label);

}  // namespace demo_logger
