#include "demo_logger/simulation/joint_sensors.h"

#include <cmath>
#include <string>

#include "demo_logger/trajectory/error.h"
#include "print.h"
#include "snapshot.h"

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
  require("velocity_cutoff", configuration.velocity_cutoff, "Hz");
  require("effort_noise", configuration.effort_noise, "N m or N");
  for (const double bias : configuration.position_bias) {
    if (!std::isfinite(bias)) {
      throw ConfigurationError("joint sensors: position_bias is " + print(bias) + " rad or m, expected a number.");
    }
  }
}

JointSensors::JointSensors(const SensorConfiguration& configuration, double period)
    : configuration_(configuration), period_(period), noise_(configuration.seed) {
  validate(configuration_);
}

JointReading JointSensors::read(const JointTruth& truth) {
  JointReading reading;
  reading.q = truth.state.q;
  for (std::size_t i = 0; i < configuration_.position_bias.size(); ++i) {
    reading.q[static_cast<Eigen::Index>(i)] += configuration_.position_bias[i];
  }
  reading.q = disturbed(reading.q, configuration_.position_noise);
  if (configuration_.position_resolution > 0.0) {
    for (double& position : reading.q) {
      position = std::round(position / configuration_.position_resolution) * configuration_.position_resolution;
    }
  }
  const Eigen::VectorXd velocity = configuration_.velocity_from_positions ? differenced(reading.q) : truth.state.dq;
  reading.dq = disturbed(velocity, configuration_.velocity_noise);
  const bool at_link = configuration_.effort_side == EffortSide::link;
  reading.effort = disturbed(at_link ? truth.link_torque : truth.motor_torque, configuration_.effort_noise);
  return reading;
}

/// The low-pass in the form that holds for any cut-off: v ← v + (1 − e^(−2π f h)) (Δq/h − v).
Eigen::VectorXd JointSensors::differenced(const Eigen::VectorXd& q) {
  constexpr double kTwoPi = 6.283185307179586;
  if (before_.size() == 0) {
    before_ = q;
    velocity_ = Eigen::VectorXd::Zero(q.size());
    return velocity_;
  }
  const Eigen::VectorXd difference = (q - before_) / period_;
  before_ = q;
  const double cutoff = configuration_.velocity_cutoff;
  const double share = cutoff > 0.0 ? 1.0 - std::exp(-kTwoPi * cutoff * period_) : 1.0;
  velocity_ += share * (difference - velocity_);
  return velocity_;
}

void JointSensors::exchange(Snapshot& snapshot) {
  noise_.exchange(snapshot);
  snapshot.valueOrNone("positions", before_);
  snapshot.valueOrNone("velocities", velocity_);
}

Eigen::VectorXd JointSensors::disturbed(const Eigen::VectorXd& truth, double deviation) {
  if (deviation == 0.0) return truth;
  Eigen::VectorXd values = truth;
  for (double& value : values) value += deviation * noise_.next();
  return values;
}

}  // namespace demo_logger
