#include "demo_logger/pipelines/model_calibration.h"

#include <utility>

#include "demo_logger/robot/identified_arm.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {

BodyInertia CalibratedBody::body() const {
  BodyInertia result;
  result.mass = mass.value;
  for (Eigen::Index i = 0; i < 3; ++i) result.center[i] = center[static_cast<std::size_t>(i)].value;
  std::size_t entry = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) {
      result.inertia(i, j) = result.inertia(j, i) = inertia[entry++].value;
    }
  }
  return result;
}

CalibratedBody calibratedBody(const BodyInertia& body) {
  CalibratedBody result;
  result.mass.value = body.mass;
  for (Eigen::Index i = 0; i < 3; ++i) result.center[static_cast<std::size_t>(i)].value = body.center[i];
  std::size_t entry = 0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = i; j < 3; ++j) result.inertia[entry++].value = body.inertia(i, j);
  }
  return result;
}

RobotDescription CalibratedArm::seenAt(const std::string& side) const {
  RobotDescription seen = robot;
  if (side == "link") {
    for (ArmJoint& joint : seen.joints) joint.motor_inertia = joint.damping = joint.friction = 0.0;
  }
  return side == drives_side ? withDrives(seen, drives) : seen;
}

Eigen::VectorXd CalibratedArm::biasAt(const std::string& side) const {
  return side == drives_side ? torque_bias : Eigen::VectorXd::Zero(torque_bias.size());
}

bool CalibratedArm::knowsOnlyTheOtherSide(const std::string& side) const {
  return side != drives_side && !(drives.empty() && torque_bias.isZero(0.0));
}

CalibratedArm calibrate(const RobotDescription& robot, const std::filesystem::path& file) {
  if (file.empty()) return calibrate(robot, ModelCalibration());
  try {
    return calibrate(robot, readModelCalibration(file));
  } catch (const ModelError& error) {
    throw FileError(file.string() + ": " + error.what());
  }
}

CalibratedArm calibrate(const RobotDescription& robot, const ModelCalibration& calibration) {
  if (!calibration.tip.empty() && calibration.payload && calibration.tip != robot.tip) {
    throw ModelError("the model has a payload at tip '" + calibration.tip + "', but the tip of the arm is '" +
                     robot.tip + "'; choose the tip that the model was made for");
  }
  CalibratedArm arm;
  arm.drives_side = calibration.side;

  std::map<std::string, BodyInertia> bodies;
  for (const auto& [joint, body] : calibration.bodies) bodies[joint] = body.body();
  arm.robot = withBodies(robot, bodies);
  if (calibration.payload) arm.robot = withPayload(arm.robot, calibration.payload->body());

  const auto valueOf = [](const std::optional<CalibratedValue>& calibrated) {
    return calibrated ? std::optional<double>(calibrated->value) : std::nullopt;
  };
  for (const auto& [joint, found] : calibration.joints) {
    arm.drives[joint] = {valueOf(found.motor_inertia), valueOf(found.damping), valueOf(found.friction),
                         found.friction_velocity};
  }
  withDrives(arm.robot, arm.drives);  // refuses joints that are not the arm's

  arm.torque_bias = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot.joints.size()));
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const auto found = calibration.joints.find(robot.joints[i].name);
    if (found != calibration.joints.end() && found->second.torque_bias) {
      arm.torque_bias[static_cast<Eigen::Index>(i)] = found->second.torque_bias->value;
    }
  }
  return arm;
}

}  // namespace demo_logger
