#include "locked_joints.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "near_names.h"
#include "urdf_tree.h"

namespace demo_logger {
namespace {

double neutral(const urdf::Joint& joint) {
  const bool limited = joint.limits && joint.type != urdf::Joint::CONTINUOUS;
  return limited ? std::clamp(0.0, joint.limits->lower, joint.limits->upper) : 0.0;
}

}  // namespace

LockedJoints::LockedJoints(const urdf::ModelInterface& model, const std::vector<urdf::JointConstSharedPtr>& chain,
                           const std::map<std::string, double>& given)
    : model_(model), given_(given) {
  for (const auto& joint : chain) {
    if (isMoving(*joint) && !joint->mimic) arm_.insert(joint->name);
  }
  refuseWhatCannotBeGiven(chain);
  for (const auto& joint : chain) {
    const std::string master = armJointFollowedBy(*joint);
    if (master.empty()) continue;
    throw ModelError("joint '" + joint->name + "' mimics joint '" + master +
                     "', and both lie in the chain; every joint of an arm must move by itself: choose a base or tip "
                     "with only one of them between, or lock '" +
                     joint->name + "' at a position");
  }
}

void LockedJoints::refuseWhatCannotBeGiven(const std::vector<urdf::JointConstSharedPtr>& chain) const {
  for (const auto& [name, position] : given_) {
    if (!model_.getJoint(name)) {
      std::vector<std::string> names;
      for (const auto& [known, joint] : model_.joints_) names.push_back(known);
      throw ModelError("no joint '" + name + "' to lock in robot '" + model_.getName() + "'; the nearest names are " +
                       nearNames(name, names));
    }
    const bool arm_joint = std::any_of(chain.begin(), chain.end(), [&name = name, this](const auto& joint) {
      return joint->name == name && isArmJoint(*joint);
    });
    if (arm_joint) {
      throw ModelError("joint '" + name + "' cannot be locked: it is one of the arm's moving joints");
    }
    if (!std::isfinite(position)) {
      throw ModelError("joint '" + name + "' cannot be locked at " + print(position) +
                       ", expected a finite position in rad or m");
    }
  }
}

double LockedJoints::position(const urdf::Joint& joint) const {
  return isArmJoint(joint) ? 0.0 : holdOf(joint).position;
}

std::string LockedJoints::armJointFollowedBy(const urdf::Joint& joint) const {
  return isArmJoint(joint) ? std::string() : holdOf(joint).follows;
}

LockedJoints::Hold LockedJoints::holdOf(const urdf::Joint& joint) const {
  const urdf::Joint* held = &joint;
  double multiplier = 1.0;
  double offset = 0.0;
  for (std::set<std::string> seen; seen.insert(held->name).second;) {
    refuseUnusableJoint(*held);
    if (const auto given = given_.find(held->name); given != given_.end()) {
      return {multiplier * given->second + offset, {}};
    }
    if (!isMoving(*held)) return {offset, {}};
    if (!held->mimic) return {multiplier * neutral(*held) + offset, isArmJoint(*held) ? held->name : std::string()};

    const std::string& master = held->mimic->joint_name;
    const auto next = model_.joints_.find(master);
    if (next == model_.joints_.end()) {
      throw ModelError("joint '" + held->name + "' mimics joint '" + master + "', which does not exist; lock '" +
                       held->name + "' at a position to ignore that");
    }
    offset += multiplier * held->mimic->offset;
    multiplier *= held->mimic->multiplier;
    held = next->second.get();
  }
  throw ModelError("joint '" + joint.name + "' mimics itself by way of other joints");
}

}  // namespace demo_logger
