#pragma once

#include <string>
#include <vector>

#include "demo_logger/pipelines/check.h"
#include "findings.h"

namespace demo_logger {

/// The columns of one recorded stream, told by its age.
struct StreamColumns {
  std::string name;  // prefix of the columns; "u" for teleop_cmd
  Eigen::Index age = 0;
  std::vector<Eigen::Index> values;
  bool is_command = false;  // some of its columns are controls
  bool is_held = false;     // none of its values may come from after its row
};

std::vector<StreamColumns> findStreams(const Demonstration& demonstration);

/// Min, median and max of what is not missing; nothing if all is.
std::optional<Spread> spreadOf(const Demonstration::Values& values, Eigen::Index column);

CheckSummary summarise(const Demonstration& demonstration);

// Each looks at one side of the recording.
void checkTiming(const Demonstration& demonstration, const CheckSummary& summary, const CheckLimits& limits,
                 Findings& findings);
void checkCommands(const Demonstration& demonstration, const CheckLimits& limits, Findings& findings);
void checkMissingValues(const Demonstration& demonstration, const CheckLimits& limits, Findings& findings);
void checkMotion(const Demonstration& demonstration, const CheckSummary& summary, const CheckLimits& limits,
                 Findings& findings);
void checkOrientations(const Demonstration& demonstration, const CheckLimits& limits, Findings& findings);
void checkMetadata(const Metadata& metadata, Findings& findings);

}  // namespace demo_logger
