#include "demo_logger/robot/tracking.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "branch_search.h"
#include "comfort.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "joint_ranges.h"
#include "motion_limits.h"
#include "pose_error.h"
#include "step_solver.h"

namespace demo_logger {
namespace {

// Weight of the wanted displacement. It errs by half its root of how far the wish is off: 1e-6 m or rad for the
// comfortable motion, 1e-4 for a preferred one, which in return keeps its way through singular postures.
constexpr double kComfortWeight = 1e-5;
constexpr double kPreferenceWeight = 1e-4;
constexpr double kSettling = 0.05;  // [s] in which the motion that the target leaves open takes the wanted velocity
constexpr double kPull = 10.0;      // [1/s] towards a preferred posture
constexpr double kCalming = 0.5;    // per weighed error that no posture removes: the curvature of the reach's edge
constexpr double kRotationAfter = 0.01;  // weight of the rotation where not both can be had
constexpr double kHorizon = 0.1;         // [s] ahead of which the reachable is judged …
constexpr double kFurthest = 0.5;        // [rad or m] … within this
constexpr double kCatchUp = 0.9;         // share of the acceleration planned for catching up; the target needs some too
constexpr double kReached = 0.3;         // share of the tolerance
constexpr double kNearPosition =
    0.02;                         // [m] so near it is for the orientation's sake alone that the arm changes over …
constexpr double kAtRest = 0.02;  // [m/s] or [rad/s] … which is worth it for a target that moves no faster
constexpr double kLongestPart = 0.005;  // [s]
constexpr int kMostParts = 4;
constexpr int kApproaches = 4;  // Gauss-Newton iterations, at most
constexpr int kCorrections = 3;

}  // namespace

const char* toString(TrackingStatus status) {
  switch (status) {
    case TrackingStatus::tracked:
      return "tracked";
    case TrackingStatus::speed_limited:
      return "speed_limited";
    case TrackingStatus::at_limit:
      return "at_limit";
    case TrackingStatus::unreachable:
      break;
  }
  return "unreachable";
}

class Tracker::Implementation {
 public:
  Implementation(const RobotDescription& robot, const TrackingOptions& given)
      : name(robot.name),
        options(given),
        ranges(robot),
        limits(robot, given.max_velocity, given.max_acceleration),
        solver(robot),
        search(robot) {
    rest(ranges.middle());
  }

  Eigen::Index size() const { return limits.lower().size(); }

  void rest(const JointVector& start) {
    q = start;
    velocity.setZero(size());
    previous_dt = 0.0;
    has_last_target = false;
    has_last_goal = false;
    has_preference = false;
    position_first = false;
    out_of_reach = 0.0;
    settleHere();
    publish();
  }

  /// Long steps are made of shorter ones towards poses in between: the linear model then holds on the whole way. What
  /// holds for the velocities and accelerations of the parts holds for those of the whole.
  TrackedStep stepInParts(const RigidPose& target, double dt) {
    const int parts = std::clamp(static_cast<int>(std::ceil(dt / kLongestPart - 1e-6)), 1, kMostParts);
    if (parts == 1 || !has_last_target) return step(target, dt);
    const RigidPose from = last_target;
    const Vector6 way = poseError(target, from);
    const JointVector posture_at_end = preferred;
    const bool preference = has_preference;
    for (int part = 1; part < parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      const Eigen::Vector3d turn = share * way.tail<3>();
      RigidPose between = from;
      between.p += share * way.head<3>();
      const double angle = turn.norm();
      if (angle > 0.0) between.R = Eigen::AngleAxisd(angle, turn / angle) * from.R;
      if (preference) preferred = posture_at_end - (1.0 - share) * dt * preferred_velocity;
      step(between, dt / parts);
    }
    if (preference) preferred = posture_at_end;
    return step(target, dt / parts);
  }

  TrackedStep step(const RigidPose& target, double dt) {
    if (previous_dt == 0.0) previous_dt = dt;
    limits.box(q, velocity, previous_dt, dt, box);
    wishForNextStep(dt);
    watchTarget(target, dt);
    const bool reachable = solveUnhurried(target, dt) || solveFromPreference(target, dt);
    const bool elsewhere = !reachable && isReachableElsewhere(target, dt);
    if (reachable) settleHere();
    if (elsewhere && isTimeToChangeOver(dt)) solveFromPosture(target, search.posture());
    guardAgainstOvershoot(dt);
    x = unhurried.cwiseMax(box.lower).cwiseMin(box.upper);
    if (x != unhurried && !in_transit) {
      wishes.displacement = x;
      wishes.calming = reachable ? 0.0 : kCalming * out_of_reach;
      wishes.rotation = position_first ? kRotationAfter : 1.0;
      solver.approach(target, q, wishes, box, kCorrections, x);
    }
    moveBy(dt);
    last_target = target;
    has_last_target = true;
    return judge(target, reachable, elsewhere);
  }

  /// Without a target: comes to rest.
  TrackedStep slowDown(double dt) {
    if (previous_dt == 0.0) previous_dt = dt;
    limits.box(q, velocity, previous_dt, dt, box);
    x = JointVector::Zero(size()).cwiseMax(box.lower).cwiseMin(box.upper);
    moveBy(dt);
    has_last_target = false;
    has_preference = false;
    return {TrackingStatus::unreachable, kNaN, kNaN, false};
  }

  /// Where the target leaves it open, the arm makes the preferred motion; or without one moves on as it did, which
  /// leads through singular postures, and gradually takes on the velocity of a comfortable motion.
  void wishForNextStep(double dt) {
    if (has_preference) {
      wanted = preferred_velocity + kPull * (preferred - dt * preferred_velocity - q);
      wanted = wanted.cwiseMax(-limits.velocity()).cwiseMin(limits.velocity());
    } else {
      comfortVelocity(q, limits, solver, wanted);
    }
    const double share = std::min(1.0, dt / kSettling);
    wishes.weight = has_preference ? kPreferenceWeight : kComfortWeight;
    wishes.displacement = dt * wanted;
    if (!has_preference) wishes.displacement = dt * (velocity + share * (wanted - velocity));
    wishes.calm = (1.0 - share) * dt * velocity;
  }

  /// The displacement of an arm without limits of velocity and acceleration, and the part of it that only follows the
  /// target's own motion. False if it does not reach the target.
  bool solveUnhurried(const RigidPose& target, double dt) {
    const Eigen::Index n = size();
    const JointVector fastest = limits.finiteVelocity();
    const JointVector furthest = (std::max(kHorizon, 3.0 * dt) * fastest).cwiseMin(kFurthest);
    wide.lower = (limits.lower() - q).cwiseMax(-furthest);
    wide.upper = (limits.upper() - q).cwiseMin(furthest);
    unhurried = (dt * velocity).cwiseMax(wide.lower).cwiseMin(wide.upper);
    wishes.calming = kCalming * out_of_reach;
    wishes.rotation = position_first ? kRotationAfter : 1.0;
    solver.approach(target, q, wishes, wide, kApproaches, unhurried);
    own = unhurried;
    if (has_last_target) {
      wide.lower = -dt * fastest;
      wide.upper = dt * fastest;
      own.resize(n);
      solver.follow(poseError(target, last_target), wishes, wide, own);
    }
    in_transit = false;
    const Vector6 error = solver.errorAt(target, q + unhurried);
    const bool reachable = largerError(error) <= kReached * options.tolerance;
    // Out of reach it is not the target's motion that the arm follows, but that of the nearest it can do.
    if (has_last_goal && error.head<3>().norm() > options.tolerance) {
      own = (q + unhurried - last_goal).cwiseMax(-dt * fastest).cwiseMin(dt * fastest);
    }
    last_goal = q + unhurried;
    has_last_goal = true;
    left_over = error.head<3>().norm();
    position_first = !reachable;
    out_of_reach = reachable ? 0.0 : solver.weighed(error, kRotationAfter);
    return reachable;
  }

  /// Stuck where it is, but the preferred posture leads to the target: then that is where to go.
  bool solveFromPreference(const RigidPose& target, double dt) {
    if (!has_preference || !solveFromPosture(target, preferred)) return false;
    own = dt * preferred_velocity;
    return true;
  }

  /// The way to the target is the one to where it is reached from `posture`.
  bool solveFromPosture(const RigidPose& target, const JointVector& posture) {
    wide.lower = limits.lower() - q;
    wide.upper = limits.upper() - q;
    other = (posture - q).cwiseMax(wide.lower).cwiseMin(wide.upper);
    wishes.displacement = other;
    wishes.calming = 0.0;
    wishes.rotation = 1.0;
    solver.approach(target, q, wishes, wide, kCorrections, other);
    if (largerError(solver.errorAt(target, q + other)) > kReached * options.tolerance) return false;
    unhurried = other;
    own.setZero(size());
    in_transit = true;
    position_first = false;
    out_of_reach = 0.0;
    return true;
  }

  /// How long the target has rested, and whether it jumped while it was out of reach.
  void watchTarget(const RigidPose& target, double dt) {
    if (!has_last_target) return;
    rested = largerError(poseError(target, last_target)) > kAtRest * dt ? 0.0 : rested + dt;
    if (isJump(last_target, target, dt) && std::isfinite(options.patience)) is_changing_over = true;
  }

  bool isReachableElsewhere(const RigidPose& target, double dt) {
    const double distance = (target.p - solver.kinematics().firstOrigin()).norm();
    const bool found = distance <= solver.kinematics().reach() && search.find(target, public_q, dt);
    if (!found) {
      reachable_elsewhere_for = 0.0;
      is_changing_over = false;
    }
    return found;
  }

  /// Not for the sake of the orientation alone while the target moves, since on the way there the position is lost.
  bool isTimeToChangeOver(double dt) {
    reachable_elsewhere_for += dt;
    if (!std::isfinite(options.patience)) return false;
    if (reachable_elsewhere_for > options.patience && (left_over > kNearPosition || rested > options.patience)) {
      is_changing_over = true;
    }
    return is_changing_over;
  }

  /// In reach of the target, or without one.
  void settleHere() {
    search.forget();
    reachable_elsewhere_for = 0.0;
    is_changing_over = false;
  }

  /// A joint that is behind catches up only as fast as it can slow down again when it has.
  void guardAgainstOvershoot(double dt) {
    for (Eigen::Index i = 0; i < size(); ++i) {
      const double behind = unhurried[i] - own[i];
      const double most = dt * brakingVelocity(std::abs(behind), kCatchUp * limits.acceleration(), dt);
      if (std::abs(behind) <= (1.0 + 1e-9) * most) continue;
      if (behind > 0.0) {
        box.upper[i] = std::clamp(own[i] + most, box.lower[i], box.upper[i]);
      } else {
        box.lower[i] = std::clamp(own[i] - most, box.lower[i], box.upper[i]);
      }
    }
  }

  void moveBy(double dt) {
    q = (q + x).cwiseMax(limits.lower()).cwiseMin(limits.upper());
    velocity = x / dt;
    previous_dt = dt;
    publish();
  }

  TrackedStep judge(const RigidPose& target, bool reachable, bool elsewhere) {
    const Vector6 error = solver.errorAt(target, q);
    TrackedStep result{TrackingStatus::tracked, error.head<3>().norm(), error.tail<3>().norm(), reachable};
    if (std::max(result.position_error, result.rotation_error) <= options.tolerance) return result;
    const double distance = (target.p - solver.kinematics().firstOrigin()).norm();
    result.status = reachable || is_changing_over            ? TrackingStatus::speed_limited
                    : distance > solver.kinematics().reach() ? TrackingStatus::unreachable
                    : touchesLimit()                         ? TrackingStatus::at_limit
                    : elsewhere                              ? TrackingStatus::speed_limited
                                                             : TrackingStatus::unreachable;
    return result;
  }

  bool touchesLimit() const {
    constexpr double kTouching = 1e-3;  // [rad or m]
    return ((q - limits.lower()).array() < kTouching || (limits.upper() - q).array() < kTouching).any();
  }

  void publish() {
    public_q = q;
    public_velocity = velocity;
  }

  std::string name;
  TrackingOptions options;
  JointRanges ranges;
  MotionLimits limits;
  StepSolver solver;
  BranchSearch search;

  // The state from step to step.
  JointVector q, velocity;
  double previous_dt = 0.0;   // [s] 0 before the first step
  double out_of_reach = 0.0;  // weighed error that is left however long the arm may take
  RigidPose last_target;
  JointVector last_goal;                 // where an arm in no hurry would have gone
  double rested = 0.0;                   // [s] that the target has
  double reachable_elsewhere_for = 0.0;  // [s] and not from here
  double left_over = 0.0;                // [m] position error of an arm in no hurry
  JointVector preferred, preferred_velocity;
  Eigen::VectorXd public_q, public_velocity, q_before;

  // Within a step.
  MotionBox box, wide;
  StepWishes wishes;
  JointVector wanted, unhurried, own, other, x;

  bool has_last_target = false;
  bool has_last_goal = false;
  bool has_preference = false;
  bool position_first = false;
  bool in_transit = false;
  bool is_changing_over = false;  // to a posture that reaches the target
};

Tracker::Tracker(const RobotDescription& robot, const TrackingOptions& options) {
  if (!(options.max_velocity > 0.0) || !(options.max_acceleration > 0.0) || !(options.tolerance > 0.0)) {
    throw ConfigurationError("tracking: the velocity limit is " + print(options.max_velocity) +
                             ", the acceleration limit " + print(options.max_acceleration) + ", the tolerance " +
                             print(options.tolerance) + "; expected positive numbers");
  }
  implementation_ = std::make_unique<Implementation>(robot, options);
}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

const Eigen::VectorXd& Tracker::q() const { return implementation_->public_q; }
const Eigen::VectorXd& Tracker::velocity() const { return implementation_->public_velocity; }

void Tracker::reset(const Eigen::VectorXd& q) {
  Implementation& own = *implementation_;
  if (q.size() != own.size() || !q.allFinite()) {
    throw ModelError("robot '" + own.name + "': cannot start tracking from " + std::to_string(q.size()) +
                     " values, expected a finite one for each of its " + std::to_string(own.size()) + " joints");
  }
  own.rest(own.ranges.clamped(q));
}

TrackedStep Tracker::stay(const Eigen::Isometry3d& X_base_target) {
  const RigidPose target{X_base_target.linear(), X_base_target.translation()};
  if (!isRigid(target)) return {TrackingStatus::unreachable, kNaN, kNaN, false};
  implementation_->last_target = target;
  implementation_->has_last_target = true;
  return implementation_->judge(target, true, false);
}

void Tracker::prefer(const Eigen::VectorXd& posture, const Eigen::VectorXd& velocity) {
  Implementation& own = *implementation_;
  own.has_preference =
      posture.size() == own.size() && velocity.size() == own.size() && posture.allFinite() && velocity.allFinite();
  if (!own.has_preference) return;
  own.preferred = posture;
  own.preferred_velocity = velocity;
}

TrackedStep Tracker::step(const Eigen::Isometry3d& X_base_target, double dt) {
  if (!(dt > 0.0) || !std::isfinite(dt)) {
    throw ConfigurationError("tracking: a step of " + print(dt) + " s, expected a positive time");
  }
  const RigidPose target{X_base_target.linear(), X_base_target.translation()};
  if (!isRigid(target)) return implementation_->slowDown(dt);
  const Eigen::VectorXd& before = implementation_->q_before = implementation_->public_q;
  const TrackedStep result = implementation_->stepInParts(target, dt);
  implementation_->public_velocity = (implementation_->public_q - before) / dt;
  implementation_->has_preference = false;
  return result;
}

}  // namespace demo_logger
