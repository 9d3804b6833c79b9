#include "demo_logger/robot/robot_description.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <system_error>
#include <utility>

#include "body_inertia.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "demo_logger/trajectory/regular_file.h"
#include "joint_named.h"
#include "locked_joints.h"
#include "sha256.h"
#include "urdf_reader.h"
#include "urdf_tree.h"

namespace demo_logger {
namespace {

struct PlacedLink {
  urdf::LinkConstSharedPtr link;
  Eigen::Isometry3d X_body_link;
  std::string not_rigid;  // why it does not truly move as one with the body; empty if it does
};

/// How a joint beside the chain moves after all; empty if it is truly locked.
std::string whyNotRigid(const urdf::Joint& joint, const LockedJoints& locked) {
  const std::string master = locked.armJointFollowedBy(joint);
  if (master.empty()) return {};
  return "joint '" + joint.name + "', which mimics joint '" + master + "' of the arm; lock '" + joint.name +
         "' at a position to ignore that";
}

/// Everything that moves as one with `first`: itself and all below it, except what lies beyond `next_joint`.
std::vector<PlacedLink> linksMovingWith(const urdf::LinkConstSharedPtr& first, const std::string& next_joint,
                                        const urdf::ModelInterface& model, const LockedJoints& locked) {
  std::vector<PlacedLink> body{{first, Eigen::Isometry3d::Identity(), {}}};
  for (std::size_t i = 0; i < body.size(); ++i) {
    const PlacedLink placed = body[i];
    for (const auto& joint : placed.link->child_joints) {
      if (joint->name == next_joint) continue;
      body.push_back({model.getLink(joint->child_link_name),
                      placed.X_body_link * childInParent(*joint, locked.position(*joint)),
                      placed.not_rigid.empty() ? whyNotRigid(*joint, locked) : placed.not_rigid});
    }
  }
  return body;
}

/// The lumped body of one moving joint. The whole is judged: it is what moves. What its parts lack or claim is kept as
/// the reason, or else as a warning.
BodyInertia lumpedBody(const std::vector<PlacedLink>& links, const std::string& joint,
                       const std::map<std::string, std::string>& unread_inertia, RobotDescription& description) {
  std::vector<std::string> faults, doubts;
  BodyInertia body;
  for (const auto& [link, X_body_link, not_rigid] : links) {
    const BodyInertia own = inertiaOf(*link);
    if (own.mass < 0.0) throw ModelError("link '" + link->name + "' has " + impossibility(own));
    if (const auto unread = unread_inertia.find(link->name); unread != unread_inertia.end()) {
      faults.push_back("link '" + link->name + "' has an <inertial> element that cannot be read: " + unread->second);
    }
    if (own.mass != 0.0 && !not_rigid.empty()) faults.push_back("link '" + link->name + "' hangs from " + not_rigid);
    if (const std::string doubt = implausibility(own); !doubt.empty()) {
      doubts.push_back("link '" + link->name + "' has " + doubt);
    }
    body = lumped(body, movedTo(X_body_link, own));
  }
  if (const std::string impossible = impossibility(body); !impossible.empty()) {
    faults.push_back(doubts.empty() ? "all that joint '" + joint + "' moves up to the next joint has " + impossible
                                    : doubts.front());
  } else if (body.mass == 0.0) {
    faults.push_back("nothing that joint '" + joint + "' moves has mass up to the next joint; give link '" +
                     links.front().link->name + "' an <inertial> element");
  }
  if (description.inertia_fault.empty() && !faults.empty()) description.inertia_fault = faults.front();
  description.warnings.insert(description.warnings.end(), doubts.begin(), doubts.end());
  return body;
}

/// Hard limits, narrowed by the safety controller's soft ones. urdfdom fills absent soft limits with 0, 0.
void readLimits(const urdf::Joint& joint, ArmJoint& arm_joint) {
  const auto stated = [](double limit) { return limit > 0.0 ? limit : std::numeric_limits<double>::infinity(); };
  if (joint.limits) {
    if (joint.limits->velocity < 0.0 || joint.limits->effort < 0.0) {
      throw ModelError("joint '" + joint.name + "' has a negative velocity or effort limit");
    }
    arm_joint.velocity_limit = stated(joint.limits->velocity);
    arm_joint.effort_limit = stated(joint.limits->effort);
  }
  if (joint.type == urdf::Joint::CONTINUOUS || !joint.limits) return;
  arm_joint.lower = joint.limits->lower;
  arm_joint.upper = joint.limits->upper;
  if (!joint.safety || (joint.safety->soft_lower_limit == 0.0 && joint.safety->soft_upper_limit == 0.0)) return;
  arm_joint.lower = std::max(arm_joint.lower, joint.safety->soft_lower_limit);
  arm_joint.upper = std::min(arm_joint.upper, joint.safety->soft_upper_limit);
  if (arm_joint.lower > arm_joint.upper) {
    std::ostringstream sentence;
    sentence << "joint '" << joint.name << "' has soft limits " << joint.safety->soft_lower_limit << " to "
             << joint.safety->soft_upper_limit << " that leave nothing of its hard limits " << joint.limits->lower
             << " to " << joint.limits->upper;
    throw ModelError(sentence.str());
  }
}

void readDynamics(const urdf::Joint& joint, ArmJoint& arm_joint) {
  if (!joint.dynamics) return;
  arm_joint.damping = joint.dynamics->damping;
  arm_joint.friction = joint.dynamics->friction;
  if (arm_joint.damping < 0.0 || arm_joint.friction < 0.0) {
    throw ModelError("joint '" + joint.name + "' has negative damping or friction, which would drive it");
  }
}

ArmJoint readArmJoint(const urdf::Joint& joint) {
  ArmJoint arm_joint;
  arm_joint.name = joint.name;
  arm_joint.link = joint.child_link_name;
  arm_joint.type = joint.type == urdf::Joint::PRISMATIC    ? JointType::prismatic
                   : joint.type == urdf::Joint::CONTINUOUS ? JointType::continuous
                                                           : JointType::revolute;
  arm_joint.axis = unitAxis(joint);
  readLimits(joint, arm_joint);
  readDynamics(joint, arm_joint);
  return arm_joint;
}

/// Rotation that turns root axes into base axes; if it is not constant, `fault` says why.
Eigen::Matrix3d rotationFromRootToBase(const urdf::ModelInterface& model, const urdf::LinkConstSharedPtr& base,
                                       const LockedJoints& locked, std::string& fault) {
  Eigen::Isometry3d X_root_base = Eigen::Isometry3d::Identity();
  for (const auto& joint : jointsBetween(model, model.getRoot(), base)) {
    X_root_base = X_root_base * childInParent(*joint, locked.position(*joint));
    const std::string not_rigid = whyNotRigid(*joint, locked);
    if (fault.empty() && !not_rigid.empty()) fault = "base '" + base->name + "' hangs from " + not_rigid;
  }
  return X_root_base.linear().transpose();
}

RobotDescription describeTree(const ParsedUrdf& parsed, const DescriptionOptions& options) {
  const urdf::ModelInterface& model = *parsed.model;
  const auto base = options.base.empty() ? model.getRoot() : findLink(model, options.base);
  const auto tip = options.tip.empty() ? onlyLeaf(model) : findLink(model, options.tip);
  const auto path = jointsBetween(model, base, tip);

  for (const auto& joint : path) refuseUnusableJoint(*joint);
  const LockedJoints locked(model, path, options.locked);
  std::vector<std::string> moving;
  for (const auto& joint : path) {
    if (locked.isArmJoint(*joint)) moving.push_back(joint->name);
  }
  if (moving.empty()) {
    throw ModelError("no moving joint between base '" + base->name + "' and tip '" + tip->name + "'");
  }

  RobotDescription description;
  description.name = model.getName();
  description.base = base->name;
  description.tip = tip->name;
  description.gravity = rotationFromRootToBase(model, base, locked, description.inertia_fault) *
                        Eigen::Vector3d(0.0, 0.0, -options.gravity);
  Eigen::Isometry3d X_body_link = Eigen::Isometry3d::Identity();  // along the path, since the last moving joint
  for (const auto& joint : path) {
    X_body_link = X_body_link * childInParent(*joint, locked.position(*joint));
    if (!X_body_link.matrix().allFinite()) {
      throw ModelError("joint '" + joint->name + "' lies too far away to be placed; look at its origin");
    }
    if (!locked.isArmJoint(*joint)) continue;
    ArmJoint arm_joint = readArmJoint(*joint);
    if (arm_joint.lower == arm_joint.upper) {
      const bool turns = arm_joint.type == JointType::revolute;
      description.warnings.push_back("joint '" + joint->name + "' cannot move, its limits are " +
                                     print(arm_joint.lower) + " to " + print(arm_joint.upper) +
                                     (turns ? " rad" : " m") + "; give <limit> lower and upper" +
                                     (turns ? ", or the joint the type continuous if it turns without end" : ""));
    }
    arm_joint.X_parent_joint = std::exchange(X_body_link, Eigen::Isometry3d::Identity());
    const std::size_t next = description.joints.size() + 1;
    arm_joint.body = lumpedBody(linksMovingWith(findLink(model, arm_joint.link),
                                                next < moving.size() ? moving[next] : std::string(), model, locked),
                                arm_joint.name, parsed.unread_inertia, description);
    description.joints.push_back(std::move(arm_joint));
  }
  description.X_lastlink_tip = X_body_link;
  description.has_inertia = description.inertia_fault.empty();
  return description;
}

/// `where` stands in front of every sentence.
RobotDescription describe(const std::string& where, const std::string& urdf_xml, const DescriptionOptions& options) {
  try {
    if (!std::isfinite(options.gravity)) throw ModelError("gravity must be a finite number of m/s²");
    RobotDescription description = describeTree(parseUrdf(urdf_xml), options);
    description.urdf_sha256 = sha256(urdf_xml);
    if (!description.has_inertia) description.inertia_fault = where + ": " + description.inertia_fault;
    for (std::string& warning : description.warnings) warning.insert(0, where + ": ");
    return description;
  } catch (const ModelError& error) {
    throw ModelError(where + ": " + error.what());
  }
}

}  // namespace

std::vector<std::string> RobotDescription::jointNames() const {
  std::vector<std::string> names;
  names.reserve(joints.size());
  for (const ArmJoint& joint : joints) names.push_back(joint.name);
  return names;
}

RobotDescription describeRobot(const std::string& urdf_xml, const DescriptionOptions& options) {
  return describe("robot description", urdf_xml, options);
}

RobotDescription describeRobotFile(const std::string& path, const DescriptionOptions& options) {
  std::error_code status;
  if (!std::filesystem::exists(path, status)) {
    throw FileError(path + ": no such file, expected a robot description (URDF)");
  }
  requireRegularFile(path, "a robot description (URDF)");
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw FileError(path + ": cannot be read, expected a robot description (URDF)");
  }
  const std::string urdf_xml{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return describe(path, urdf_xml, options);
}

RobotDescription withDrives(const RobotDescription& description, const std::map<std::string, JointDrive>& drives) {
  RobotDescription driven = description;
  for (const auto& [name, drive] : drives) {
    ArmJoint& joint = jointNamed(driven, name, "to drive");
    const auto set = [&name = name](const char* what, const std::optional<double>& given, double& value) {
      if (!given) return;
      if (!std::isfinite(*given) || *given < 0.0) {
        std::ostringstream sentence;
        sentence << "joint '" << name << "' cannot have the " << what << " " << *given << ", expected 0 or more";
        throw ModelError(sentence.str());
      }
      value = *given;
    };
    set("motor inertia", drive.motor_inertia, joint.motor_inertia);
    set("damping", drive.damping, joint.damping);
    set("friction", drive.friction, joint.friction);
    set("friction velocity", drive.friction_velocity, joint.friction_velocity);
  }
  return driven;
}

RobotDescription withLoad(const RobotDescription& description, const BodyInertia& load) {
  if (description.joints.empty()) throw ModelError("the load needs an arm with at least one joint");
  constexpr double kHeaviest = 1000.0;  // [kg] beyond that, and that far off, nothing moves an arm as an arm moves
  constexpr double kFarthest = 10.0;    // [m]
  const std::string impossible = load.mass == 0.0 ? "no mass" : impossibility(load);
  if (!impossible.empty()) throw ModelError("the load at tip '" + description.tip + "' has " + impossible);
  if (load.mass > kHeaviest) {
    throw ModelError("the load at tip '" + description.tip + "' has a mass of " + print(load.mass) +
                     " kg, expected at most " + print(kHeaviest) + " kg");
  }
  const double moment = kHeaviest * kFarthest * kFarthest;
  if (load.center.norm() > kFarthest || load.inertia.cwiseAbs().maxCoeff() > moment) {
    throw ModelError("the load at tip '" + description.tip + "' reaches " + print(load.center.norm()) +
                     " m away with moments of inertia up to " + print(load.inertia.cwiseAbs().maxCoeff()) +
                     " kg m², expected at most " + print(kFarthest) + " m and " + print(moment) + " kg m²");
  }
  RobotDescription loaded = description;
  BodyInertia& last = loaded.joints.back().body;
  last = lumped(last, movedTo(loaded.X_lastlink_tip, load));
  return loaded;
}

}  // namespace demo_logger
