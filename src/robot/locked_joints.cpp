#include "locked_joints.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "near_names.h"
#include "urdf_tree.h"

namespace demo_logger {

LockedJoints::LockedJoints(const urdf::ModelInterface& model, const std::vector<urdf::JointConstSharedPtr>& chain,
                           const std::map<std::string, double>& given)
    : model_(model), given_(given) {
  for (const auto& joint : chain) {
    if (!isMoving(*joint)) continue;
    moving_.insert(joint->name);
    if (joint->mimic) {
      throw ModelError("joint '" + joint->name + "' mimics joint '" + joint->mimic->joint_name +
                       "' and lies in the chain; every joint of an arm must move by itself");
    }
  }
  for (const auto& [name, position] : given) {
    if (!model.getJoint(name)) {
      std::vector<std::string> names;
      for (const auto& [known, joint] : model.joints_) names.push_back(known);
      throw ModelError("no joint '" + name + "' to lock in robot '" + model.getName() + "'; the nearest names are " +
                       nearNames(name, names));
    }
    if (moving_.count(name) != 0) {
      throw ModelError("joint '" + name + "' cannot be locked: it is one of the arm's moving joints");
    }
    if (!std::isfinite(position)) {
      throw ModelError("joint '" + name + "' cannot be locked at " + std::to_string(position) +
                       ", expected a finite position in rad or m");
    }
  }
}

double LockedJoints::position(const urdf::Joint& joint) const {
  const urdf::Joint* held = &joint;
  double multiplier = 1.0;
  double offset = 0.0;
  for (std::set<std::string> seen; seen.insert(held->name).second;) {
    refuseUnusableJoint(*held);
    if (const auto given = given_.find(held->name); given != given_.end()) return multiplier * given->second + offset;
    if (!isMoving(*held)) return offset;
    if (!held->mimic) {
      const bool limited = held->limits && held->type != urdf::Joint::CONTINUOUS;
      return multiplier * (limited ? std::clamp(0.0, held->limits->lower, held->limits->upper) : 0.0) + offset;
    }
    const std::string& master = held->mimic->joint_name;
    if (moving_.count(master) != 0) {
      throw ModelError("joint '" + held->name + "' beside the chain mimics joint '" + master +
                       "' of the arm, so what hangs from it cannot be lumped; lock it at a position to ignore that");
    }
    const auto next = model_.joints_.find(master);
    if (next == model_.joints_.end()) {
      throw ModelError("joint '" + held->name + "' mimics joint '" + master + "', which does not exist");
    }
    offset += multiplier * held->mimic->offset;
    multiplier *= held->mimic->multiplier;
    held = next->second.get();
  }
  throw ModelError("joint '" + joint.name + "' mimics itself by way of other joints");
}

}  // namespace demo_logger
