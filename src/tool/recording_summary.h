#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/pipelines/check.h"

namespace demo_logger {

/// What `info` says of a recording.
struct RecordingSummary {
  std::filesystem::path file;
  std::uint64_t bytes = 0;
  bool has_sidecar = false;
  CheckSummary figures;
  std::vector<std::string> columns;
  Metadata metadata;
  std::vector<std::string> notes;
};

RecordingSummary summarise(const std::filesystem::path& csv, const LoadedDemonstration& loaded);

nlohmann::ordered_json toJson(const RecordingSummary& summary);
/// A few lines for a person.
std::string toText(const RecordingSummary& summary);

}  // namespace demo_logger
