#pragma once

#include <urdf_model/model.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace demo_logger {

/// Where the joints stay that do not move by the arm's own will: beside its chain, past its tip, between the root and
/// its base, and mimic joints in the chain whose master lies beside it.
/// A value given by the user wins; a mimic joint follows its master (multiplier × master + offset); the others are
/// held at 0, or at the limit nearest to 0.
class LockedJoints {
 public:
  /// `chain` holds the joints from base to tip. Throws ModelError if a given joint does not exist, moves by itself in
  /// the chain, or is not finite, and if two joints of the chain are coupled.
  LockedJoints(const urdf::ModelInterface& model, const std::vector<urdf::JointConstSharedPtr>& chain,
               const std::map<std::string, double>& given);

  /// True for the joints of the arm: all others are locked.
  bool isArmJoint(const urdf::Joint& joint) const { return arm_.count(joint.name) != 0; }

  /// [rad or m]; 0 for a fixed joint and one of the arm. Throws ModelError if it mimics a joint that is missing, or in
  /// turn this one; or if it is no joint to be held.
  double position(const urdf::Joint& joint) const;

  /// The joint of the arm that this one mimics, and so cannot be truly locked; empty if none.
  std::string armJointFollowedBy(const urdf::Joint& joint) const;

 private:
  struct Hold {
    double position = 0.0;
    std::string follows;
  };
  Hold holdOf(const urdf::Joint& joint) const;
  void refuseWhatCannotBeGiven(const std::vector<urdf::JointConstSharedPtr>& chain) const;

  const urdf::ModelInterface& model_;
  const std::map<std::string, double>& given_;
  std::set<std::string> arm_;
};

}  // namespace demo_logger
