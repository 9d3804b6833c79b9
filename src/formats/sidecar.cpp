#include "demo_logger/formats/sidecar.h"

#include <fstream>
#include <iterator>
#include <set>
#include <system_error>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/formats/column_conventions.h"
#include "demo_logger/trajectory/regular_file.h"
#include "json_fields.h"

namespace demo_logger {
namespace {

using Json = nlohmann::json;

constexpr std::uintmax_t kLargestSidecar = 64U << 20U;  // bytes

Nanoseconds parseStamp(const Json& value, const JsonFields& parent, const std::string& key) {
  const JsonFields fields(value, parent.file(), parent.nameOf(key));
  std::int64_t secs = 0;
  std::int64_t nsecs = 0;
  fields.read("secs", secs);
  fields.read("nsecs", nsecs);
  if (nsecs < 0 || nsecs >= kNanosecondsPerSecond) {
    fields.refuse("nsecs", value["nsecs"], "nanoseconds from 0 to 999999999");
  }
  constexpr std::int64_t kLargestSecs = INT64_MAX / kNanosecondsPerSecond - 1;
  if (secs > kLargestSecs || secs < -kLargestSecs) {
    fields.refuse("secs", value["secs"], "seconds within 292 years of 1970");
  }
  return secs * kNanosecondsPerSecond + nsecs;
}

// Calls `parse` with each object of the array under `key`, and its full key.
template <typename Parse>
void forEachObject(const JsonFields& parent, const char* key, Parse parse) {
  const Json* array = parent.find(key);
  if (array == nullptr || array->is_null()) {
    return;
  }
  if (!array->is_array()) {
    parent.refuse(key, *array, "an array of objects");
  }
  for (std::size_t i = 0; i < array->size(); ++i) {
    parse(JsonFields((*array)[i], parent.file(), parent.nameOf(key) + "[" + std::to_string(i) + "]"));
  }
}

// Calls `parse` with the object under `key`, if there is one.
template <typename Parse>
void withObject(const JsonFields& parent, const char* key, Parse parse) {
  const Json* object = parent.find(key);
  if (object != nullptr && !object->is_null()) {
    parse(JsonFields(*object, parent.file(), parent.nameOf(key)));
  }
}

RobotMetadata parseRobot(const JsonFields& fields) {
  RobotMetadata robot;
  fields.read("name", robot.name);
  fields.read("urdf_sha256", robot.urdf_sha256);
  fields.read("base", robot.base);
  fields.read("tip", robot.tip);
  fields.read("joints", robot.joints);
  return robot;
}

EffortMetadata parseEffort(const JsonFields& fields) {
  EffortMetadata effort;
  fields.read("side", effort.side);
  fields.read("timing", effort.timing);
  fields.read("includes_gravity", effort.includes_gravity);
  fields.read("control_period", effort.control_period);
  return effort;
}

TeleopMapMetadata parseTeleopMap(const JsonFields& fields) {
  TeleopMapMetadata map;
  fields.read("mode", map.mode);
  fields.read("inputs", map.inputs);
  fields.read("outputs", map.outputs);
  fields.read("gain", map.gain);
  fields.read("offset", map.offset);
  fields.read("dead_zone", map.dead_zone);
  fields.read("saturation", map.saturation);
  return map;
}

StreamMetadata parseStream(const JsonFields& fields) {
  StreamMetadata stream;
  fields.read("name", stream.name);
  fields.read("topic", stream.topic);
  fields.read("type", stream.type);
  fields.read("frame_id", stream.frame_id);
  fields.read("publishers", stream.publishers);
  fields.read("stamped", stream.stamped);
  fields.read("align", stream.align);
  fields.read("latency", stream.latency);
  fields.read("received", stream.received);
  fields.read("used", stream.used);
  fields.read("late", stream.late);
  fields.read("dropped", stream.dropped);
  fields.read("largest_gap", stream.largest_gap);
  withObject(fields, "receipt_delay", [&stream](const JsonFields& delay) {
    delay.read("min", stream.receipt_delay.min);
    delay.read("median", stream.receipt_delay.median);
    delay.read("max", stream.receipt_delay.max);
  });
  return stream;
}

Fault parseFault(const JsonFields& fields) {
  Fault fault;
  if (const Json* stamp = fields.find("stamp")) {
    fault.stamp = parseStamp(*stamp, fields, "stamp");
  }
  fields.read("what", fault.what);
  fields.read("count", fault.count);
  std::string severity = "warning";
  fields.read("severity", severity);
  if (severity != "warning" && severity != "error") {
    fields.refuse("severity", severity, "warning or error");
  }
  fault.severity = severity == "error" ? Severity::error : Severity::warning;
  return fault;
}

ParameterValue parseParameter(const JsonFields& parameters, const std::string& key, const Json& value) {
  if (value.is_array()) {
    if (value.empty() || value.front().is_string()) {
      std::vector<std::string> words;
      parameters.read(key.c_str(), words);
      return words;
    }
    std::vector<double> numbers;
    parameters.read(key.c_str(), numbers);
    return numbers;
  }
  if (value.is_boolean()) {
    return value.get<bool>();
  }
  if (value.is_number_integer()) {
    std::int64_t number = 0;
    parameters.read(key.c_str(), number);
    return number;
  }
  if (value.is_number() || value.is_null()) {
    double number = 0.0;
    parameters.read(key.c_str(), number);
    return number;
  }
  if (!value.is_string()) {
    parameters.refuse(key, value, "a single value or an array of numbers or of texts");
  }
  return value.get<std::string>();
}

std::vector<Column> parseColumns(const JsonFields& fields, std::vector<std::string>& notes) {
  std::vector<std::string> names;
  forEachObject(fields, "columns", [&names](const JsonFields& column) {
    std::string name;
    column.read("name", name);
    if (name.empty()) {
      column.refuse("name", column.value(), "the column's name");
    }
    names.push_back(name);
  });

  std::vector<Column> columns = describeColumns(names);
  std::vector<std::string> concluded;
  std::size_t index = 0;
  forEachObject(fields, "columns", [&](const JsonFields& entry) {
    Column& column = columns[index++];
    std::string role = toString(column.role);
    std::string interpolation = toString(column.interpolation);
    entry.read("unit", column.unit);
    entry.read("role", role);
    entry.read("interpolation", interpolation);
    entry.read("source", column.source);
    if (column.name == "time" && column.unit != "s") {
      entry.refuse("unit", column.unit, "s, which times always are; convert them");
    }
    const auto known_role = roleFromString(role);
    const auto known_interpolation = interpolationFromString(interpolation);
    if (!known_role) {
      entry.refuse("role", role, "state, control or auxiliary");
    }
    if (!known_interpolation) {
      entry.refuse("interpolation", interpolation, "linear, slerp, hold or none");
    }
    column.role = *known_role;
    column.interpolation = *known_interpolation;
    const bool said =
        entry.find("unit") != nullptr && entry.find("role") != nullptr && entry.find("interpolation") != nullptr;
    if (!said && column.name != "time") {
      concluded.push_back(column.name);
    }
  });

  if (!concluded.empty()) {
    notes.push_back(fields.file() + ": does not say unit, role or interpolation of " +
                    (concluded.size() == 1
                         ? "column " + concluded.front()
                         : std::to_string(concluded.size()) + " columns (" + concluded.front() + " first)") +
                    "; what is missing follows from the names.");
  }
  std::vector<Column> without_time;
  for (Column& column : columns) {
    if (column.name != "time") {
      without_time.push_back(std::move(column));
    }
  }
  return without_time;
}

void keepOtherKeys(const Json& json, Metadata& metadata) {
  const Json ours = toJson({}, {});
  for (const auto& [key, value] : json.items()) {
    if (!ours.contains(key)) {
      metadata.other[key] = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
  }
}

}  // namespace

Sidecar parseSidecar(std::string_view text, const std::string& file) {
  const Json json = parseJson(text, file);
  const JsonFields fields(json, file);
  std::string format;
  fields.read("format", format);
  if (format != kSidecarFormat) {
    throw FileError(file + ": " + (format.empty() ? "has no key `format`" : "key `format` is \"" + format + "\"") +
                    ", expected \"" + kSidecarFormat + "\". Is it the sidecar of a demonstration, of this version?");
  }
  Sidecar sidecar;
  Metadata& metadata = sidecar.metadata;
  fields.read("id", metadata.id);
  fields.read("channel", metadata.channel);
  fields.read("task", metadata.task);
  fields.read("operator", metadata.operator_name);
  fields.read("outcome", metadata.outcome);
  fields.read("notes", metadata.notes);
  fields.read("status", metadata.status);
  if (const Json* stamp = fields.find("start_stamp"); stamp != nullptr && !stamp->is_null()) {
    metadata.start_stamp = parseStamp(*stamp, fields, "start_stamp");
  }
  fields.read("duration", metadata.duration);
  fields.read("rows", metadata.rows);
  sidecar.columns = parseColumns(fields, sidecar.notes);
  withObject(fields, "robot", [&metadata](const JsonFields& robot) { metadata.robot = parseRobot(robot); });
  withObject(fields, "effort", [&metadata](const JsonFields& effort) { metadata.effort = parseEffort(effort); });
  withObject(fields, "teleop_map", [&metadata](const JsonFields& map) { metadata.teleop_map = parseTeleopMap(map); });
  forEachObject(fields, "streams",
                [&metadata](const JsonFields& stream) { metadata.streams.push_back(parseStream(stream)); });
  withObject(fields, "counters", [&metadata](const JsonFields& counters) {
    for (const auto& item : counters.value().items()) {
      counters.read(item.key().c_str(), metadata.counters[item.key()]);
    }
  });
  forEachObject(fields, "faults",
                [&metadata](const JsonFields& fault) { metadata.faults.push_back(parseFault(fault)); });
  withObject(fields, "parameters", [&metadata](const JsonFields& parameters) {
    for (const auto& item : parameters.value().items()) {
      metadata.parameters[item.key()] = parseParameter(parameters, item.key(), item.value());
    }
  });
  withObject(fields, "original_names", [&metadata](const JsonFields& names) {
    for (const auto& item : names.value().items()) {
      names.read(item.key().c_str(), metadata.original_names[item.key()]);
    }
  });
  fields.read("software", metadata.software);
  withObject(fields, "provenance", [&metadata](const JsonFields& provenance) {
    provenance.read("parent", metadata.provenance.parent);
    provenance.read("steps", metadata.provenance.steps);
  });
  keepOtherKeys(json, metadata);
  return sidecar;
}

Sidecar readSidecar(const std::filesystem::path& path) {
  std::error_code error;
  requireRegularFile(path, "the JSON file beside a demonstration's CSV.");
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw FileError(path.string() +
                    ": cannot be opened; expected the readable JSON file beside a demonstration's CSV.");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kLargestSidecar) {
    throw FileError(path.string() + ": has " + std::to_string(size >> 20U) + " MB, expected a sidecar of at most " +
                    std::to_string(kLargestSidecar >> 20U) + " MB.");
  }
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return parseSidecar(text, path.string());
}

void writeSidecar(const std::filesystem::path& path, const Metadata& metadata, const std::vector<Column>& columns,
                  bool overwrite) {
  writeFileAtomically(path, sidecarText(metadata, columns), overwrite);
}

std::filesystem::path sidecarPath(const std::filesystem::path& csv) {
  if (csv.extension() == ".part") {
    return sidecarPath(std::filesystem::path(csv).replace_extension()) += ".part";
  }
  return std::filesystem::path(csv).replace_extension(".json");
}

}  // namespace demo_logger
