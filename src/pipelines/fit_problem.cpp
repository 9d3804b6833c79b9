#include "fit_problem.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/robot/identified_arm.h"
#include "demo_logger/robot/robot_model.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

// What is thinkable before the data [deviation]; of a joint, in parts of its effort limit.
constexpr double kMass = 1.0;      // [kg]
constexpr double kLeverage = 0.1;  // [kg m]
constexpr double kBias = 0.02;
constexpr double kFriction = 0.05;
constexpr double kMassShare = 0.3;      // of a body's mass, if all bodies are free
constexpr double kAside = 0.03;         // [m] of its centre
constexpr double kUsualLimit = 50.0;    // [N m or N] where the description has none
constexpr double kUsualVelocity = 2.0;  // [rad/s or m/s] ditto
constexpr double kLeastLeft = 0.05;     // of the last body, whatever is taken away
constexpr double kStandstill = 0.0025;  // of the velocity limit, below which friction holds a joint
constexpr double kTurning = 0.1;        // [s] around a standstill, in which a step of friction is smoothed
constexpr double kSureVelocity = 4.0;   // deviations of a velocity that surely is one

double limitOf(double stated, double usual) { return std::isfinite(stated) && stated > 0.0 ? stated : usual; }

}  // namespace

FitProblem::FitProblem(const RobotDescription& robot, const FitOptions& options, const EffortMetadata& meaning,
                       TorqueEquations equations)
    : meaning_(meaning), equations_(std::move(equations)) {
  ModelCalibration known = options.start;
  known.payload.reset();
  robot_ = calibrate(robot, known).seenAt(meaning.side);
  if (!meaning.includes_gravity) robot_.gravity.setZero();  // compensated beside what the efforts say
  shows_drives_ = meaning.side == "motor" || options.start.side == "link";
  fits_friction_ = options.friction.value_or(meaning.side == "motor");
  regression_.joints = equations_.position.cols();
  setPrior(options);
  fillColumns();
  findWhatSays();
  assumePayload(prior_.mean);
}

void FitProblem::setPrior(const FitOptions& options) {
  const Index count = kWeightParameters + TorqueRegression::kOfJoint * regression_.joints;
  prior_.mean = prior_.deviation = Eigen::VectorXd::Zero(count);
  prior_.not_negative.assign(static_cast<std::size_t>(count), false);
  setPayloadPrior(options.start.payload);
  regression_.inertial.resize(0, kWeightParameters);  // indexOf counts on it
  setDrivePrior(options);
}

void FitProblem::setPayloadPrior(const std::optional<CalibratedBody>& start) {
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
  const bool start_counts = options.start.side == meaning_.side;
  for (Index i = 0; i < regression_.joints; ++i) {
    const ArmJoint& joint = robot_.joints[static_cast<std::size_t>(i)];
    const auto found = options.start.joints.find(joint.name);
    const JointCalibration start =
        start_counts && found != options.start.joints.end() ? found->second : JointCalibration();
    const double effort = limitOf(joint.effort_limit, kUsualLimit);
    const double velocity = limitOf(joint.velocity_limit, kUsualVelocity);
    const auto set = [&](Index which, double described, double deviation,
                         const std::optional<CalibratedValue>& calibrated) {
      const Index at = regression_.indexOf(i, which);
      prior_.mean[at] = calibrated ? calibrated->value : described;
      prior_.deviation[at] = calibrated ? calibrated->deviation : deviation;
      prior_.not_negative[static_cast<std::size_t>(at)] = which != TorqueRegression::kBias;
    };
    const double friction = fits_friction_ ? kFriction * effort : 0.0;
    set(TorqueRegression::kBias, 0.0, kBias * effort, start.torque_bias);
    set(TorqueRegression::kDamping, shows_drives_ ? joint.damping : 0.0, friction / velocity, start.damping);
    set(TorqueRegression::kFriction, shows_drives_ ? joint.friction : 0.0, friction, start.friction);
    friction_velocity_[i] = shows_drives_ ? joint.friction_velocity : 0.0;
    friction_velocity_is_known_.push_back(friction_velocity_[i] > 0.0);
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
  const double least = (kLeastLeft - 1.0) * robot_.joints.back().body.mass;
  body.mass = std::max(theta[0], least);
  body.inertia = body.mass > 0.0 ? payload_inertia_ : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
  if (body.mass != 0.0) body.center = theta.segment<3>(1) / body.mass;
  return body;
}

/// What the drives do not explain.
Eigen::VectorXd FitProblem::modelledTorque(const RobotModel& model, Index row) const {
  Eigen::VectorXd torque = model.inverseDynamics(equations_.position.row(row), equations_.velocity.row(row),
                                                 equations_.acceleration.row(row));
  if (!shows_drives_) return torque;
  for (Index i = 0; i < regression_.joints; ++i) {
    torque[i] += robot_.joints[static_cast<std::size_t>(i)].motor_inertia * equations_.acceleration(row, i);
  }
  return torque;
}

void FitProblem::assumePayload(const Eigen::VectorXd& theta) {
  if (hasFreeBodies()) return;
  constexpr double kFarthest = 1.0;  // [m] a centre beyond that tells of a mass that is not known yet
  const BodyInertia body = payload(theta);
  const bool is_usable = body.mass != 0.0 && body.center.norm() < kFarthest;
  const RobotModel model(is_usable ? withPayload(robot_, body) : robot_);
  const Index n = regression_.joints;
  Eigen::VectorXd assumed = Eigen::VectorXd::Zero(kWeightParameters);
  if (is_usable) assumed << body.mass, body.mass * body.center;
  regression_.unexplained.resize(equations_.rows(), n);
  for (Index k = 0; k < equations_.rows(); ++k) {
    const Eigen::VectorXd explained = modelledTorque(model, k) - regression_.inertial.middleRows(k * n, n) * assumed;
    regression_.unexplained.row(k) = equations_.effort.row(k) - explained.transpose();
  }
}

Eigen::VectorXd FitProblem::describedBodies() const {
  constexpr Index kValues = LinearInertia::RowsAtCompileTime;
  Eigen::VectorXd bodies(kValues * regression_.joints);
  for (Index i = 0; i < regression_.joints; ++i) {
    bodies.segment<kValues>(kValues * i) = linearInertia(robot_.joints[static_cast<std::size_t>(i)].body);
  }
  return bodies;
}

void FitProblem::freeBodies() {
  constexpr Index kValues = LinearInertia::RowsAtCompileTime;
  const Index n = regression_.joints;
  const Index rows = equations_.rows();
  const RobotModel described(robot_);
  for (Index k = 0; k < rows; ++k) {
    regression_.unexplained.row(k) = equations_.effort.row(k) - modelledTorque(described, k).transpose();
  }

  const auto drives = TorqueRegression::kOfJoint * n;
  const Prior before = prior_;
  prior_.mean = prior_.deviation = Eigen::VectorXd::Zero(kValues * n + drives);
  prior_.mean.tail(drives) = before.mean.tail(drives);
  prior_.deviation.tail(drives) = before.deviation.tail(drives);
  prior_.not_negative.assign(static_cast<std::size_t>(kValues * n), false);
  prior_.not_negative.insert(prior_.not_negative.end(), before.not_negative.begin() + kWeightParameters,
                             before.not_negative.end());
  regression_.inertial.resize(rows * n, kValues * n);
  for (Index i = 0; i < n; ++i) {
    InertiaRegressor body(robot_, static_cast<std::size_t>(i), Eigen::Isometry3d::Identity(), kValues);
    for (Index k = 0; k < rows; ++k) {
      body.evaluate(equations_.position.row(k), equations_.velocity.row(k), equations_.acceleration.row(k),
                    regression_.inertial.block(k * n, kValues * i, n, kValues));
    }
    const BodyInertia& described_body = robot_.joints[static_cast<std::size_t>(i)].body;
    const bool is_last = i + 1 == n;
    const double mass = described_body.mass + (is_last ? before.deviation[0] : 0.0);
    const double radius = described_body.center.norm() + kAside;
    auto deviation = prior_.deviation.segment<kValues>(kValues * i);
    deviation[0] = kMassShare * mass;
    deviation.segment<3>(1).setConstant(mass * kAside + kMassShare * mass * described_body.center.norm());
    deviation.tail<6>().setConstant(2.0 * mass * kAside * radius + kMassShare * described_body.inertia.trace());
    if (is_last) deviation.head<kWeightParameters>() += before.deviation.head<kWeightParameters>();
  }
}

Eigen::VectorXd FitProblem::usualTorque() const {
  const RobotModel model(robot_);
  const Index n = regression_.joints;
  Eigen::VectorXd modelled = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd measured = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd torque(n);
  for (Index k = 0; k < equations_.rows(); ++k) {
    model.inverseDynamics(equations_.position.row(k), equations_.velocity.row(k), equations_.acceleration.row(k),
                          torque);
    modelled += torque.cwiseAbs2();
    const Eigen::VectorXd effort = equations_.effort.row(k);
    if (effort.allFinite()) measured += effort.cwiseAbs2();
  }
  return (modelled.cwiseMax(measured) / static_cast<double>(std::max<Index>(1, equations_.rows()))).cwiseSqrt();
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
