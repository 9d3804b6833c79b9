#include "demo_logger/simulation/simulated_arm.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/quotation.h"
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
      body_(description, configuration.surroundings, configuration.integrator),
      controller_(description, configuration.controller, configuration.mode),
      sensors_(configuration.sensors, configuration.controller.control_period) {
  if (configuration.substeps < 1 || configuration.substeps > 100) {
    throw ConfigurationError("simulated arm: substeps is " + std::to_string(configuration.substeps) +
                             ", expected from 1 to 100.");
  }
  const std::size_t biases = configuration.sensors.position_bias.size();
  if (biases != 0 && biases != description.joints.size()) {
    throw ConfigurationError("simulated arm: position_bias has " + std::to_string(biases) + " numbers, expected " +
                             std::to_string(description.joints.size()) + ", one for each joint.");
  }
  if (configuration.integrator == Integrator::runge_kutta_4 && !configuration.surroundings.empty()) {
    throw ConfigurationError(
        "simulated arm: the reference mode knows no contact, expected neither a floor nor obstacles with it.");
  }
  body_.reset(initial_);
}

ArmTick SimulatedArm::tick(Nanoseconds now, const std::vector<ArmCommand>& commands) {
  ArmTick tick;
  tick.index = ticks_++;
  tick.stamp = now;
  tick.truth = body_.state();
  tick.applied = controller_.tick(now, tick.truth, commands);
  for (const std::string& refusal : std::exchange(refusals_, {})) {
    tick.applied.reason += (tick.applied.reason.empty() ? "" : "; ") + refusal;
  }
  wrenches_.erase(
      std::remove_if(wrenches_.begin(), wrenches_.end(), [&](const TimedWrench& timed) { return timed.until <= now; }),
      wrenches_.end());
  std::vector<LinkWrench> wrenches;
  for (const TimedWrench& timed : wrenches_) wrenches.push_back(timed.wrench);
  tick.external_torque = body_.externalTorque(wrenches);
  // Before the first step the arm rests on its motors: what they hold is what a sensor at the links reads.
  const bool moved = body_.linkTorque().size() > 0;
  tick.reading = sensors_.read({tick.truth, tick.applied.torque, moved ? body_.linkTorque() : tick.applied.torque});
  body_.step(tick.applied.torque, configuration_.controller.control_period, configuration_.substeps, wrenches);
  next_tick_ = now + fromSeconds(configuration_.controller.control_period);
  return tick;
}

std::string whyNotApplied(const LinkWrench& wrench) {
  constexpr double kStrongest = 1e4;  // [N or N m] enough to break any arm
  const double strength = std::max(wrench.force.cwiseAbs().maxCoeff(), wrench.torque.cwiseAbs().maxCoeff());
  if (!wrench.force.allFinite() || !wrench.torque.allFinite() || !wrench.point.allFinite()) {
    return "the wrench has a component that is not a number";
  }
  if (strength > kStrongest) {
    return "the wrench has a component of " + print(strength) + " N or N m, expected at most " + print(kStrongest);
  }
  return "";
}

std::string SimulatedArm::applyWrench(const LinkWrench& wrench, Nanoseconds until, const std::string& source) {
  std::string refusal = whyNotApplied(wrench);
  if (!refusal.empty()) return refusal;
  if (wrench.joint >= static_cast<int>(description_.joints.size())) {
    return "the wrench acts upon a link that this arm does not have";
  }
  const auto same = std::find_if(wrenches_.begin(), wrenches_.end(),
                                 [&](const TimedWrench& timed) { return !source.empty() && timed.source == source; });
  if (same != wrenches_.end()) {
    *same = {wrench, until, source};
    return "";
  }
  if (wrenches_.size() >= kMostWrenches) {
    return "more than " + std::to_string(kMostWrenches) + " wrenches would act at once; wait until some have ended";
  }
  wrenches_.push_back({wrench, until, source});
  return "";
}

std::vector<std::string> SimulatedArm::overlaps() const {
  constexpr double kVisible = 1e-5;  // [m]
  std::vector<std::string> sentences;
  for (const Contact& contact : body_.overlaps()) {
    const std::string& link = description_.joints[static_cast<std::size_t>(contact.joint)].link;
    const std::string obstacle =
        contact.obstacle < 0 ? "the floor" : "obstacles[" + std::to_string(contact.obstacle) + "]";
    const double depth = -contact.distance;
    sentences.push_back(link + (depth < kVisible ? " touches " : " is " + print(1e3 * depth, 1) + " mm inside ") +
                        obstacle +
                        ", which pushes it out; move that, or let the arm start elsewhere (initial_position).");
  }
  return sentences;
}

void SimulatedArm::refuse(const std::string& source, const std::string& why) {
  constexpr std::size_t kMost = 8;
  ++refused_;
  const std::string refusal = "refused" + (source.empty() ? "" : " from " + shortened(source)) + ": " + why;
  const bool known = std::find(refusals_.begin(), refusals_.end(), refusal) != refusals_.end();
  if (!known && refusals_.size() < kMost) refusals_.push_back(refusal);
}

void SimulatedArm::setLoad(const std::optional<BodyInertia>& load) {
  const RobotDescription loaded = load ? withLoad(description_, *load) : description_;
  body_.setDescription(loaded);
  controller_.setDescription(configuration_.load_declared ? loaded : description_);
  load_ = load;
}

void SimulatedArm::reset() {
  body_.reset(initial_);
  controller_.reset();
  sensors_.forgetPositions();
  wrenches_.clear();
}

}  // namespace demo_logger
