#include <nlohmann/json.hpp>

#include "demo_logger/formats/sidecar.h"

namespace demo_logger {
namespace {

using Json = nlohmann::ordered_json;

Json stampToJson(Nanoseconds stamp) {
  Nanoseconds secs = stamp / kNanosecondsPerSecond;
  Nanoseconds nsecs = stamp % kNanosecondsPerSecond;
  if (nsecs < 0) {
    nsecs += kNanosecondsPerSecond;
    --secs;
  }
  return {{"secs", secs}, {"nsecs", nsecs}};
}

Json columnToJson(const Column& column) {
  return {{"name", column.name},
          {"unit", column.unit},
          {"role", toString(column.role)},
          {"interpolation", toString(column.interpolation)},
          {"source", column.source}};
}

Json robotToJson(const RobotMetadata& robot) {
  return {{"name", robot.name},
          {"urdf_sha256", robot.urdf_sha256},
          {"base", robot.base},
          {"tip", robot.tip},
          {"joints", robot.joints}};
}

Json effortToJson(const EffortMetadata& effort) {
  return {{"side", effort.side},
          {"timing", effort.timing},
          {"includes_gravity", effort.includes_gravity},
          {"control_period", effort.control_period}};
}

Json teleopMapToJson(const std::optional<TeleopMapMetadata>& map) {
  if (!map) {
    return nullptr;
  }
  return {{"mode", map->mode},     {"inputs", map->inputs},       {"outputs", map->outputs},      {"gain", map->gain},
          {"offset", map->offset}, {"dead_zone", map->dead_zone}, {"saturation", map->saturation}};
}

Json streamToJson(const StreamMetadata& stream) {
  return {{"name", stream.name},
          {"topic", stream.topic},
          {"type", stream.type},
          {"frame_id", stream.frame_id},
          {"publishers", stream.publishers},
          {"stamped", stream.stamped},
          {"align", stream.align},
          {"latency", stream.latency},
          {"received", stream.received},
          {"used", stream.used},
          {"late", stream.late},
          {"dropped", stream.dropped},
          {"largest_gap", stream.largest_gap},
          {"receipt_delay",
           {{"min", stream.receipt_delay.min},
            {"median", stream.receipt_delay.median},
            {"max", stream.receipt_delay.max}}}};
}

Json faultToJson(const Fault& fault) {
  return {{"stamp", stampToJson(fault.stamp)},
          {"what", fault.what},
          {"count", fault.count},
          {"severity", fault.severity == Severity::error ? "error" : "warning"}};
}

template <typename Item, typename ToJson>
Json arrayOf(const std::vector<Item>& items, ToJson to_json) {
  Json array = Json::array();
  for (const Item& item : items) {
    array.push_back(to_json(item));
  }
  return array;
}

Json parametersToJson(const std::map<std::string, ParameterValue>& parameters) {
  Json object = Json::object();
  for (const auto& [name, value] : parameters) {
    object[name] = std::visit([](const auto& alternative) { return Json(alternative); }, value);
  }
  return object;
}

}  // namespace

Json toJson(const Metadata& metadata, const std::vector<Column>& columns) {
  std::vector<Column> with_time = {{"time", "s", Role::auxiliary, Interpolation::none, "stamp since the first row"}};
  with_time.insert(with_time.end(), columns.begin(), columns.end());

  Json json = Json::object();
  json["format"] = kSidecarFormat;
  json["id"] = metadata.id;
  json["channel"] = metadata.channel;
  json["task"] = metadata.task;
  json["operator"] = metadata.operator_name;
  json["outcome"] = metadata.outcome;
  json["notes"] = metadata.notes;
  json["status"] = metadata.status;
  json["start_stamp"] = stampToJson(metadata.start_stamp);
  json["duration"] = metadata.duration;
  json["rows"] = metadata.rows;
  json["columns"] = arrayOf(with_time, columnToJson);
  json["robot"] = robotToJson(metadata.robot);
  json["effort"] = effortToJson(metadata.effort);
  json["teleop_map"] = teleopMapToJson(metadata.teleop_map);
  json["streams"] = arrayOf(metadata.streams, streamToJson);
  json["counters"] = metadata.counters;
  json["faults"] = arrayOf(metadata.faults, faultToJson);
  json["parameters"] = parametersToJson(metadata.parameters);
  json["original_names"] = metadata.original_names;
  json["software"] = metadata.software;
  json["provenance"] = {{"parent", metadata.provenance.parent}, {"steps", metadata.provenance.steps}};
  for (const auto& [key, text] : metadata.other) {
    if (!json.contains(key)) {
      json[key] = Json::parse(text);
    }
  }
  return json;
}

std::string sidecarText(const Metadata& metadata, const std::vector<Column>& columns) {
  return toJson(metadata, columns).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace demo_logger
