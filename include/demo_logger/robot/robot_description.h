#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace demo_logger {

/// Mass properties of a rigid body in the frame of its joint (link frame of the URDF).
struct BodyInertia {
  double mass = 0.0;                                  // [kg]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   // [m] of mass, in the link frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // [kg m²] about the centre of mass, axes of the link frame
};

enum class JointType { revolute, continuous, prismatic };

/// One moving joint of the chain with the body it moves. Every link fixed to that body, beside the chain or past the
/// tip, is lumped into it.
struct ArmJoint {
  std::string name;
  std::string link;  // child link
  JointType type = JointType::revolute;
  Eigen::Isometry3d X_parent_joint =
      Eigen::Isometry3d::Identity();  // pose at q = 0 in the previous moving link (the base for the first)
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();          // unit, in the joint frame
  double lower = -std::numeric_limits<double>::infinity();  // [rad or m], soft limits intersected with hard ones
  double upper = std::numeric_limits<double>::infinity();
  double velocity_limit = std::numeric_limits<double>::infinity();  // [rad/s or m/s]
  double effort_limit = std::numeric_limits<double>::infinity();    // [N m or N]
  double damping = 0.0;                                             // [N m s/rad or N s/m] viscous friction
  double friction = 0.0;                                            // [N m or N] Coulomb friction
  BodyInertia body;
  double friction_velocity = 0.0;  // [rad/s or m/s] v in Coulomb's friction · tanh(q̇ / v); 0: friction · sign(q̇)
  double motor_inertia = 0.0;      // [kg m² or kg] of motor and gears, as the joint feels it; URDF has no place for it
};

/// One arm as one chain of moving joints, base to tip, made once from a URDF and used by KDL and by Bullet alike.
struct RobotDescription {
  std::string name;
  std::string base;
  std::string tip;
  std::string urdf_sha256;  // of the text it was read from
  std::vector<ArmJoint> joints;
  Eigen::Isometry3d X_lastlink_tip = Eigen::Isometry3d::Identity();
  Eigen::Vector3d gravity{0.0, 0.0, -9.81};  // [m/s²] in the base frame: −z of the URDF root
  bool has_inertia = false;                  // every moving body has mass properties that one can compute with
  std::string inertia_fault;                 // why not, in one sentence; empty with has_inertia
  std::vector<std::string> warnings;         // what is doubtful though usable, a sentence each: inertias that no body
                                             // has, joints without a range

  std::vector<std::string> jointNames() const;
};

struct DescriptionOptions {
  std::string base;                      // empty: the root link
  std::string tip;                       // empty: the only leaf, else an error naming the leaves
  std::map<std::string, double> locked;  // side joints held elsewhere than 0 or the nearest limit [rad or m]
  double gravity = 9.81;                 // [m/s²] magnitude
};

/// Reads the URDF. Throws ModelError in one sentence: no such link, tip not below base, no moving joint between them,
/// floating or planar joint, zero axis, swapped limits, negative mass, mimic of a missing joint, malformed XML.
/// Only what moves with the chain, or turns its base, is judged. Missing or impossible inertia is no error here: it
/// waits in `inertia_fault` until dynamics are asked for, because kinematics work without.
/// A velocity or effort limit of 0 means that none was stated.
/// A mimic joint never moves by itself. In the chain, it is locked where its master beside the chain puts it; two
/// joints of the chain coupled to each other are refused. Beside the chain, one that follows a joint of the arm is held
/// where its master's 0 (or nearest limit) puts it, and what it carries waits in `inertia_fault`.
RobotDescription describeRobot(const std::string& urdf_xml, const DescriptionOptions& options);

/// As above from a file; FileError if it cannot be read. Messages name the file.
RobotDescription describeRobotFile(const std::string& path, const DescriptionOptions& options);

/// What moves one joint besides gravity and the bodies, as the joint feels it through its gears. What is absent stays
/// as the description has it.
struct JointDrive {
  std::optional<double> motor_inertia;      // [kg m² or kg]
  std::optional<double> damping;            // [N m s/rad or N s/m]
  std::optional<double> friction;           // [N m or N]
  std::optional<double> friction_velocity;  // [rad/s or m/s]
};

/// The same arm with other drives, by joint. Throws ModelError if a joint is not the arm's, or a value is negative or
/// not finite.
RobotDescription withDrives(const RobotDescription& description, const std::map<std::string, JointDrive>& drives);

/// The same arm with a load held at the tip, its mass properties in the tip frame. Throws ModelError if the load is
/// not physical (mass not positive, inertia against the triangle inequality).
RobotDescription withLoad(const RobotDescription& description, const BodyInertia& load);

}  // namespace demo_logger
