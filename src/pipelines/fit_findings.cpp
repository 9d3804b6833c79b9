#include "fit_findings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

using Index = Eigen::Index;

/// "0.301 ± 0.004": digits as the deviation has sense for.
std::string withDeviation(double value, double deviation) {
  const int decimals = deviation > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(deviation))), 0, 6) : 6;
  return print(value, decimals) + " ± " + print(deviation, decimals);
}

class Findings {
 public:
  Findings(const FitProblem& problem, const RidgeEstimate& estimate, const FitDecisions& decisions, FitResult& result)
      : problem_(problem), estimate_(estimate), decisions_(decisions), result_(result) {}

  void describePayload() {
    const CalibratedValue& seen = decisions_.seen_mass;
    switch (decisions_.payload) {
      case FitDecisions::Payload::untold:
        say("payload: these motions tell neither its mass nor where it is; it stays as it was");
        break;
      case FitDecisions::Payload::none:
        say("payload: none to be seen beyond what the description has, " + withDeviation(seen.value, seen.deviation) +
            " kg");
        result_.calibration.payload.reset();
        break;
      case FitDecisions::Payload::impossible:
        say("payload: what would explain the torques, " + withDeviation(seen.value, seen.deviation) +
            " kg, leaves no last body of " + print(problem_.robot().joints.back().body.mass) +
            " kg that there can be; it stays as it was. Are the masses of the description those of this arm, and the "
            "efforts those upon it, not their opposite?");
        break;
      case FitDecisions::Payload::at_tip:
        describePayloadAtTip();
        break;
      case FitDecisions::Payload::last_body:
        describeLastBody();
        break;
      case FitDecisions::Payload::in_bodies:
        result_.calibration.payload.reset();  // the last body has it
        for (Index i = 0; i < problem_.regression().joints; ++i) describeBody(i);
        break;
      case FitDecisions::Payload::undecided:
      case FitDecisions::Payload::stated:
        break;
    }
  }

  void describePayloadAtTip() {
    const auto& C = estimate_.covariance.topLeftCorner<kWeightParameters, kWeightParameters>();
    const BodyInertia body = problem_.payload(estimate_.value);
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
    const bool mass_is_told = isTold(problem_, estimate_, 0) && !decisions_.mass_is_replaced;
    say("payload: " + withDeviation(body.mass, deviation(0)) + " kg at (" + center + ") m in " + problem_.robot().tip +
        (mass_is_told ? "" : "; these motions tell hardly more of it than mass times leverage"));
  }

  /// A shift of the centre of mass that no payload near the tip explains.
  void describeLastBody() {
    const ArmJoint& last = problem_.robot().joints.back();
    const BodyInertia body = problem_.lastBody(estimate_.value);
    CalibratedBody& found = result_.calibration.bodies[last.name];
    found = calibratedBody(body);
    found.mass.deviation = deviation(0);
    for (Index i = 0; i < 3; ++i) {
      found.center[static_cast<std::size_t>(i)].deviation = deviation(1 + i) / body.mass;
    }
    result_.calibration.payload.reset();
    say("payload: rather another centre of mass of the last body: " + withDeviation(body.mass, deviation(0)) +
        " kg at (" + print(body.center.x(), 4) + ", " + print(body.center.y(), 4) + ", " + print(body.center.z(), 4) +
        ") m in " + last.link);
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
    std::vector<std::string> told, untold, stated;
    JointCalibration found = result_.calibration.joints[joint.name];
    const auto describe = [&](Index which, const char* name, const char* unit, std::optional<CalibratedValue>& value) {
      const Index at = problem_.regression().indexOf(i, which);
      if (problem_.thinkable().deviation[at] == 0.0) {
        const bool is_wanted = which == TorqueRegression::kBias || problem_.fitsFriction();
        if (value && is_wanted) stated.push_back(std::string(name) + " " + print(value->value) + unit);
        return false;
      }
      if (decisions_.left[static_cast<std::size_t>(at)]) {
        untold.emplace_back(name);
        return false;
      }
      value = CalibratedValue{estimate_.value[at], deviation(at)};
      told.push_back(std::string(name) + " " + withDeviation(value->value, value->deviation) + unit);
      return true;
    };
    describe(TorqueRegression::kBias, "torque bias", torque, found.torque_bias);
    describe(TorqueRegression::kDamping, "damping", viscous, found.damping);
    const bool has_friction = describe(TorqueRegression::kFriction, "friction", torque, found.friction);
    if (has_friction && problem_.mayChooseFrictionVelocity(i) && problem_.frictionVelocity(i) > 0.0) {
      found.friction_velocity = problem_.frictionVelocity(i);
      told.back() += " x tanh(velocity / " + print(problem_.frictionVelocity(i)) + ")";
    }
    result_.calibration.joints[joint.name] = found;
    if (!told.empty()) say(joint.name + ": " + joined(told));
    if (!stated.empty()) {
      say(joint.name + ": " + joined(stated) + (stated.size() == 1 ? " stays" : " stay") +
          ", as the model to start from states " + (stated.size() == 1 ? "it" : "them") + " without a deviation");
    }
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

  const FitProblem& problem_;
  const RidgeEstimate& estimate_;
  const FitDecisions& decisions_;
  FitResult& result_;
};

}  // namespace

void describeFit(const FitProblem& problem, const RidgeEstimate& estimate, const FitDecisions& decisions,
                 const FitOptions& options, const EffortMetadata& meaning, FitResult& result) {
  result.calibration = options.start;
  if (options.start.side != meaning.side) result.calibration.joints.clear();  // of other efforts
  result.calibration.side = meaning.side;
  result.calibration.tip = problem.robot().tip;
  Findings findings(problem, estimate, decisions, result);
  findings.describePayload();
  for (Index i = 0; i < problem.regression().joints; ++i) findings.describeJoint(i);
  if (!problem.fitsFriction()) {
    result.findings.emplace_back(
        meaning.side == "link" && !options.friction
            ? "friction is not fitted: efforts measured at the links have that of the motors and gears behind them "
              "(--fit-friction fits what is left)"
            : "friction is not fitted, as asked: it stays as it was");
  }
}

}  // namespace demo_logger
