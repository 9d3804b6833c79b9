#include "demo_logger/simulation/simulated_arm.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "print.h"

namespace demo_logger {
namespace {

ArmState initialState(const RobotDescription& description, const SimulatedArmConfiguration& configuration) {
  const std::vector<double>& given = configuration.initial_position;
  const auto size = static_cast<Eigen::Index>(description.joints.size());
  if (!given.empty() && given.size() != description.joints.size()) {
    throw ConfigurationError("simulated arm: initial_position has " + std::to_string(given.size()) +
                             " numbers, expected " + std::to_string(size) + ", one for each joint.");
  }
  ArmState state{Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)};
  for (std::size_t i = 0; i < description.joints.size(); ++i) {
    const ArmJoint& joint = description.joints[i];
    double& position = state.q[static_cast<Eigen::Index>(i)];
    position = given.empty() ? std::clamp(0.0, joint.lower, joint.upper) : given[i];
    if (!std::isfinite(position) || position < joint.lower || position > joint.upper) {
      throw ConfigurationError("simulated arm: initial_position of " + joint.name + " is " +
                               printPosition(joint, position) + ", expected from " + print(joint.lower) + " to " +
                               printPosition(joint, joint.upper) + ".");
    }
  }
  return state;
}

}  // namespace

SimulatedArm::SimulatedArm(const RobotDescription& description, const SimulatedArmConfiguration& configuration)
    : description_(description),
      configuration_(configuration),
      initial_(initialState(description, configuration)),
      body_(description),
      controller_(description, configuration.controller, configuration.mode),
      sensors_(configuration.sensors) {
  if (configuration.substeps < 1 || configuration.substeps > 100) {
    throw ConfigurationError("simulated arm: substeps is " + std::to_string(configuration.substeps) +
                             ", expected from 1 to 100.");
  }
  body_.reset(initial_);
}

ArmTick SimulatedArm::tick(Nanoseconds now, const std::vector<ArmCommand>& commands) {
  ArmTick tick;
  tick.index = ticks_++;
  tick.stamp = now;
  tick.truth = body_.state();
  tick.applied = controller_.tick(now, tick.truth, commands);
  tick.reading = sensors_.read(tick.truth, tick.applied.torque);
  body_.step(tick.applied.torque, configuration_.controller.control_period, configuration_.substeps);
  return tick;
}

void SimulatedArm::reset() {
  body_.reset(initial_);
  controller_.reset();
}

}  // namespace demo_logger
