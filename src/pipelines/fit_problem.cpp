#include "fit_problem.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/robot/identified_arm.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/not_a_number.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

// What is thinkable before the data [deviation]; of a joint, in parts of its effort limit.
constexpr double kMass = 1.0;      // [kg]
constexpr double kLeverage = 0.1;  // [kg m]
constexpr double kBias = 0.02;
constexpr double kFriction = 0.05;
constexpr double kUsualLimit = 50.0;    // [N m or N] where the description has none
constexpr double kUsualVelocity = 2.0;  // [rad/s or m/s] ditto
constexpr double kLeastLeft = 0.05;     // of the last body, whatever is taken away
constexpr double kStandstill = 0.0025;  // of the velocity limit, below which friction holds a joint
constexpr double kTurning = 0.1;        // [s] around a standstill, in which a step of friction is smoothed
constexpr double kResolution = 1e-5;    // of the effort limit; no sensor, and no recording, tells less
constexpr double kSureVelocity = 4.0;   // deviations of a velocity that surely is one

double limitOf(double stated, double usual) { return std::isfinite(stated) && stated > 0.0 ? stated : usual; }

}  // namespace

FitProblem::FitProblem(const RobotDescription& robot, const FitOptions& options, const EffortMetadata& meaning,
                       TorqueEquations equations)
    : start_(options.start), meaning_(meaning), equations_(std::move(equations)) {
  if (start_.side != meaning.side) start_.joints.clear();
  start_.side = meaning.side;
  ModelCalibration known = start_;
  known.payload.reset();
  robot_ = calibrate(robot, known).seenAt(meaning.side);
  if (!meaning.includes_gravity) robot_.gravity.setZero();  // compensated beside what the efforts say
  fits_friction_ = options.friction.value_or(meaning.side == "motor");
  regression_.joints = equations_.position.cols();
  setPrior(options);
  fillColumns();
  findWhatSays();
  if (start_.payload) payload_form_ = PayloadForm::at_tip;
  assumePayload(prior_.mean);
}

void FitProblem::setPrior(const FitOptions& options) {
  const Index count = kWeightParameters + TorqueRegression::kOfJoint * regression_.joints;
  prior_.mean = prior_.deviation = Eigen::VectorXd::Zero(count);
  prior_.not_negative.assign(static_cast<std::size_t>(count), false);
  setPayloadPrior();
  regression_.inertial.resize(0, kWeightParameters);  // indexOf counts on it
  setDrivePrior(options);
  prior_of_deviations_ = thinkable_ = prior_;
}

void FitProblem::setPayloadPrior() {
  const std::optional<CalibratedBody>& start = start_.payload;
  if (!start) {
    prior_.deviation.head<kWeightParameters>() << kMass, kLeverage, kLeverage, kLeverage;
    return;
  }
  const BodyInertia body = start->body();
  payload_inertia_ = body.inertia;
  prior_.mean[0] = body.mass;
  prior_.mean.segment<3>(1) = body.mass * body.center;
  prior_.deviation[0] = start->mass.deviation;
  for (Index i = 0; i < 3; ++i) {
    prior_.deviation[1 + i] = std::hypot(body.mass * start->center[static_cast<std::size_t>(i)].deviation,
                                         body.center[i] * start->mass.deviation);
  }
}

void FitProblem::setDrivePrior(const FitOptions& options) {
  friction_velocity_ = Eigen::VectorXd::Zero(regression_.joints);
  for (Index i = 0; i < regression_.joints; ++i) {
    const ArmJoint& joint = robot_.joints[static_cast<std::size_t>(i)];
    const auto found = start_.joints.find(joint.name);
    const JointCalibration start = found != start_.joints.end() ? found->second : JointCalibration();
    const double effort = limitOf(joint.effort_limit, kUsualLimit);
    const double velocity = limitOf(joint.velocity_limit, kUsualVelocity);
    const auto set = [&](Index which, double described, double usual_deviation,
                         const std::optional<CalibratedValue>& calibrated) {
      const Index at = regression_.indexOf(i, which);
      const bool is_friction = which != TorqueRegression::kBias;
      prior_.mean[at] = calibrated ? calibrated->value : described;
      double deviation = calibrated ? calibrated->deviation : usual_deviation;
      if (is_friction && !fits_friction_) deviation = 0.0;
      // A zero that nobody measured, as of a fit at the links that left friction out, is none that someone stated.
      const bool is_placeholder = calibrated && calibrated->value == 0.0 && calibrated->deviation == 0.0;
      if (is_friction && is_placeholder && options.friction == true) deviation = usual_deviation;
      prior_.deviation[at] = deviation;
      prior_.not_negative[static_cast<std::size_t>(at)] = is_friction;
    };
    const double friction = fits_friction_ ? kFriction * effort : 0.0;
    set(TorqueRegression::kBias, 0.0, kBias * effort, start.torque_bias);
    set(TorqueRegression::kDamping, joint.damping, friction / velocity, start.damping);
    set(TorqueRegression::kFriction, joint.friction, friction, start.friction);
    friction_velocity_[i] = joint.friction_velocity;
    const bool friction_is_free = prior_.deviation[regression_.indexOf(i, TorqueRegression::kFriction)] > 0.0;
    friction_velocity_is_known_.push_back(friction_velocity_[i] > 0.0 || !friction_is_free);
  }
}

bool FitProblem::mayChooseFrictionVelocity(Index joint) const {
  return fits_friction_ && !friction_velocity_is_known_[static_cast<std::size_t>(joint)];
}

VelocitySign FitProblem::signAt(Index row, Index joint, double friction_velocity) const {
  return signOf(equations_.velocity(row, joint), equations_.velocity_deviation(row, joint), friction_velocity);
}

void FitProblem::fillColumns() {
  const Index rows = equations_.rows();
  const Index n = regression_.joints;
  InertiaRegressor payload(robot_, robot_.joints.size() - 1, robot_.X_lastlink_tip, kWeightParameters);
  regression_.inertial.resize(rows * n, kWeightParameters);
  regression_.velocity = equations_.velocity;
  regression_.sign.resize(rows, n);
  for (Index k = 0; k < rows; ++k) {
    payload.evaluate(equations_.position.row(k), equations_.velocity.row(k), equations_.acceleration.row(k),
                     regression_.inertial.middleRows(k * n, n));
  }
  for (Index i = 0; i < n; ++i) assumeFrictionVelocity(i, friction_velocity_[i]);
}

void FitProblem::assumeFrictionVelocity(Index joint, double velocity) {
  friction_velocity_[joint] = velocity;
  for (Index k = 0; k < equations_.rows(); ++k) regression_.sign(k, joint) = signAt(k, joint, velocity).mean;
}

bool FitProblem::moves(Index row, Index joint) const {
  const double limit = limitOf(robot_.joints[static_cast<std::size_t>(joint)].velocity_limit, kUsualVelocity);
  return std::abs(equations_.velocity(row, joint)) >=
         std::max(kStandstill * limit, kSureVelocity * equations_.velocity_deviation(row, joint));
}

void FitProblem::findWhatSays() {
  const Index rows = equations_.rows();
  regression_.says.setConstant(rows, regression_.joints, true);
  for (Index i = 0; i < regression_.joints; ++i) {
    const bool has_friction = fits_friction_ || prior_.mean[regression_.indexOf(i, TorqueRegression::kFriction)] != 0.0;
    for (Index k = 0; k < rows; ++k) {
      if (std::isnan(equations_.effort(k, i))) regression_.says(k, i) = false;
      if (!has_friction || moves(k, i)) continue;
      const auto row = static_cast<std::size_t>(k);
      const auto isNear = [&](Index other) {
        const auto o = static_cast<std::size_t>(other);
        return equations_.range[o] == equations_.range[row] &&
               std::abs(equations_.time[o] - equations_.time[row]) <= kTurning;
      };
      for (Index near = k; near >= 0 && isNear(near); --near) regression_.says(near, i) = false;
      for (Index near = k; near < rows && isNear(near); ++near) regression_.says(near, i) = false;
    }
  }
}

BodyInertia FitProblem::payload(const Eigen::VectorXd& theta) const {
  BodyInertia body;
  body.mass = theta[0];
  body.inertia = body.mass > 0.0 ? payload_inertia_ : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  if (body.mass != 0.0) body.center = theta.segment<3>(1) / body.mass;
  return body;
}

BodyInertia FitProblem::lastBody(const Eigen::VectorXd& theta) const {
  const BodyInertia& described = robot_.joints.back().body;
  const Eigen::Isometry3d& X = robot_.X_lastlink_tip;
  BodyInertia body = described;
  body.mass += theta[0];
  body.center =
      (described.mass * described.center + theta[0] * X.translation() + X.linear() * theta.segment<3>(1)) / body.mass;
  if (described.mass > 0.0) body.inertia *= body.mass / described.mass;
  return body;
}

bool FitProblem::leavesALastBody(const Eigen::VectorXd& theta) const {
  constexpr double kFarthest = 1.0;  // [m]
  const BodyInertia& described = robot_.joints.back().body;
  const BodyInertia body = lastBody(theta);
  return body.mass > 0.0 && body.mass >= kLeastLeft * described.mass &&
         (body.center - described.center).norm() <= kFarthest;
}

/// What the drives do not explain.
Eigen::VectorXd FitProblem::modelledTorque(const RobotModel& model, Index row) const {
  Eigen::VectorXd torque = model.inverseDynamics(equations_.position.row(row), equations_.velocity.row(row),
                                                 equations_.acceleration.row(row));
  for (Index i = 0; i < regression_.joints; ++i) {
    torque[i] += robot_.joints[static_cast<std::size_t>(i)].motor_inertia * equations_.acceleration(row, i);
  }
  return torque;
}

void FitProblem::assumePayload(const Eigen::VectorXd& theta) {
  if (hasFreeBodies()) return;
  constexpr double kFarthest = 1.0;  // [m] a centre beyond that tells of a mass that is not known yet
  RobotDescription loaded = robot_;
  Eigen::VectorXd assumed = Eigen::VectorXd::Zero(kWeightParameters);
  const bool is_payload = payload_form_ == PayloadForm::at_tip && theta[0] != 0.0 &&
                          payload(theta).center.norm() < kFarthest && leavesALastBody(theta);
  if (is_payload) {
    loaded = withPayload(robot_, payload(theta));
    assumed = theta.head<kWeightParameters>();
  } else if (payload_form_ == PayloadForm::last_body && leavesALastBody(theta)) {
    loaded.joints.back().body = lastBody(theta);
    assumed = theta.head<kWeightParameters>();
  }
  const RobotModel model(loaded);
  const Index n = regression_.joints;
  regression_.unexplained.resize(equations_.rows(), n);
  for (Index k = 0; k < equations_.rows(); ++k) {
    const Eigen::VectorXd explained = modelledTorque(model, k) - regression_.inertial.middleRows(k * n, n) * assumed;
    regression_.unexplained.row(k) = equations_.effort.row(k) - explained.transpose();
  }
}

void FitProblem::leave(Index at, double value) {
  prior_.mean[at] = value;
  prior_.deviation[at] = 0.0;
  for (Index i = 0; i < regression_.joints; ++i) {
    if (at != regression_.indexOf(i, TorqueRegression::kFriction)) continue;
    assumeFrictionVelocity(i, robot_.joints[static_cast<std::size_t>(i)].friction_velocity);
    friction_velocity_is_known_[static_cast<std::size_t>(i)] = true;
  }
}

void FitProblem::dropPayload() {
  payload_form_ = PayloadForm::weight;
  for (Prior* prior : {&prior_, &prior_of_deviations_}) {
    prior->mean.head<kWeightParameters>().setZero();
    prior->deviation.head<kWeightParameters>().setZero();
  }
}

Eigen::VectorXd FitProblem::usualTorque() const {
  const RobotModel model(robot_);
  const Index n = regression_.joints;
  Eigen::VectorXd modelled = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd measured = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd torque(n);
  for (Index k = 0; k < equations_.rows(); ++k) {
    model.inverseDynamics(equations_.position.row(k), equations_.velocity.row(k), equations_.acceleration.row(k),
                          torque);
    modelled += torque.cwiseAbs2();
    for (Index i = 0; i < n; ++i) {
      const double effort = equations_.effort(k, i);
      if (std::isnan(effort)) continue;
      measured[i] += effort * effort;
      count[i] += 1.0;
    }
  }
  modelled /= static_cast<double>(std::max<Index>(1, equations_.rows()));
  return modelled.cwiseMax(measured.cwiseQuotient(count.cwiseMax(1.0))).cwiseSqrt();
}

Eigen::VectorXd FitProblem::resolution() const {
  Eigen::VectorXd resolution(regression_.joints);
  for (Index i = 0; i < regression_.joints; ++i) {
    resolution[i] = kResolution * limitOf(robot_.joints[static_cast<std::size_t>(i)].effort_limit, kUsualLimit);
  }
  return resolution;
}

std::vector<double> FitProblem::residual(const CalibratedArm& arm, const std::vector<bool>& rows) const {
  RobotDescription robot = arm.seenAt(meaning_.side);
  const Eigen::VectorXd bias = arm.biasAt(meaning_.side);
  if (!meaning_.includes_gravity) robot.gravity.setZero();
  const RobotModel model(robot);
  const Index n = regression_.joints;
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd torque(n);
  for (Index k = 0; k < equations_.rows(); ++k) {
    if (!rows[static_cast<std::size_t>(k)] || !regression_.says.row(k).any()) continue;
    model.inverseDynamics(equations_.position.row(k), equations_.velocity.row(k), equations_.acceleration.row(k),
                          torque);
    for (Index i = 0; i < n; ++i) {
      if (!regression_.says(k, i)) continue;
      const ArmJoint& joint = robot.joints[static_cast<std::size_t>(i)];
      torque[i] += bias[i] + joint.motor_inertia * equations_.acceleration(k, i) +
                   joint.damping * equations_.velocity(k, i) +
                   joint.friction * signAt(k, i, joint.friction_velocity).mean;
      squares[i] += std::pow(equations_.effort(k, i) - torque[i], 2);
      count[i] += 1.0;
    }
  }
  std::vector<double> result;
  for (Index i = 0; i < n; ++i) result.push_back(count[i] > 0.0 ? std::sqrt(squares[i] / count[i]) : kNaN);
  return result;
}

Eigen::VectorXd FitProblem::noise() const {
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(regression_.joints);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(regression_.joints);
  for (Index k = 0; k < equations_.rows(); ++k) {
    for (Index i = 0; i < regression_.joints; ++i) {
      if (std::isnan(equations_.noise_variance(k, i))) continue;
      variance[i] += equations_.noise_variance(k, i);
      count[i] += 1.0;
    }
  }
  return variance.cwiseQuotient(count.cwiseMax(1.0)).cwiseSqrt();
}

}  // namespace demo_logger
