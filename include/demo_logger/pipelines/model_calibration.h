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

/// An arm with what a calibration says of it.
struct CalibratedArm {
  RobotDescription robot;
  Eigen::VectorXd torque_bias;  // per joint, to be subtracted from efforts measured at `side`
  std::string drives_side =
      "motor";  // efforts measured there show friction and motor inertia of the joints, others not
};

/// Bodies and payload by withBodies and withPayload, drives by withDrives; of an empty calibration the description as
/// it is. Throws ModelError for joints that are not the arm's, another tip, or masses that leave no possible body.
CalibratedArm calibrate(const RobotDescription& robot, const ModelCalibration& calibration);
/// The same by a file; without one (an empty path) as the URDF has it. Throws FileError, which names the file.
CalibratedArm calibrate(const RobotDescription& robot, const std::filesystem::path& file);

}  // namespace demo_logger
