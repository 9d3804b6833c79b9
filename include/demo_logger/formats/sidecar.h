#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// The JSON file beside the CSV: what the columns and the recording are (doc/file_format.md,
/// demonstration.schema.json).
constexpr const char* kSidecarFormat = "demo_logger/1";

struct Sidecar {
  Metadata metadata;
  std::vector<Column> columns;  // without `time`
  /// What the file left open and was concluded from the columns' names instead, in sentences.
  std::vector<std::string> notes;
};

/// Every key of the format, in its order; `columns` gets `time` in front, as in the CSV. A number that is not finite
/// becomes null, text that is not UTF-8 gets replacement characters when dumped by sidecarText.
nlohmann::ordered_json toJson(const Metadata& metadata, const std::vector<Column>& columns);

/// The same as indented text with a line feed at the end.
std::string sidecarText(const Metadata& metadata, const std::vector<Column>& columns);

/// Reads such text; `file` is named in errors. Only `format` is required. Absent keys keep the defaults of Metadata,
/// unknown ones at the top level are kept in Metadata::other; what a column does not say follows from its name, with a
/// note. Throws FileError for text that is not JSON, another format, or a value of the wrong type, naming the key.
Sidecar parseSidecar(std::string_view text, const std::string& file);

/// Throws FileError also where the file cannot be read.
Sidecar readSidecar(const std::filesystem::path& path);

/// Appears whole or not at all (atomic_file.h).
void writeSidecar(const std::filesystem::path& path, const Metadata& metadata, const std::vector<Column>& columns,
                  bool overwrite = false);

/// demo_000001.csv → demo_000001.json; demo_000001.csv.part → demo_000001.json.part
std::filesystem::path sidecarPath(const std::filesystem::path& csv);

}  // namespace demo_logger
