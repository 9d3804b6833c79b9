#include "pose_descent.h"

#include <algorithm>

#include "damped_step.h"
#include "pose_error.h"

namespace demo_logger {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr double kDamping = 0.05;           // of the squared, weighted error: large far off, nothing near the target
constexpr double kLeastDamping = 1e-14;     // above the rounding of J Jᵀ
constexpr int kPatience = 6;                // iterations within which the error must fall …
constexpr double kProgress = 0.9;           // … to this share, or the start is given up
constexpr int kPolishingIterations = 3;     // at most, below the tolerance …
constexpr double kPolishingProgress = 0.1;  // … and only while each leaves no more than this share
constexpr double kRounding = 1e-14;         // [m, rad] of the kinematics: nothing to gain below
constexpr double kShortestReach = 1e-3;     // [m] for the weight; an arm of rotations alone has none
constexpr double kLongestReach = 1e3;       // [m] a prismatic joint may have no limits

}  // namespace

PoseDescent::PoseDescent(const ArmKinematics& kinematics, const JointRanges& ranges)
    : kinematics_(kinematics),
      ranges_(ranges),
      per_metre_(2.0 / std::clamp(kinematics.reach(), kShortestReach, kLongestReach)) {}

void PoseDescent::run(const RigidPose& target, const JointVector& start, double tolerance, int& iterations_left,
                      Found& found) const {
  JointVector q = start, step;
  JacobianMatrix jacobian;
  RigidPose pose;
  double residual_before = kInfinity;
  double reference = kInfinity;  // squared error from which progress is counted
  int since_reference = 0;
  int polished = 0;
  found.residual = kInfinity;
  while (true) {
    kinematics_.forward(q, pose, jacobian);
    Vector6 error = poseError(target, pose);
    const double residual = largerError(error);
    if (residual < found.residual) {
      found.residual = residual;
      found.q = q;
    }
    if (residual <= tolerance) {
      const bool stalls = residual > kPolishingProgress * residual_before;
      if (stalls || residual < kRounding || ++polished > kPolishingIterations) return;
    }
    if (iterations_left <= 0) return;
    --iterations_left;
    residual_before = residual;

    error.head<3>() *= per_metre_;
    jacobian.topRows<3>() *= per_metre_;
    const double squared = error.squaredNorm();
    if (squared < kProgress * kProgress * reference) {
      reference = squared;
      since_reference = 0;
    } else if (++since_reference >= kPatience) {
      return;
    }
    dampedStep(jacobian, error, std::max(kLeastDamping, kDamping * squared), q, ranges_.lower(), ranges_.upper(), step);
    // Within limits once more: q + (limit − q) may round to just beyond.
    q = (q + step).cwiseMax(ranges_.lower()).cwiseMin(ranges_.upper());
  }
}

}  // namespace demo_logger
