#pragma once

#include <urdf_model/model.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace demo_logger {

/// Where the joints stay that are not the arm's: beside its chain, past its tip, or between the root and its base.
/// A value given by the user wins; a mimic joint follows its master (multiplier × master + offset); the others are
/// held at 0, or at the limit nearest to 0.
class LockedJoints {
 public:
  /// `chain` holds the joints from base to tip. Throws ModelError if a given joint does not exist, moves with the
  /// chain, or is not finite, and if a joint of the chain mimics another.
  LockedJoints(const urdf::ModelInterface& model, const std::vector<urdf::JointConstSharedPtr>& chain,
               const std::map<std::string, double>& given);

  /// [rad or m]; 0 for a fixed joint. Throws ModelError if it mimics a joint that is missing, moves with the arm, or
  /// mimics in turn this one; or if it is no joint to be held.
  double position(const urdf::Joint& joint) const;

 private:
  const urdf::ModelInterface& model_;
  std::set<std::string> moving_;  // of the chain
  const std::map<std::string, double>& given_;
};

}  // namespace demo_logger
