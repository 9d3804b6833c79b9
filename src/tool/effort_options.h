#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// What the command line says of the efforts of a recording.
struct EffortOptions {
  std::string timing;                    // --effort, empty: nothing said
  std::string side;                      // --side, ditto
  std::optional<double> control_period;  // --control-period [s]

  bool any() const { return !timing.empty() || !side.empty() || control_period; }
};

/// Declares the three; `otherwise` is what holds where one is not given: "as the recording says".
void addEffortOptions(CLI::App& verb, EffortOptions& options, const std::string& otherwise);

/// What was recorded of the efforts, corrected by the command line.
EffortMetadata corrected(EffortMetadata recorded, const EffortOptions& options);

/// The provenance's step of an import, where nothing was said of the efforts.
constexpr const char* kImportStep = "import";

/// Whether a recording says what its efforts mean: its sidecar, unless that is a foreign one or that of an import which
/// was not told.
bool saysWhatEffortsMean(const Metadata& recorded);

/// As it stands in the provenance: " --effort held --control-period 0.001".
std::string stepOf(const EffortOptions& options);

}  // namespace demo_logger
