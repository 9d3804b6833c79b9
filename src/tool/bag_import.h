#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/recorder.h"
#include "demo_logger/robot/robot_description.h"
#include "src/tool/effort_options.h"
#include "src/tool/import_plan.h"

namespace demo_logger {

struct ImportOptions {
  std::filesystem::path output;
  double max_wait = 0.1;   // [s]
  double split_gap = 0.0;  // [s] 0: one episode
  std::string channel = "unknown";
  EffortOptions effort;
  std::optional<RobotDescription> robot;  // for the tool pose
  std::function<void(std::uint64_t done, std::uint64_t all)> progress = [](std::uint64_t, std::uint64_t) {};
};

/// Plays the bag into a Recorder as if it happened now, time being what the bag says. Returns the episodes' files.
/// Nothing remains of a bag that turns out to be damaged. Throws FileError, ConfigurationError.
std::vector<std::filesystem::path> importBag(const BagReader& bag, const ImportPlan& plan,
                                             const ImportOptions& options);

}  // namespace demo_logger
