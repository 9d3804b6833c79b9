#include "fit_findings.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kTold = 0.7;          // of the deviation before the data; what stays above it the data do not tell
constexpr double kSignificant = 13.3;  // χ² of four values that are zero exceeds it once in a hundred times
constexpr double kDoubtful = 3.0;      // deviations that a mass may be moved
constexpr double kNearest = 0.3;       // [m] a centre of mass with a mass that is not told is put that near

/// "0.301 ± 0.004": digits as the deviation has sense for.
std::string withDeviation(double value, double deviation) {
  const int decimals = deviation > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(deviation))), 0, 6) : 6;
  return print(value, decimals) + " ± " + print(deviation, decimals);
}

class Findings {
 public:
  Findings(const FitProblem& problem, const RidgeEstimate& estimate, FitResult& result)
      : problem_(problem), estimate_(estimate), result_(result) {}

  void describePayload() {
    const auto& C = estimate_.covariance.topLeftCorner<kWeightParameters, kWeightParameters>();
    const Eigen::Vector4d theta = estimate_.value.head<kWeightParameters>();
    if (problem_.prior().deviation.head<kWeightParameters>().isZero(0.0)) return;
    const bool mass_is_told = isTold(0);
    if (!mass_is_told && !isTold(1) && !isTold(2) && !isTold(3)) {
      say("payload: these motions tell neither its mass nor where it is; it stays as it was");
      return;
    }
    const Eigen::Matrix4d regular = C + 1e-18 * Eigen::Matrix4d::Identity();
    if (theta.dot(regular.ldlt().solve(theta)) < kSignificant) {
      say("payload: none to be seen beyond what the description has, " + withDeviation(theta[0], deviation(0)) + " kg");
      result_.calibration.payload.reset();
      return;
    }
    BodyInertia body = problem_.payload(estimate_.value);
    const double leverage = theta.tail<3>().norm();
    if (leverage > kNearest * std::abs(body.mass)) {
      const double mass = leverage / kNearest;
      if (std::abs(mass - theta[0]) > kDoubtful * deviation(0)) {
        describeLastBody(theta);
        return;
      }
      body.mass = mass;
      body.center = theta.tail<3>() / mass;
    }
    CalibratedBody payload = calibratedBody(body);
    payload.mass.deviation = deviation(0);
    std::string center;
    for (Index i = 0; i < 3; ++i) {
      // Of c = h / m.
      const double c = body.center[i];
      const double variance = (C(1 + i, 1 + i) - 2.0 * c * C(0, 1 + i) + c * c * C(0, 0)) / (body.mass * body.mass);
      payload.center[static_cast<std::size_t>(i)].deviation = std::sqrt(std::max(0.0, variance));
      center += (i == 0 ? "" : ", ") + withDeviation(c, payload.center[static_cast<std::size_t>(i)].deviation);
    }
    result_.calibration.payload = payload;
    say("payload: " + withDeviation(body.mass, deviation(0)) + " kg at (" + center + ") m in " + problem_.robot().tip +
        (mass_is_told ? "" : "; these motions tell hardly more of it than mass times leverage"));
  }

  /// A shift of the centre of mass that no payload near the tip explains.
  void describeLastBody(const Eigen::Vector4d& theta) {
    const ArmJoint& last = problem_.robot().joints.back();
    const Eigen::Isometry3d& X = problem_.robot().X_lastlink_tip;
    const double mass = last.body.mass + theta[0];
    BodyInertia body;
    body.mass = mass;
    body.center =
        (last.body.mass * last.body.center + theta[0] * X.translation() + X.linear() * theta.tail<3>()) / mass;
    body.inertia = last.body.inertia * (mass / last.body.mass);
    CalibratedBody& found = result_.calibration.bodies[last.name];
    found = calibratedBody(body);
    found.mass.deviation = deviation(0);
    for (Index i = 0; i < 3; ++i) found.center[static_cast<std::size_t>(i)].deviation = deviation(1 + i) / mass;
    result_.calibration.payload.reset();
    say("payload: rather another centre of mass of the last body: " + withDeviation(mass, deviation(0)) + " kg at (" +
        print(body.center.x(), 4) + ", " + print(body.center.y(), 4) + ", " + print(body.center.z(), 4) + ") m in " +
        last.link);
  }

  void describeBody(Index i) {
    constexpr Index kValues = LinearInertia::RowsAtCompileTime;
    const ArmJoint& joint = problem_.robot().joints[static_cast<std::size_t>(i)];
    const LinearInertia values =
        problem_.describedBodies().segment<kValues>(kValues * i) + estimate_.value.segment<kValues>(kValues * i);
    const auto C = estimate_.covariance.block<kValues, kValues>(kValues * i, kValues * i);
    Eigen::Matrix<double, kValues, kValues> slope;  // of (mass, centre, inertia about it)
    const auto aboutCenter = [](const LinearInertia& parameters) {
      const BodyInertia body = bodyInertia(parameters);
      const Eigen::Matrix3d& I = body.inertia;
      LinearInertia about;
      about << body.mass, body.center, I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2);
      return about;
    };
    for (Index k = 0; k < kValues; ++k) {
      constexpr double kAside = 1e-6;
      slope.col(k) = (aboutCenter(values + kAside * LinearInertia::Unit(k)) -
                      aboutCenter(values - kAside * LinearInertia::Unit(k))) /
                     (2.0 * kAside);
    }
    const LinearInertia deviations = (slope * C * slope.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
    CalibratedBody body = calibratedBody(bodyInertia(values));
    body.mass.deviation = deviations[0];
    for (std::size_t k = 0; k < 3; ++k) body.center[k].deviation = deviations[1 + static_cast<Index>(k)];
    for (std::size_t k = 0; k < 6; ++k) body.inertia[k].deviation = deviations[4 + static_cast<Index>(k)];
    result_.calibration.bodies[joint.name] = body;
    std::string center;
    for (std::size_t k = 0; k < 3; ++k) {
      center += (k == 0 ? "" : ", ") + withDeviation(body.center[k].value, body.center[k].deviation);
    }
    say(joint.link + ": " + withDeviation(body.mass.value, body.mass.deviation) + " kg at (" + center +
        ") m, where the description has " + print(joint.body.mass, 3) + " kg");
  }

  void describeJoint(Index i) {
    const ArmJoint& joint = problem_.robot().joints[static_cast<std::size_t>(i)];
    const char* const torque = joint.type == JointType::prismatic ? " N" : " N m";
    const char* const viscous = joint.type == JointType::prismatic ? " N s/m" : " N m s/rad";
    std::vector<std::string> told, untold;
    JointCalibration found = result_.calibration.joints[joint.name];
    if (result_.calibration.side == "link") {  // else the description's, which is that of the motors, would count
      if (!found.damping) found.damping.emplace();
      if (!found.friction) found.friction.emplace();
    }
    const auto describe = [&](Index which, const char* name, const char* unit, std::optional<CalibratedValue>& value) {
      const Index at = problem_.regression().indexOf(i, which);
      if (problem_.prior().deviation[at] == 0.0) return;
      if (!isTold(at)) {
        untold.emplace_back(name);
        return;
      }
      value = CalibratedValue{estimate_.value[at], deviation(at)};
      told.push_back(std::string(name) + " " + withDeviation(value->value, value->deviation) + unit);
    };
    describe(TorqueRegression::kBias, "torque bias", torque, found.torque_bias);
    describe(TorqueRegression::kDamping, "damping", viscous, found.damping);
    describe(TorqueRegression::kFriction, "friction", torque, found.friction);
    if (problem_.mayChooseFrictionVelocity(i) &&
        isTold(problem_.regression().indexOf(i, TorqueRegression::kFriction)) && problem_.frictionVelocity(i) > 0.0) {
      found.friction_velocity = problem_.frictionVelocity(i);
      told.back() += " x tanh(velocity / " + print(problem_.frictionVelocity(i)) + ")";
    }
    result_.calibration.joints[joint.name] = found;
    if (!told.empty()) say(joint.name + ": " + joined(told));
    if (!untold.empty()) {
      say(joint.name + " moves too little, or not alone enough, to tell " + joined(untold) + ": left as " +
          (untold.size() == 1 ? "it was" : "they were"));
    }
  }

 private:
  static std::string joined(const std::vector<std::string>& words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i) list += (i == 0 ? "" : ", ") + words[i];
    return list;
  }
  void say(const std::string& sentence) { result_.findings.push_back(sentence); }
  double deviation(Index at) const { return std::sqrt(std::max(0.0, estimate_.covariance(at, at))); }
  bool isTold(Index at) const { return deviation(at) < kTold * problem_.prior().deviation[at]; }

  const FitProblem& problem_;
  const RidgeEstimate& estimate_;
  FitResult& result_;
};

}  // namespace

void describeFit(const FitProblem& problem, const RidgeEstimate& estimate, const FitOptions& options,
                 const EffortMetadata& meaning, FitResult& result) {
  result.calibration = options.start;
  if (options.start.side != meaning.side) result.calibration.joints.clear();  // of other efforts
  result.calibration.side = meaning.side;
  result.calibration.tip = problem.robot().tip;
  Findings findings(problem, estimate, result);
  if (problem.hasFreeBodies()) {
    result.calibration.payload.reset();  // the last body has it
    for (Index i = 0; i < problem.regression().joints; ++i) findings.describeBody(i);
  } else {
    findings.describePayload();
  }
  for (Index i = 0; i < problem.regression().joints; ++i) findings.describeJoint(i);
  if (!problem.fitsFriction()) {
    result.findings.emplace_back(
        meaning.side == "link"
            ? "friction is not fitted: efforts measured at the links have that of the motors and gears behind them "
              "(--fit-friction fits what is left)"
            : "friction is not fitted, as asked: it stays as it was");
  }
}

}  // namespace demo_logger
