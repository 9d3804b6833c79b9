#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/trajectory/demonstration.h"

namespace demo_logger {

struct LoadedDemonstration {
  Demonstration demonstration;
  /// What had to be concluded or does not agree, in sentences for the user: no sidecar, columns it does not list,
  /// another number of rows, names that were made portable.
  std::vector<std::string> notes;
};

/// Reads a demonstration's CSV and the sidecar beside it. Without one, or where it leaves columns open, their units,
/// roles and interpolation follow from their names. `rows` and `duration` of the metadata are those of the CSV.
/// Throws FileError (csv_reader.h, sidecar.h).
LoadedDemonstration readDemonstration(const std::filesystem::path& csv);

/// Writes both files, the data first; if either cannot be written, neither is there. Names that are not portable are
/// made so, with the mapping in the sidecar; infinities become NaN, counted under `infinities_written_as_nan`; `rows`
/// and `duration` are filled in. Throws FileError, also where `demonstration` contradicts itself: sizes that differ, no
/// rows, times that do not strictly increase.
void writeDemonstration(const std::filesystem::path& csv, const Demonstration& demonstration, bool overwrite = false);

/// The same as two of several files that get their names together.
void writeDemonstration(AtomicFiles& files, const std::filesystem::path& csv, const Demonstration& demonstration,
                        bool overwrite);

}  // namespace demo_logger
