#include "src/nodes/teleop_parameters.h"

#include <array>
#include <utility>

namespace demo_logger {
namespace {

constexpr int kOutputs = 6;
constexpr double kMostButtons = 63.0;

const std::array<std::string, 3> kLinear{"x", "y", "z"};
const std::array<std::string, 3> kAngular{"roll", "pitch", "yaw"};  // rotations about x, y, z

bool isGroup(Parameters& parameters, const std::string& key) {
  const auto value = parameters.raw(key);
  return value && value->getType() == XmlRpc::XmlRpcValue::TypeStruct;
}

/// One number per direction: a group x, y, z (or roll, pitch, yaw), or a single number for `only`.
template <typename Number, typename Read>
std::array<Number, 3> readDirections(Parameters& parameters, const std::string& key,
                                     const std::array<std::string, 3>& names, const std::string& only, Number none,
                                     Read read) {
  std::array<Number, 3> values{none, none, none};
  if (!isGroup(parameters, key)) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (names[i] == only) values[i] = read(parameters, key);
    }
    return values;
  }
  Parameters group = parameters.group(key);
  for (std::size_t i = 0; i < 3; ++i) values[i] = read(group, names[i]);
  group.rejectUnknown();
  return values;
}

int readAxis(Parameters& parameters, const std::string& key) {
  return parameters.integer(key, -1, {-1.0, kMostButtons, ""});
}

/// A column of the gain for each axis in use.
void readAxesAndScales(Parameters& parameters, TeleoperationConfiguration& configuration) {
  const auto readScale = [](double fallback) {
    return [fallback](Parameters& from, const std::string& key) { return from.number(key, fallback); };
  };
  std::vector<std::pair<int, double>> of_output;  // axis and scale
  const auto add = [&](const std::string& kind, const std::array<std::string, 3>& names, const std::string& only,
                       double fallback) {
    const auto axes = readDirections(parameters, "axis_" + kind, names, only, -1, readAxis);
    const auto scales = readDirections(parameters, "scale_" + kind, names, only, fallback, readScale(fallback));
    for (std::size_t i = 0; i < 3; ++i) of_output.emplace_back(axes[i], scales[i]);
  };
  add("linear", kLinear, "x", 0.25);
  add("angular", kAngular, "yaw", 0.8);

  for (const auto& [axis, scale] : of_output) {
    if (axis >= 0) configuration.axes.push_back(axis);
  }
  configuration.map.gain = Eigen::MatrixXd::Zero(kOutputs, static_cast<Eigen::Index>(configuration.axes.size()));
  Eigen::Index column = 0;
  for (Eigen::Index output = 0; output < kOutputs; ++output) {
    const auto& [axis, scale] = of_output[static_cast<std::size_t>(output)];
    if (axis >= 0) configuration.map.gain(output, column++) = scale;
  }
}

void readGain(Parameters& parameters, TeleoperationConfiguration& configuration) {
  configuration.axes = parameters.integers("axes", {}, {0.0, kMostButtons, ""});
  const auto rows = parameters.matrix("gain", {});
  configuration.map.gain.resize(static_cast<Eigen::Index>(rows.size()),
                                rows.empty() ? 0 : static_cast<Eigen::Index>(rows.front().size()));
  for (Eigen::Index i = 0; i < configuration.map.gain.rows(); ++i) {
    const std::vector<double>& row = rows[static_cast<std::size_t>(i)];
    configuration.map.gain.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), configuration.map.gain.cols());
  }
}

Eigen::VectorXd readVector(Parameters& parameters, const std::string& key, const std::vector<double>& fallback) {
  const std::vector<double> values = parameters.numbers(key, fallback);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<std::string> outputNames(TeleopMode mode) {
  if (mode == TeleopMode::rate) return {"u_vx", "u_vy", "u_vz", "u_wx", "u_wy", "u_wz"};
  return {"target_pose_x", "target_pose_y", "target_pose_z", "target_pose_rx", "target_pose_ry", "target_pose_rz"};
}

template <typename Range>
XmlRpc::XmlRpcValue toList(const Range& range) {
  XmlRpc::XmlRpcValue list;
  list.setSize(static_cast<int>(range.size()));
  int i = 0;
  for (const auto& item : range) list[i++] = XmlRpc::XmlRpcValue(item);
  return list;
}

}  // namespace

TeleoperationConfiguration readTeleoperation(Parameters& parameters) {
  TeleoperationConfiguration configuration;
  configuration.map.mode =
      parameters.choice("mode", "rate", {"rate", "pose"}) == "rate" ? TeleopMode::rate : TeleopMode::pose;
  if (parameters.has("gain") || parameters.has("axes")) {
    readGain(parameters, configuration);
  } else {
    readAxesAndScales(parameters, configuration);
    if (configuration.axes.empty()) {
      throw ConfigurationError(
          parameters.fullName("axis_linear") +
          " and axis_angular name no axis of the device, expected at least one (config/teleop.yaml "
          "has an example), or axes and gain.");
    }
  }
  for (const int axis : configuration.axes) configuration.map.inputs.push_back("h_axis" + std::to_string(axis));
  configuration.map.outputs = outputNames(configuration.map.mode);
  configuration.map.offset = readVector(parameters, "offset", std::vector<double>(kOutputs, 0.0));
  configuration.map.dead_zone = parameters.number("dead_zone", 0.02, {0.0, 1.0, "of an axis"});
  configuration.map.saturation = readVector(parameters, "saturation", {});
  configuration.enable_button = parameters.integer("enable_button", 0, {-1.0, kMostButtons, ""});
  configuration.timeout = parameters.number("joy_timeout", 0.5, {0.01, 60.0, "s"});
  return configuration;
}

XmlRpc::XmlRpcValue toParameter(const TeleopMapMetadata& map) {
  XmlRpc::XmlRpcValue value;
  value["mode"] = map.mode;
  value["inputs"] = toList(map.inputs);
  value["outputs"] = toList(map.outputs);
  value["gain"].setSize(static_cast<int>(map.gain.size()));
  for (std::size_t i = 0; i < map.gain.size(); ++i) value["gain"][static_cast<int>(i)] = toList(map.gain[i]);
  value["offset"] = toList(map.offset);
  value["dead_zone"] = map.dead_zone;
  value["saturation"] = toList(map.saturation);
  return value;
}

}  // namespace demo_logger
