#include "demo_logger/robot/identified_arm.h"
#include "demo_logger/robot/robot_model.h"
#include "fit_problem.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr Index kValues = LinearInertia::RowsAtCompileTime;

// What is thinkable before the data [deviation].
constexpr double kMassShare = 0.3;    // of a body's mass, if all bodies are free
constexpr double kAside = 0.03;       // [m] of its centre
constexpr double kLeastShare = 1e-4;  // of the usual deviation of a body's values, if one of them has any

/// Of the values in which inverse dynamics are linear; zero if the body is stated.
LinearInertia linearDeviation(const CalibratedBody& body) {
  constexpr double kStep = 1e-6;
  LinearInertia variance = LinearInertia::Zero();
  CalibratedBody other = body;
  const auto vary = [&](CalibratedValue& value) {
    if (value.deviation == 0.0) return;
    const double before = value.value;
    value.value = before + kStep;
    const LinearInertia above = linearInertia(other.body());
    value.value = before - kStep;
    const LinearInertia below = linearInertia(other.body());
    value.value = before;
    variance += ((above - below) * (value.deviation / (2.0 * kStep))).cwiseAbs2();
  };
  vary(other.mass);
  for (CalibratedValue& value : other.center) vary(value);
  for (CalibratedValue& value : other.inertia) vary(value);
  return variance.cwiseSqrt();
}

}  // namespace

Eigen::VectorXd FitProblem::describedBodies() const {
  Eigen::VectorXd bodies(kValues * regression_.joints);
  for (Index i = 0; i < regression_.joints; ++i) {
    bodies.segment<kValues>(kValues * i) = linearInertia(robot_.joints[static_cast<std::size_t>(i)].body);
  }
  return bodies;
}

void FitProblem::freeBodies() {
  const Index n = regression_.joints;
  const Index rows = equations_.rows();
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
    setBodyPrior(i);
  }
  if (start_.payload) robot_ = withPayload(robot_, start_.payload->body());
  prior_of_deviations_ = thinkable_ = prior_;
  const RobotModel described(robot_);
  for (Index k = 0; k < rows; ++k) {
    regression_.unexplained.row(k) = equations_.effort.row(k) - modelledTorque(described, k).transpose();
  }
}

/// Of a body of the start as it says, of another as is thinkable.
void FitProblem::setBodyPrior(Index joint) {
  const ArmJoint& described = robot_.joints[static_cast<std::size_t>(joint)];
  const bool is_last = joint + 1 == regression_.joints;
  const double mass = described.body.mass + (is_last ? thinkable_.deviation[0] : 0.0);
  const double distance = described.body.center.norm();
  LinearInertia usual;
  usual[0] = kMassShare * mass;
  usual.segment<3>(1).setConstant(mass * kAside + kMassShare * mass * distance);
  usual.tail<6>().setConstant(2.0 * mass * kAside * (distance + kAside) + kMassShare * described.body.inertia.trace());
  const auto found = start_.bodies.find(described.name);
  LinearInertia deviation = found != start_.bodies.end() ? linearDeviation(found->second) : usual;
  if (is_last) deviation.head<kWeightParameters>() += thinkable_.deviation.head<kWeightParameters>();
  if (!deviation.isZero(0.0)) deviation = deviation.cwiseMax(kLeastShare * usual);
  prior_.deviation.segment<kValues>(kValues * joint) = deviation;
}

}  // namespace demo_logger
