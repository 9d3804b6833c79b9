#include "demo_logger/robot/path_tracking.h"

#include <algorithm>
#include <string>

#include "demo_logger/robot/inverse_kinematics.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "pose_error.h"
#include "posture_plan.h"

namespace demo_logger {
namespace {

constexpr double kInterval = 0.1;   // [s] between knots
constexpr double kFurthest = 20.0;  // [s] planned ahead
constexpr double kRenewed = 10.0;   // [s] before the end of a plan that is not the path's
constexpr double kNear = 0.1;       // [m] and [rad]
constexpr int kSearch = 500;        // iterations
constexpr double kSlack = 1e-9;     // [s] times are sums of decimal fractions

RigidPose rigid(const Eigen::Isometry3d& X) { return {X.linear(), X.translation()}; }

}  // namespace

class PathTracker::Implementation {
 public:
  Implementation(const RobotDescription& robot, const Poses& given_poses, const std::vector<double>& given_times,
                 const Eigen::VectorXd& start, const TrackingOptions& options)
      : poses(given_poses),
        times(given_times),
        solver(robot),
        tracker(robot, options),
        planner(robot, MotionLimits(robot, options.max_velocity, options.max_acceleration)) {
    tracker.reset(start);
  }

  bool needsPlan() const { return next >= plan_again; }

  void plan() { planFrom(next == 0 ? 0 : next - 1); }

  TrackedStep step() {
    if (needsPlan()) plan();
    const std::size_t row = next++;
    if (row == 0) return tracker.stay(poses[0]);
    if (!knots.empty() && !lost) {
      interpolatePostures(knots, postures, times[row], q, velocity);
      tracker.prefer(q, velocity);
    }
    const TrackedStep result = tracker.step(poses[row], times[row] - times[row - 1]);
    if (lost && result.in_reach) plan_again = row + 1;
    lost = !result.in_reach;
    return result;
  }

  /// A posture at the pose of `row`, wherever it lies, into `q`.
  bool solveGlobally(std::size_t row) {
    SolveOptions options;
    options.most_iterations = kSearch;
    return solver.solve(poses[row], tracker.q(), q, options).solved;
  }

  void planFrom(std::size_t row) {
    knots.clear();
    plan_again = poses.size();
    for (std::size_t i = row; i < poses.size(); ++i) {
      const RigidPose pose = rigid(poses[i]);
      const bool first = i == row;
      // Nothing is planned across a jump: beyond it the arm will for a while be elsewhere.
      const bool jumps = i + 1 < poses.size() && isJump(pose, rigid(poses[i + 1]), times[i + 1] - times[i]);
      const bool last = i + 1 == poses.size() || jumps;
      if (!first && !last && times[i] - knots.back().time < kInterval - kSlack) continue;
      if (!first && !isRigid(pose)) continue;
      knots.push_back({times[i], pose});
      if (jumps) {
        plan_again = i + 1;
        break;
      }
      if (times[i] - times[row] > kFurthest && !last) {
        const auto renewal = std::upper_bound(times.begin(), times.end(), times[i] - kRenewed);
        plan_again = static_cast<std::size_t>(renewal - times.begin());
        break;
      }
    }
    if (knots.size() < 2) {
      knots.clear();
      return;
    }
    // From where the arm is, or if that is not on the path, from where it should be: the way there is the tracker's.
    const TrackedStep here = tracker.stay(poses[row]);
    const bool on_path = std::max(here.position_error, here.rotation_error) < kNear;
    if (on_path || !solveGlobally(row)) q = tracker.q();
    postures = planner.plan(knots, q);
  }

  const Poses& poses;
  const std::vector<double>& times;
  InverseKinematics solver;
  Tracker tracker;
  PosturePlanner planner;
  std::size_t next = 0;
  std::size_t plan_again = 0;  // row
  bool lost = false;           // out of reach in the last row
  std::vector<PosturePlanner::Knot> knots;
  std::vector<JointVector> postures;
  Eigen::VectorXd q, velocity;
};

PathTracker::PathTracker(const RobotDescription& robot, const Poses& poses, const std::vector<double>& times,
                         const Eigen::VectorXd& start, const TrackingOptions& options) {
  if (times.size() != poses.size()) {
    throw ConfigurationError("tracking: " + std::to_string(times.size()) + " times for " +
                             std::to_string(poses.size()) + " poses, expected one for each");
  }
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[i - 1])) {
      throw ConfigurationError("tracking: time " + printExactly(times[i]) + " s does not follow " +
                               printExactly(times[i - 1]) + " s; times must strictly increase");
    }
  }
  implementation_ = std::make_unique<Implementation>(robot, poses, times, start, options);
}
PathTracker::~PathTracker() = default;
PathTracker::PathTracker(PathTracker&&) noexcept = default;
PathTracker& PathTracker::operator=(PathTracker&&) noexcept = default;

bool PathTracker::needsPlan() const { return implementation_->needsPlan(); }
void PathTracker::plan() { implementation_->plan(); }
TrackedStep PathTracker::step() { return implementation_->step(); }
const Eigen::VectorXd& PathTracker::q() const { return implementation_->tracker.q(); }

}  // namespace demo_logger
