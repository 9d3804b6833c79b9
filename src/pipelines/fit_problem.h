#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "demo_logger/pipelines/fit_model.h"
#include "inertia_regressor.h"
#include "torque_equations.h"
#include "torque_regression.h"

namespace demo_logger {

/// The equations of fitModel's comment for one arm: what is known of their parameters beforehand, their columns, and
/// how the payload's own inertia, which is not linear in m and m c, is taken into account.
class FitProblem {
 public:
  /// `side` of the gears where the efforts were measured.
  FitProblem(const RobotDescription& robot, const FitOptions& options, const EffortMetadata& meaning,
             TorqueEquations equations);

  const TorqueEquations& equations() const { return equations_; }
  const TorqueRegression& regression() const { return regression_; }
  const Prior& prior() const { return prior_; }
  const RobotDescription& robot() const { return robot_; }
  bool fitsFriction() const { return fits_friction_; }

  /// What a joint usually bears [N m or N], root mean square over all rows; what the sensors alone leave, ditto.
  Eigen::VectorXd usualTorque() const;
  Eigen::VectorXd noise() const;

  /// From now on what is to be found is not a payload, but by how much the ten mass properties of each body differ from
  /// the description's.
  void freeBodies();
  bool hasFreeBodies() const { return regression_.inertial.cols() > kWeightParameters; }
  /// Those of the description, one body after the other.
  Eigen::VectorXd describedBodies() const;

  /// Takes the inertia of a payload of these parameters for granted from now on.
  void assumePayload(const Eigen::VectorXd& theta);
  /// The velocity v of joint i, in sign(q̇) = tanh(q̇ / v); 0: a step.
  void assumeFrictionVelocity(Eigen::Index joint, double velocity);
  double frictionVelocity(Eigen::Index joint) const { return friction_velocity_[joint]; }
  bool mayChooseFrictionVelocity(Eigen::Index joint) const;
  /// Not held by friction: even if it has just turned round, which smears a step of friction over its neighbours.
  bool moves(Eigen::Index row, Eigen::Index joint) const;
  VelocitySign signAt(Eigen::Index row, Eigen::Index joint, double friction_velocity) const;

  /// The payload of these parameters, its mass at least what leaves some of the last body.
  BodyInertia payload(const Eigen::VectorXd& theta) const;

 private:
  void setPrior(const FitOptions& options);
  void setPayloadPrior(const std::optional<CalibratedBody>& start);
  void setDrivePrior(const FitOptions& options);
  void fillColumns();
  void findWhatSays();
  Eigen::VectorXd modelledTorque(const RobotModel& model, Eigen::Index row) const;

  RobotDescription robot_;  // with known bodies and drives of the start, without its payload
  EffortMetadata meaning_;
  TorqueEquations equations_;
  TorqueRegression regression_;
  Prior prior_;
  Eigen::VectorXd friction_velocity_;
  std::vector<bool> friction_velocity_is_known_;
  Eigen::Matrix3d payload_inertia_ = Eigen::Matrix3d::Zero();  // about its centre, where the start states it
  bool shows_drives_ = false;
  bool fits_friction_ = false;
};

}  // namespace demo_logger
