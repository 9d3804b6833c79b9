#include "demo_logger/simulation/joint_sensors.h"

#include <cmath>
#include <string>

#include "demo_logger/trajectory/error.h"
#include "print.h"

namespace demo_logger {
namespace {

void require(const std::string& field, double value, const std::string& unit) {
  if (std::isfinite(value) && value >= 0.0) return;
  throw ConfigurationError("joint sensors: " + field + " is " + print(value) + " " + unit +
                           ", expected a number of at least 0.");
}

}  // namespace

void validate(const SensorConfiguration& configuration) {
  require("position_noise", configuration.position_noise, "rad or m");
  require("position_resolution", configuration.position_resolution, "rad or m");
  require("velocity_noise", configuration.velocity_noise, "rad/s or m/s");
  require("effort_noise", configuration.effort_noise, "N m or N");
}

JointSensors::JointSensors(const SensorConfiguration& configuration)
    : configuration_(configuration), noise_(configuration.seed) {
  validate(configuration_);
}

JointReading JointSensors::read(const ArmState& truth, const Eigen::VectorXd& effort) {
  JointReading reading;
  reading.q = disturbed(truth.q, configuration_.position_noise);
  if (configuration_.position_resolution > 0.0) {
    for (double& position : reading.q) {
      position = std::round(position / configuration_.position_resolution) * configuration_.position_resolution;
    }
  }
  reading.dq = disturbed(truth.dq, configuration_.velocity_noise);
  reading.effort = disturbed(effort, configuration_.effort_noise);
  return reading;
}

Eigen::VectorXd JointSensors::disturbed(const Eigen::VectorXd& truth, double deviation) {
  if (deviation == 0.0) return truth;
  Eigen::VectorXd values = truth;
  for (double& value : values) value += deviation * noise_.next();
  return values;
}

}  // namespace demo_logger
