#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// What an identification says of one quantity.
struct CalibratedValue {
  double value = 0.0;
  double deviation = 0.0;  // standard deviation; 0: stated, not fitted
};

/// Mass properties, each with its deviation: inertia is (xx, xy, xz, yy, yz, zz) about the centre of mass.
struct CalibratedBody {
  CalibratedValue mass;                    // [kg]
  std::array<CalibratedValue, 3> center;   // [m]
  std::array<CalibratedValue, 6> inertia;  // [kg m²]

  BodyInertia body() const;
};

/// As stated, without deviations.
CalibratedBody calibratedBody(const BodyInertia& body);

/// How the drive of one joint, and its torque reading, differ from the description. What is absent stays as it is
/// there.
struct JointCalibration {
  std::optional<CalibratedValue> torque_bias;    // [N m or N] what an effort reads where there is no torque
  std::optional<CalibratedValue> damping;        // [N m s/rad or N s/m] viscous friction
  std::optional<CalibratedValue> friction;       // [N m or N] Coulomb friction
  std::optional<double> friction_velocity;       // [rad/s or m/s] v in friction · tanh(q̇ / v)
  std::optional<CalibratedValue> motor_inertia;  // [kg m² or kg] as the joint feels it
};

/// How an arm differs from its URDF, as found by fitModel or written by hand. In a file (YAML, doc/file_format.md) the
/// names of the fields are the keys.
struct ModelCalibration {
  std::string tip;             // link whose frame the payload is given in; empty: the arm's own
  std::string side = "motor";  // motor or link, of the gears, where efforts were measured: biases, friction and motor
                               // inertia are those that such efforts show, and count for no others
  std::optional<CalibratedBody> payload;  // in the frame of the tip, beyond what the URDF has there; may be less
  std::map<std::string, JointCalibration> joints;
  std::map<std::string, CalibratedBody> bodies;  // by joint, instead of the URDF's, in the frame of the joint's link
};

/// Throws FileError naming the file, the line, the key, its value and what was expected: no such file, not YAML, an
/// unknown, missing or repeated key, a wrong type, a value out of range; also what is no regular file, larger than
/// 1 MB, or holds more than one YAML document.
ModelCalibration readModelCalibration(const std::filesystem::path& path);

/// As it stands in a file.
std::string textOf(const ModelCalibration& calibration);

/// Whole or not at all. Throws FileError if it cannot be written, or is there and `overwrite` is false.
void writeModelCalibration(const std::filesystem::path& path, const ModelCalibration& calibration,
                           bool overwrite = false);

/// An arm with what a calibration says of it. What its drives do depends on where one looks: efforts of the motors show
/// the friction and the motor inertia that the description has, or that a calibration of such efforts found instead;
/// efforts measured at the links show none but those that a calibration of such efforts found.
struct CalibratedArm {
  RobotDescription robot;                    // with its bodies and payload, and the description's drives
  std::map<std::string, JointDrive> drives;  // by joint, of the calibration
  Eigen::VectorXd torque_bias;               // per joint, of the calibration [N m or N]
  std::string drives_side = "motor";         // of the efforts that it was made of

  /// The arm with the drives that efforts measured at `side` show.
  RobotDescription seenAt(const std::string& side) const;
  /// What is to be subtracted from efforts measured at `side`.
  Eigen::VectorXd biasAt(const std::string& side) const;
  /// Whether drives or a bias are known of the other side only, so that nothing of them counts.
  bool knowsOnlyTheOtherSide(const std::string& side) const;
};

/// Bodies and payload by withBodies and withPayload; of an empty calibration the description as it is. Throws
/// ModelError for joints that are not the arm's, another tip, or masses that leave no possible body.
CalibratedArm calibrate(const RobotDescription& robot, const ModelCalibration& calibration);
/// The same by a file; without one (an empty path) as the URDF has it. Throws FileError, which names the file.
CalibratedArm calibrate(const RobotDescription& robot, const std::filesystem::path& file);

}  // namespace demo_logger
