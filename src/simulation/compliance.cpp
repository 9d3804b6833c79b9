#include "demo_logger/simulation/compliance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "print.h"

namespace demo_logger {
namespace {

/// In [0, 1)ⁿ, the k-th point of the additive recurrence whose ratios are the powers of the root of xⁿ⁺¹ = x + 1, which
/// generalise the golden ratio: as far from each other as can be in n dimensions.
class EvenSequence {
 public:
  explicit EvenSequence(Eigen::Index dimensions) : steps_(dimensions) {
    double root = 1.5;
    for (int i = 0; i < 60; ++i) root = std::pow(1.0 + root, 1.0 / (static_cast<double>(dimensions) + 1.0));
    for (Eigen::Index i = 0; i < dimensions; ++i) steps_[i] = std::pow(root, -static_cast<double>(i + 1));
  }

  Eigen::VectorXd point(int k) const {
    const Eigen::VectorXd sum = (static_cast<double>(k) * steps_).array() + 0.5;
    return sum.array() - sum.array().floor();
  }

 private:
  Eigen::VectorXd steps_;
};

Eigen::MatrixXd inertia(const RobotModel& model, const Eigen::VectorXd& q) {
  Eigen::MatrixXd M = model.massMatrix(q);
  const std::vector<ArmJoint>& joints = model.description().joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    M(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += joints[i].motor_inertia;
  }
  return M;
}

const char* stiffnessUnit(const ArmJoint& joint) { return joint.type == JointType::prismatic ? " N/m" : " N m/rad"; }
const char* dampingUnit(const ArmJoint& joint) { return joint.type == JointType::prismatic ? " N s/m" : " N m s/rad"; }

Eigen::VectorXd perJoint(const RobotDescription& arm, const char* name, const std::vector<double>& asked,
                         const Eigen::VectorXd& fallback) {
  if (asked.empty()) return fallback;
  const std::size_t joints = arm.joints.size();
  if (asked.size() != 1 && asked.size() != joints) {
    throw ConfigurationError(std::string("impedance: ") + name + " has " + std::to_string(asked.size()) +
                             " values, expected one for each of the " + std::to_string(joints) +
                             " joints, one for all of them, or none for the defaults.");
  }
  Eigen::VectorXd values(static_cast<Eigen::Index>(joints));
  for (std::size_t i = 0; i < joints; ++i) {
    values[static_cast<Eigen::Index>(i)] = asked.size() == 1 ? asked.front() : asked[i];
  }
  return values;
}

void requireRange(const RobotDescription& arm, const char* name, const Eigen::VectorXd& values,
                  const char* (*unit)(const ArmJoint&)) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values[i] >= 0.0 && values[i] <= kLargestGain) continue;
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
    throw ConfigurationError(std::string("impedance: ") + name + " of " + joint.name + " is " + print(values[i]) +
                             unit(joint) + ", expected a number from 0 to " + print(kLargestGain) + unit(joint) + ".");
  }
}

void requireRange(const RobotDescription& arm, const ImpedanceGains& gains) {
  requireRange(arm, "stiffness", gains.stiffness, stiffnessUnit);
  requireRange(arm, "damping", gains.damping, dampingUnit);
}

/// The joint that the fastest motion against the damping moves most, counted by what its damper takes from it.
std::size_t worstDamped(const ImpedanceGains& gains, const Eigen::MatrixXd& M) {
  const Eigen::MatrixXd K_d = gains.damping.asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K_d, M);
  const Eigen::VectorXd mode = modes.eigenvectors().rightCols<1>();
  Eigen::Index worst = 0;
  mode.cwiseAbs2().cwiseProduct(gains.damping).maxCoeff(&worst);
  return static_cast<std::size_t>(worst);
}

void refuseDamping(const ImpedanceGains& gains, const RobotDescription& arm, std::size_t worst, double rate, double h) {
  const ArmJoint& joint = arm.joints[worst];
  const double damping = gains.damping[static_cast<Eigen::Index>(worst)];
  const double bound = damping / (rate * h);  // if all are made smaller alike, λmax goes with them
  throw ConfigurationError("impedance: damping of " + joint.name + " is " + print(damping) + dampingUnit(joint) +
                           ", expected at most " + print(bound) + dampingUnit(joint) + ": λmax(M⁻¹ K_d) reaches " +
                           print(rate) + " 1/s within the joints' limits, beyond the " + print(1.0 / h) +
                           " 1/s of the control rate. Try " + print(0.8 * bound) + dampingUnit(joint) +
                           ", or a higher control rate.");
}

double dampingRate(const ImpedanceGains& gains, const Eigen::MatrixXd& M) {
  const Eigen::MatrixXd K_d = gains.damping.asDiagonal();
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K_d, M, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// The largest share s of the stiffness whose damping s h K_p fits beside the present one: as λmax(M⁻¹ (A + B)) is at
/// most the sum of both, adding it, at one joint or at all, stays within 1/h. `rate` is that of the present damping.
double dampableShare(const ImpedanceGains& gains, const RobotModel& model, const std::vector<Eigen::VectorXd>& postures,
                     double rate, double h) {
  constexpr double kMargin = 0.8;
  const double largest = gains.stiffness.maxCoeff();
  const ImpedanceGains pattern{gains.stiffness, gains.stiffness / largest};
  double per_damping = 0.0;
  for (const Eigen::VectorXd& q : postures)
    per_damping = std::max(per_damping, dampingRate(pattern, inertia(model, q)));
  return std::min(1.0, kMargin * std::max(0.0, 1.0 / h - rate) / per_damping / (h * largest));
}

/// What to try instead is taken if it is followed, at the one joint or at all.
std::string stiffnessAdvice(const ArmJoint& joint, double stiffness, double bound, double share, double h) {
  const std::string damping = print(share * h * stiffness) + dampingUnit(joint);
  if (share >= 1.0) return "Try a damping of " + damping + ".";
  const double least = 0.8 * bound;  // with the damping as it is
  if (least >= share * stiffness) return "Try a stiffness of " + print(least) + stiffnessUnit(joint) + ".";
  return "More damping alone would not do: try a stiffness of " + print(share * stiffness) + stiffnessUnit(joint) +
         " with a damping of " + damping + ".";
}

void refuseStiffness(const ImpedanceGains& gains, const RobotDescription& arm, double radius, double share, double h) {
  Eigen::Index worst = 0;
  // By the ratio: of differences between huge stiffnesses, rounding would leave nothing.
  (gains.stiffness.array() / gains.damping.array().max(std::numeric_limits<double>::min())).maxCoeff(&worst);
  const ArmJoint& joint = arm.joints[static_cast<std::size_t>(worst)];
  const double stiffness = gains.stiffness[worst];
  const double damping = gains.damping[worst];
  const double bound = 2.0 * damping / h;
  throw ConfigurationError("impedance: stiffness of " + joint.name + " is " + print(stiffness) + stiffnessUnit(joint) +
                           " with a damping of " + print(damping) + dampingUnit(joint) + ", expected at most " +
                           print(bound) + stiffnessUnit(joint) + ": the held spring would swing up, by a factor of " +
                           print(radius) + " each control period of " + print(h) + " s. " +
                           stiffnessAdvice(joint, stiffness, bound, share, h));
}

bool alwaysDampedEnough(const ImpedanceGains& gains, double h) {
  return (gains.damping.array() >= 0.5 * h * gains.stiffness.array()).all();
}

}  // namespace

std::vector<Eigen::VectorXd> judgedPostures(const RobotDescription& arm) {
  const auto n = static_cast<Eigen::Index>(arm.joints.size());
  const EvenSequence sequence(n);
  std::vector<Eigen::VectorXd> postures;
  for (int k = 0; k < kJudgedPostures; ++k) {
    Eigen::VectorXd q = sequence.point(k);
    for (Eigen::Index i = 0; i < n; ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
      const double reach = joint.type == JointType::prismatic ? 1.0 : M_PI;  // of a joint without limits
      const double lower = std::isfinite(joint.lower) ? joint.lower : std::min(-reach, joint.upper - 2.0 * reach);
      const double upper = std::isfinite(joint.upper) ? joint.upper : lower + 2.0 * reach;
      q[i] = lower + q[i] * (upper - lower);
    }
    postures.push_back(q);
  }
  return postures;
}

ImpedanceGains impedanceGains(const RobotDescription& arm, const std::vector<double>& stiffness,
                              const std::vector<double>& damping, const ImpedanceGains& defaults) {
  ImpedanceGains gains{perJoint(arm, "stiffness", stiffness, defaults.stiffness),
                       perJoint(arm, "damping", damping, defaults.damping)};
  requireRange(arm, gains);
  return gains;
}

ImpedanceGains defaultImpedanceGains(const RobotDescription& arm, double control_period) {
  constexpr double kFrequency = 4.0;     // [rad/s]
  constexpr double kDampingRatio = 0.7;  // as much of the critical damping
  constexpr double kShareOfRate = 0.5;   // of the 1/h that the damping may reach
  const RobotModel model(arm);
  std::vector<Eigen::MatrixXd> inertias;
  for (const Eigen::VectorXd& q : judgedPostures(arm)) inertias.push_back(inertia(model, q));
  Eigen::VectorXd felt = Eigen::VectorXd::Zero(model.size());  // in the mean
  for (const Eigen::MatrixXd& M : inertias) felt += M.diagonal() / static_cast<double>(inertias.size());

  Eigen::VectorXd heaviest = felt;  // of the joints of this kind, as masses and moments do not compare
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    for (std::size_t k = 0; k < arm.joints.size(); ++k) {
      if ((arm.joints[i].type == JointType::prismatic) != (arm.joints[k].type == JointType::prismatic)) continue;
      double& most = heaviest[static_cast<Eigen::Index>(i)];
      most = std::max(most, felt[static_cast<Eigen::Index>(k)]);
    }
  }
  ImpedanceGains gains;
  gains.stiffness = kFrequency * kFrequency * felt.cwiseProduct(heaviest).cwiseSqrt();
  gains.damping = 2.0 * kDampingRatio * gains.stiffness.cwiseProduct(felt).cwiseSqrt();
  double rate = 0.0;
  for (const Eigen::MatrixXd& M : inertias) rate = std::max(rate, dampingRate(gains, M));
  gains.damping *= std::min(1.0, kShareOfRate / (rate * control_period));
  gains.stiffness = gains.stiffness.cwiseMin(gains.damping / control_period);
  return gains;
}

void requireStable(const ImpedanceGains& gains, const RobotDescription& arm, double control_period,
                   const Eigen::VectorXd& also) {
  requireRange(arm, gains);
  const double h = control_period;
  const RobotModel model(arm);
  std::vector<Eigen::VectorXd> postures = judgedPostures(arm);
  if (also.size() == model.size()) postures.push_back(also);
  double rate = 0.0;
  double radius = 0.0;
  std::size_t worst = 0;
  const bool enough = alwaysDampedEnough(gains, h);
  for (const Eigen::VectorXd& q : postures) {
    const Eigen::MatrixXd M = inertia(model, q);
    const double here = dampingRate(gains, M);
    if (!(here <= rate)) {
      rate = here;
      worst = worstDamped(gains, M);
    }
    if (std::isnan(rate)) break;  // of masses that cannot be reckoned with: refused
    if (enough || rate > 1.0 / h) continue;
    const ImpedanceStability stability = judgeStability(gains, M, h);
    if (!stability.stable) radius = std::max(radius, stability.spectral_radius);
  }
  if (!(rate <= 1.0 / h)) refuseDamping(gains, arm, worst, rate, h);
  if (radius > 0.0) refuseStiffness(gains, arm, radius, dampableShare(gains, model, postures, rate, h), h);
}

}  // namespace demo_logger
