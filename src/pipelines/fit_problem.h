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
  /// What the regression goes by: what was decided to stay has no deviation any more.
  const Prior& prior() const { return prior_; }
  /// What deviations go by: what stays only because the data do not tell it may still be anything.
  const Prior& priorOfDeviations() const { return prior_of_deviations_; }
  /// Before anything was decided.
  const Prior& thinkable() const { return thinkable_; }
  const RobotDescription& robot() const { return robot_; }
  bool fitsFriction() const { return fits_friction_; }

  /// What a joint usually bears [N m or N], root mean square over all rows; what the sensors alone leave, ditto; what
  /// is too little to be anything.
  Eigen::VectorXd usualTorque() const;
  Eigen::VectorXd noise() const;
  Eigen::VectorXd resolution() const;
  /// Per joint, root mean square over those of the rows that say something, of what an arm leaves unexplained, as
  /// addHumanTorque would have it; NaN: none does.
  std::vector<double> residual(const CalibratedArm& arm, const std::vector<bool>& rows) const;

  /// From now on what is to be found is not a payload, but by how much the ten mass properties of each body differ from
  /// the description's.
  void freeBodies();
  bool hasFreeBodies() const { return regression_.inertial.cols() > kWeightParameters; }
  /// Those of the description, one body after the other.
  Eigen::VectorXd describedBodies() const;

  /// What is made of the payload's parameters, m and m c.
  enum class PayloadForm {
    weight,    // nothing else: linear, and as honest about a mass of nearly nothing as about any other
    at_tip,    // a payload with its own inertia
    last_body  // another mass and centre of the last body, which keeps its shape
  };
  void setPayloadForm(PayloadForm form) { payload_form_ = form; }
  PayloadForm payloadForm() const { return payload_form_; }
  /// Takes the inertia that goes with these parameters for granted from now on.
  void assumePayload(const Eigen::VectorXd& theta);

  /// Parameter `at` stays at `value` from now on, because the data do not tell it, or not a better one that can be.
  void leave(Eigen::Index at, double value);
  /// There is no payload.
  void dropPayload();

  /// The velocity v of joint i, in sign(q̇) = tanh(q̇ / v); 0: a step.
  void assumeFrictionVelocity(Eigen::Index joint, double velocity);
  double frictionVelocity(Eigen::Index joint) const { return friction_velocity_[joint]; }
  bool mayChooseFrictionVelocity(Eigen::Index joint) const;
  /// Not held by friction: even if it has just turned round, which smears a step of friction over its neighbours.
  bool moves(Eigen::Index row, Eigen::Index joint) const;
  VelocitySign signAt(Eigen::Index row, Eigen::Index joint, double friction_velocity) const;

  /// The payload of these parameters; the last body with them; whether that can be: some of it left, and its centre not
  /// far from where it was.
  BodyInertia payload(const Eigen::VectorXd& theta) const;
  BodyInertia lastBody(const Eigen::VectorXd& theta) const;
  bool leavesALastBody(const Eigen::VectorXd& theta) const;

 private:
  void setPrior(const FitOptions& options);
  void setPayloadPrior();
  void setDrivePrior(const FitOptions& options);
  void setBodyPrior(Eigen::Index joint);
  void fillColumns();
  void findWhatSays();
  Eigen::VectorXd modelledTorque(const RobotModel& model, Eigen::Index row) const;

  ModelCalibration
      start_;  // without drives of efforts measured at the other side of the gears, which count for no others
  RobotDescription robot_;  // with known bodies and drives of the start, without its payload unless bodies are free
  EffortMetadata meaning_;
  TorqueEquations equations_;
  TorqueRegression regression_;
  Prior prior_, prior_of_deviations_, thinkable_;
  Eigen::VectorXd friction_velocity_;
  std::vector<bool> friction_velocity_is_known_;
  Eigen::Matrix3d payload_inertia_ = Eigen::Matrix3d::Zero();  // about its centre, where the start states it
  PayloadForm payload_form_ = PayloadForm::weight;
  bool fits_friction_ = false;
};

}  // namespace demo_logger
