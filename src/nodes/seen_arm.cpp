#include "src/nodes/seen_arm.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

bool take(const std::vector<double>& values, std::size_t index, double& value) {
  if (index >= values.size() || !std::isfinite(values[index])) return false;
  value = values[index];
  return true;
}

}  // namespace

std::optional<ArmState> SeenArm::read(const sensor_msgs::JointState& state, bool with_velocities) const {
  const std::vector<ArmJoint>& joints = model_.description().joints;
  ArmState seen{Eigen::VectorXd::Zero(model_.size()), Eigen::VectorXd::Zero(model_.size())};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto found = std::find(state.name.begin(), state.name.end(), joints[i].name);
    const auto index = static_cast<std::size_t>(found - state.name.begin());
    const auto j = static_cast<Eigen::Index>(i);
    if (found == state.name.end() || !take(state.position, index, seen.q[j])) return std::nullopt;
    if (with_velocities && !take(state.velocity, index, seen.dq[j])) return std::nullopt;
  }
  return seen;
}

std::string SeenArm::complaint(const std::string& topic, bool with_velocities) const {
  const RobotDescription& robot = model_.description();
  return topic + " lacks positions " + (with_velocities ? "or velocities " : "") + "of " + robot.name +
         ", expected all from " + robot.base + " to " + robot.tip + ".";
}

}  // namespace demo_logger
