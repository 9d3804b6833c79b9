#include "demo_logger/channels/teleop_map.h"

#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr int kOutputs = 6;  // of a twist, and of a position with a rotation vector

[[noreturn]] void refuse(const std::string& field, const std::string& found, const std::string& expected) {
  throw ConfigurationError("teleoperation map: " + field + " is " + found + ", expected " + expected + ".");
}

void requireFinite(const std::string& field, const Eigen::MatrixXd& values) {
  if (!values.allFinite()) refuse(field, "not finite", "numbers");
}

void validate(const TeleopMapConfiguration& map) {
  const auto rows = map.gain.rows();
  const auto columns = map.gain.cols();
  if (rows != kOutputs || columns == 0) {
    refuse("gain", std::to_string(rows) + " x " + std::to_string(columns),
           std::to_string(kOutputs) + " rows, one for each output, and a column for each input");
  }
  if (static_cast<Eigen::Index>(map.inputs.size()) != columns) {
    refuse("the list of inputs", std::to_string(map.inputs.size()) + " names long",
           std::to_string(columns) + " as the gain has columns");
  }
  if (static_cast<Eigen::Index>(map.outputs.size()) != rows) {
    refuse("the list of outputs", std::to_string(map.outputs.size()) + " names long",
           std::to_string(rows) + " as the gain has rows");
  }
  if (map.offset.size() != rows) {
    refuse("offset", std::to_string(map.offset.size()) + " numbers long",
           std::to_string(rows) + " as the gain has rows");
  }
  if (map.saturation.size() != 0 && map.saturation.size() != rows) {
    refuse("saturation", std::to_string(map.saturation.size()) + " numbers long",
           std::to_string(rows) + " as the gain has rows, or none");
  }
  requireFinite("gain", map.gain);
  requireFinite("offset", map.offset);
  if (!std::isfinite(map.dead_zone) || map.dead_zone < 0.0) {
    refuse("dead_zone", print(map.dead_zone), "a number of at least 0 in the unit of the device");
  }
  for (Eigen::Index i = 0; i < map.saturation.size(); ++i) {
    if (std::isnan(map.saturation[i]) || map.saturation[i] <= 0.0) {
      refuse("saturation of " + map.outputs[static_cast<std::size_t>(i)], print(map.saturation[i]),
             "a positive magnitude");
    }
  }
}

}  // namespace

TeleopMap::TeleopMap(TeleopMapConfiguration configuration) : configuration_(std::move(configuration)) {
  validate(configuration_);
}

TeleopOutput TeleopMap::map(const Eigen::VectorXd& reading) const {
  TeleopOutput output;
  Eigen::VectorXd h = reading;
  for (double& component : h) {
    const bool dead = std::abs(component) <= configuration_.dead_zone || !std::isfinite(component);
    if (dead && component != 0.0) {
      component = 0.0;
      output.linear = false;
    }
  }
  output.value = configuration_.gain * h + configuration_.offset;
  for (Eigen::Index i = 0; i < configuration_.saturation.size(); ++i) {
    const double limit = configuration_.saturation[i];
    if (std::abs(output.value[i]) > limit) {
      output.value[i] = std::copysign(limit, output.value[i]);
      output.linear = false;
    }
  }
  return output;
}

TeleopMapMetadata TeleopMap::metadata() const {
  TeleopMapMetadata metadata;
  metadata.mode = configuration_.mode == TeleopMode::rate ? "rate" : "pose";
  metadata.inputs = configuration_.inputs;
  metadata.outputs = configuration_.outputs;
  for (const auto& row : configuration_.gain.rowwise()) metadata.gain.emplace_back(row.begin(), row.end());
  metadata.offset.assign(configuration_.offset.begin(), configuration_.offset.end());
  metadata.dead_zone = configuration_.dead_zone;
  metadata.saturation.assign(configuration_.saturation.begin(), configuration_.saturation.end());
  return metadata;
}

Eigen::Isometry3d toPose(const Eigen::VectorXd& output) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = output.head<3>();
  const Eigen::Vector3d rotation = output.tail<3>();
  const double angle = rotation.norm();
  if (angle > 0.0) pose.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  return pose;
}

}  // namespace demo_logger
