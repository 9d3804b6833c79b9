#include "fit_decisions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace demo_logger {
namespace {

using Index = Eigen::Index;
using Payload = FitDecisions::Payload;

constexpr double kTold = 0.7;          // of the deviation before the data; what stays above it the data do not tell
constexpr double kSignificant = 13.3;  // χ² of four values that are zero exceeds it once in a hundred times
constexpr double kDoubtful = 3.0;      // deviations that a mass may be moved
constexpr double kNearest = 0.3;       // [m] farther from the tip, or from where it was said to be, there is no payload
constexpr double kNearEnough = 1.001;  // times that, so that rounding moves no mass

double deviationOf(const RidgeEstimate& estimate, Index at) {
  return std::sqrt(std::max(0.0, estimate.covariance(at, at)));
}

/// [m] away from the tip, of a payload of these parameters.
double centerOf(const Eigen::VectorXd& theta) {
  return theta[0] != 0.0 ? theta.segment<3>(1).norm() / std::abs(theta[0]) : 0.0;
}

/// A mass for the payload, and what the data say of all four parameters given that mass.
class PayloadMass {
 public:
  PayloadMass(const FitProblem& problem, const RidgeEstimate& estimate)
      : problem_(problem),
        theta_(estimate.value.head<kWeightParameters>()),
        nearest_(kNearest + centerOf(problem.thinkable().mean)),
        deviation_(deviationOf(estimate, 0)),
        slope_(deviation_ > 0.0 ? Eigen::Vector3d(estimate.covariance.block<3, 1>(1, 0) / std::pow(deviation_, 2))
                                : Eigen::Vector3d(Eigen::Vector3d::Zero())) {}

  double estimated() const { return theta_[0]; }
  bool isLikely(double mass) const { return std::abs(mass - theta_[0]) <= kDoubtful * deviation_; }

  Eigen::Vector4d with(double mass) const {
    Eigen::Vector4d theta;
    theta << mass, theta_.tail<3>() + slope_ * (mass - theta_[0]);
    return theta;
  }

  /// Whether a payload of that mass is near the tip, and leaves a last body.
  bool canBeAtTip(double mass) const {
    const Eigen::Vector4d theta = with(mass);
    return mass != 0.0 && theta.tail<3>().norm() <= kNearEnough * nearest_ * std::abs(mass) &&
           problem_.leavesALastBody(theta);
  }

  /// The nearest mass with which it can, one that is there rather than one that is missing.
  std::optional<double> nearestAtTip() const {
    // |h₀ + s (m − m₀)|² = (nearest m)², h = m c.
    const Eigen::Vector3d at_zero = with(0.0).tail<3>();
    const double a = slope_.squaredNorm() - nearest_ * nearest_;
    const double b = at_zero.dot(slope_);
    const double c = at_zero.squaredNorm();
    const double discriminant = b * b - a * c;
    if (a == 0.0 || discriminant < 0.0) return std::nullopt;
    std::optional<double> nearest;
    for (const double root : {(-b + std::sqrt(discriminant)) / a, (-b - std::sqrt(discriminant)) / a}) {
      if (!isLikely(root) || !canBeAtTip(root)) continue;
      const bool is_nearer =
          nearest && (root > 0.0) == (*nearest > 0.0) && std::abs(root - theta_[0]) < std::abs(*nearest - theta_[0]);
      const bool is_there_rather = nearest && root > 0.0 && *nearest < 0.0;
      if (!nearest || is_nearer || is_there_rather) nearest = root;
    }
    return nearest;
  }

 private:
  const FitProblem& problem_;
  const Eigen::Vector4d theta_;
  const double nearest_;  // [m]
  const double deviation_;
  const Eigen::Vector3d slope_;  // of m c, per kilogram
};

class Decision {
 public:
  Decision(FitProblem& problem, const RidgeEstimate& estimate, FitDecisions& decisions)
      : problem_(problem), estimate_(estimate), decisions_(decisions), mass_(problem, estimate) {}

  /// Goes only from what is more likely to what is less, so that it ends.
  bool aboutPayload() {
    const bool can_be = problem_.hasFreeBodies() || problem_.leavesALastBody(estimate_.value);
    switch (decisions_.payload) {
      case Payload::undecided:
        return firstAboutPayload();
      case Payload::at_tip:
        if (decisions_.mass_is_replaced) return can_be ? false : leavePayload(Payload::impossible);
        return mass_.canBeAtTip(mass_.estimated()) ? false : placePayload();
      case Payload::last_body:
        if (can_be) return false;
        return decisions_.mass_is_replaced ? leavePayload(Payload::impossible) : changeLastBody();
      default:
        return false;
    }
  }

  bool aboutDrives() {
    const TorqueRegression& regression = problem_.regression();
    decisions_.left.resize(static_cast<std::size_t>(regression.parameters()), false);
    bool changed = false;
    for (Index at = regression.inertial.cols(); at < regression.parameters(); ++at) {
      const bool is_free = problem_.thinkable().deviation[at] > 0.0;
      if (!is_free || decisions_.left[static_cast<std::size_t>(at)] || isTold(problem_, estimate_, at)) continue;
      problem_.leave(at, problem_.thinkable().mean[at]);
      decisions_.left[static_cast<std::size_t>(at)] = true;
      changed = true;
    }
    return changed;
  }

 private:
  bool firstAboutPayload() {
    const auto take = [&](Payload payload) { return decisions_.payload = payload, false; };
    if (problem_.hasFreeBodies()) return take(Payload::in_bodies);
    if (problem_.thinkable().deviation.head<kWeightParameters>().isZero(0.0)) return take(Payload::stated);
    bool any_is_told = false;
    for (Index i = 0; i < kWeightParameters; ++i) any_is_told = any_is_told || isTold(problem_, estimate_, i);
    if (!any_is_told) return leavePayload(Payload::untold);

    const Eigen::Vector4d theta = estimate_.value.head<kWeightParameters>();
    const Eigen::Matrix4d covariance = estimate_.covariance.topLeftCorner<kWeightParameters, kWeightParameters>() +
                                       1e-18 * Eigen::Matrix4d::Identity();
    if (theta.dot(covariance.ldlt().solve(theta)) >= kSignificant) return placePayload();
    decisions_.payload = Payload::none;
    decisions_.seen_mass = {theta[0], deviationOf(estimate_, 0)};
    problem_.dropPayload();
    return true;
  }

  bool placePayload() {
    const bool can_be = mass_.canBeAtTip(mass_.estimated());
    const std::optional<double> nearest = can_be ? std::nullopt : mass_.nearestAtTip();
    if (!can_be && !nearest) return changeLastBody();
    if (nearest) replaceMass(*nearest);
    decisions_.payload = Payload::at_tip;
    problem_.setPayloadForm(FitProblem::PayloadForm::at_tip);
    return true;
  }

  /// The mass as estimated, or else the description's.
  bool changeLastBody() {
    const bool can_be = problem_.leavesALastBody(estimate_.value);
    if (!can_be && !(mass_.isLikely(0.0) && problem_.leavesALastBody(mass_.with(0.0)))) {
      return leavePayload(Payload::impossible);
    }
    if (!can_be) replaceMass(0.0);
    decisions_.payload = Payload::last_body;
    problem_.setPayloadForm(FitProblem::PayloadForm::last_body);
    return true;
  }

  void replaceMass(double mass) {
    problem_.leave(0, mass);
    decisions_.mass_is_replaced = true;
  }

  bool leavePayload(Payload payload) {
    decisions_.payload = payload;
    decisions_.seen_mass = {mass_.estimated(), deviationOf(estimate_, 0)};
    const Prior& thinkable = problem_.thinkable();
    for (Index i = 0; i < kWeightParameters; ++i) problem_.leave(i, thinkable.mean[i]);
    const bool is_there = !thinkable.mean.head<kWeightParameters>().isZero(0.0);
    problem_.setPayloadForm(is_there ? FitProblem::PayloadForm::at_tip : FitProblem::PayloadForm::weight);
    return true;
  }

  FitProblem& problem_;
  const RidgeEstimate& estimate_;
  FitDecisions& decisions_;
  const PayloadMass mass_;
};

}  // namespace

bool isTold(const FitProblem& problem, const RidgeEstimate& estimate, Index at) {
  return deviationOf(estimate, at) < kTold * problem.thinkable().deviation[at];
}

bool decide(FitProblem& problem, const RidgeEstimate& estimate, FitDecisions& decisions) {
  Decision decision(problem, estimate, decisions);
  return decision.aboutPayload() || decision.aboutDrives();
}

}  // namespace demo_logger
