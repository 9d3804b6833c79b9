#include "demo_logger/robot/inverse_kinematics.h"

#include <algorithm>
#include <limits>
#include <string>

#include "arm_kinematics.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "joint_ranges.h"
#include "pose_descent.h"
#include "pose_error.h"
#include "posture_table.h"

namespace demo_logger {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr double kNearEnough = 0.3;  // [rad or m] a solution this near to the seed is not improved upon
constexpr int kStartsBeforeCorners = 40;
constexpr int kStartsOutOfReach = 20;  // enough for the best residual of what the arm is too short for

/// The best posture so far: solved ones before others, among solved ones the nearest to the seed.
class BestPosture {
 public:
  BestPosture(double tolerance, const JointVector& seed) : tolerance_(tolerance), seed_(seed), q_(seed) {}

  bool solved() const { return solved_; }
  bool isNear() const { return solved_ && move_ < kNearEnough; }
  const JointVector& q() const { return q_; }

  void offer(const PoseDescent::Found& found) {
    const bool solved = found.residual <= tolerance_;
    const double move = (found.q - seed_).cwiseAbs().maxCoeff();
    if (solved ? solved_ && move >= move_ : solved_ || found.residual >= residual_) return;
    solved_ = solved;
    residual_ = found.residual;
    move_ = move;
    q_ = found.q;
  }

 private:
  double tolerance_;
  const JointVector& seed_;
  bool solved_ = false;
  double residual_ = kInfinity;
  double move_ = kInfinity;
  JointVector q_;
};

}  // namespace

class InverseKinematics::Implementation {
 public:
  explicit Implementation(const RobotDescription& robot)
      : name(robot.name),
        kinematics(robot),
        ranges(robot),
        descent(kinematics, ranges),
        table(kinematics, ranges),
        middle(ranges.middle()) {}

  Solution solve(const RigidPose& target, const JointVector& seed, const SolveOptions& options, JointVector& q) const {
    const bool too_far = (target.p - kinematics.firstOrigin()).norm() > kinematics.reach();
    int last_start = too_far ? kStartsOutOfReach : std::numeric_limits<int>::max();
    int iterations_left = options.most_iterations;
    Solution solution;
    BestPosture best(options.tolerance, seed);
    PoseDescent::Found found;
    PostureTable::Nearest nearest;
    JointVector start = seed;
    for (int i = 0; i <= last_start && iterations_left > 0; ++i) {
      if (i > 0) {
        if (options.out_of_time && options.out_of_time()) break;
        if (i == 1) nearest = table.nearest(target, descent.perMetre());
        // Near to the target's pose to find any branch; once there is one, near to the seed to find a better one.
        if (best.solved() && last_start - i + 1 == options.further_starts) nearest.sortByMove(i - 1, seed);
        if (!nearest.posture(i - 1, start)) restart(options.restart_seed, i, start);
      }
      descent.run(target, start, options.tolerance, iterations_left, found);
      ++solution.starts;
      ranges.turnTowards(seed, found.q);
      const bool first = !best.solved();
      best.offer(found);
      if (first && best.solved()) last_start = i + options.further_starts;
      if (best.isNear()) break;
    }
    q = best.q();
    RigidPose pose;
    kinematics.forward(q, pose);  // after its turns, which round
    solution.residual = largerError(poseError(target, pose));
    solution.solved = solution.residual <= options.tolerance;
    solution.iterations = options.most_iterations - iterations_left;
    return solution;
  }

  /// Where so many starts have failed, the arm may have to stand at its limits, which is what a descent that is kept
  /// within limits finds worst: then one start in four is from there.
  void restart(std::uint64_t seed, int i, JointVector& start) const {
    const auto counter = static_cast<std::uint64_t>(i);
    if (i < kStartsBeforeCorners || i % 4 != 0) return ranges.randomPosture(seed, counter, start);
    ranges.cornerPosture(seed, counter / 4, start);
  }

  std::string name;
  ArmKinematics kinematics;
  JointRanges ranges;
  PoseDescent descent;
  PostureTable table;
  Eigen::VectorXd middle;
};

InverseKinematics::InverseKinematics(const RobotDescription& robot)
    : implementation_(std::make_unique<Implementation>(robot)) {}
InverseKinematics::~InverseKinematics() = default;
InverseKinematics::InverseKinematics(InverseKinematics&&) noexcept = default;
InverseKinematics& InverseKinematics::operator=(InverseKinematics&&) noexcept = default;

const Eigen::VectorXd& InverseKinematics::middle() const { return implementation_->middle; }

Solution InverseKinematics::solve(const Eigen::Isometry3d& X_base_tip, const Eigen::VectorXd& seed, Eigen::VectorXd& q,
                                  const SolveOptions& options) const {
  const Implementation& own = *implementation_;
  const Eigen::Index n = own.kinematics.size();
  if (seed.size() != n) {
    throw ModelError("robot '" + own.name + "': the seed has " + std::to_string(seed.size()) +
                     " values, expected one for each of its " + std::to_string(n) + " joints");
  }
  if (!(options.tolerance > 0.0) || options.most_iterations < 1 || options.further_starts < 0) {
    throw ConfigurationError("inverse kinematics: tolerance is " + print(options.tolerance) + ", iterations " +
                             std::to_string(options.most_iterations) + ", further starts " +
                             std::to_string(options.further_starts) +
                             "; expected a positive tolerance, at least one iteration, and no negative count");
  }
  q.resize(n);
  const RigidPose target{X_base_tip.linear(), X_base_tip.translation()};
  if (!isRigid(target) || !seed.allFinite()) {
    q.setConstant(kNaN);
    Solution refused;
    refused.residual = kNaN;
    return refused;
  }
  JointVector result;
  const Solution solution = own.solve(target, own.ranges.clamped(seed), options, result);
  q = result;
  return solution;
}

}  // namespace demo_logger
