#include "src/ros/teleop_map_parameter.h"

namespace demo_logger {
namespace {

void requireSize(const Parameters& parameters, const char* key, std::size_t found, std::size_t expected,
                 const char* of) {
  if (found != expected) {
    throw ConfigurationError(parameters.fullName(key) + " has " + std::to_string(found) + " entries, expected " +
                             std::to_string(expected) + ", one per " + of + ".");
  }
}

}  // namespace

TeleopMapMetadata parseTeleopMap(Parameters parameters) {
  TeleopMapMetadata map;
  map.mode = parameters.choice("mode", "rate", {"rate", "pose"});
  map.inputs = parameters.texts("inputs", {});
  map.outputs = parameters.texts("outputs", {});
  map.gain = parameters.matrix("gain", {});
  map.offset = parameters.numbers("offset", std::vector<double>(map.outputs.size(), 0.0));
  map.dead_zone = parameters.number("dead_zone", 0.0, {0.0, 1e9, ""});
  map.saturation = parameters.numbers("saturation", {});
  requireSize(parameters, "gain", map.gain.size(), map.outputs.size(), "output");
  if (!map.gain.empty()) {
    requireSize(parameters, "gain[0]", map.gain.front().size(), map.inputs.size(), "input");
  }
  requireSize(parameters, "offset", map.offset.size(), map.outputs.size(), "output");
  if (!map.saturation.empty()) {
    requireSize(parameters, "saturation", map.saturation.size(), map.outputs.size(), "output");
  }
  return map;
}

std::optional<TeleopMapMetadata> readTeleopMap(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParamCached("teleop_map", value)) {
    return std::nullopt;
  }
  return parseTeleopMap({node.resolveName("teleop_map"), value});
}

}  // namespace demo_logger
