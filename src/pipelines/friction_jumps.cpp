#include "friction_jumps.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

using Index = Eigen::Index;

constexpr double kSure = 3.0;        // deviations, from which on a velocity has a sign
constexpr double kAround = 3.0;      // T, before and after an arrival at zero, that its velocity is looked at
constexpr double kApart = 6.0;       // T, at least, from one jump of a joint to its next
constexpr double kConvincing = 3.0;  // of the logarithm of the likelihood
constexpr double kChange = 0.5;      // of its Coulomb friction, a deviation of its change; half or twice that is alike
constexpr double kAtOnce = 0.3;      // of T, at most, that passing through the friction velocity takes

class ArrivalSearch {
 public:
  ArrivalSearch(const RobotModel& model, const std::vector<double>& time, const std::vector<JointInMotion>& joints)
      : model_(model), time_(time), joints_(joints) {}

  /// Adds the jumps that the friction of joint `i` causes.
  void search(Index i, Eigen::MatrixXd& variance) const {
    std::vector<double> gain = gains(i);
    for (;;) {
      const auto best = std::max_element(gain.begin(), gain.end());
      if (best == gain.end() || *best < kConvincing) return;
      const auto k = static_cast<std::size_t>(best - gain.begin());
      variance.row(static_cast<Index>(k)) += jumps(i, k).cwiseAbs2().transpose();
      const double apart = kApart * joint(i).motion.time_constant;
      std::fill(gain.begin() + rowAt(time_[k] - apart), gain.begin() + rowAt(time_[k] + apart), 0.0);
    }
  }

 private:
  /// Of the logarithm of the joint's likelihood, by a jump right before each sample.
  std::vector<double> gains(Index i) const {
    const JointInMotion& joint = this->joint(i);
    const double around = kAround * joint.motion.time_constant;
    std::vector<double> gain(time_.size(), 0.0);
    for (std::size_t k = 1; k < time_.size(); ++k) {
      const double before = surely(i, rowAt(time_[k] - around));
      const double after = surely(i, std::min<std::ptrdiff_t>(rowAt(time_[k] + around), lastRow()));
      const auto row = static_cast<Index>(k);
      const double score = joint.jumps.score[row];
      const bool arrives = before != 0.0 && before * after <= 0.0;
      // What slows the joint down vanishes, so that it jumps in the direction in which it came.
      if (!arrives || before * score <= 0.0 || isGradual(i, std::abs(before - after) / (2.0 * around))) continue;
      const double variance = std::pow(jumps(i, k)[i], 2);
      const double weight = 1.0 + variance * joint.jumps.information[row];
      gain[k] = 0.5 * (score * score * variance / weight - std::log(weight));
    }
    return gain;
  }

  /// Of each joint's acceleration, one deviation of it, as the friction of joint `i` changes at row k. Joints that
  /// stand are held by theirs.
  Eigen::VectorXd jumps(Index i, std::size_t k) const {
    const Index n = model_.size();
    Eigen::VectorXd q(n);
    std::vector<Index> moving;
    for (Index j = 0; j < n; ++j) {
      q[j] = joint(j).motion.position[static_cast<Index>(k)];
      const bool holds = friction(j) > 0.0 && surely(j, static_cast<std::ptrdiff_t>(k)) == 0.0;
      if (j == i || !holds) moving.push_back(j);
    }
    const Eigen::MatrixXd inertia = model_.massMatrix(q);
    const auto count = static_cast<Index>(moving.size());
    Eigen::MatrixXd of_moving(count, count);
    Eigen::VectorXd change = Eigen::VectorXd::Zero(count);
    for (Index a = 0; a < count; ++a) {
      const Index row = moving[static_cast<std::size_t>(a)];
      for (Index b = 0; b < count; ++b) of_moving(a, b) = inertia(row, moving[static_cast<std::size_t>(b)]);
      of_moving(a, a) += model_.description().joints[static_cast<std::size_t>(row)].motor_inertia;
      if (row == i) change[a] = kChange * friction(i);
    }
    const Eigen::VectorXd jump = of_moving.ldlt().solve(change);
    Eigen::VectorXd jumps = Eigen::VectorXd::Zero(n);
    for (Index a = 0; a < count; ++a) jumps[moving[static_cast<std::size_t>(a)]] = jump[a];
    return jumps;
  }

  /// The joint's velocity, or 0 where it may as well stand.
  double surely(Index i, std::ptrdiff_t row) const {
    const SmoothedMotion& motion = joint(i).motion;
    const double variance = motion.covariance[static_cast<std::size_t>(row)](1, 1);
    const double velocity = motion.velocity[row];
    return velocity * velocity > kSure * kSure * variance ? velocity : 0.0;
  }

  /// Friction does not turn round at once, as the velocity changes by so much a second.
  bool isGradual(Index i, double rate) const {
    const double width = 2.0 * model_.description().joints[static_cast<std::size_t>(i)].friction_velocity;
    return width > kAtOnce * rate * joint(i).motion.time_constant;
  }

  /// The first one at or after that.
  std::ptrdiff_t rowAt(double time) const { return std::lower_bound(time_.begin(), time_.end(), time) - time_.begin(); }
  std::ptrdiff_t lastRow() const { return static_cast<std::ptrdiff_t>(time_.size()) - 1; }
  const JointInMotion& joint(Index i) const { return joints_[static_cast<std::size_t>(i)]; }
  double friction(Index i) const { return model_.description().joints[static_cast<std::size_t>(i)].friction; }

  const RobotModel& model_;
  const std::vector<double>& time_;
  const std::vector<JointInMotion>& joints_;
};

}  // namespace

bool hasFriction(const RobotDescription& robot) {
  return std::any_of(robot.joints.begin(), robot.joints.end(),
                     [](const ArmJoint& joint) { return joint.friction > 0.0; });
}

Eigen::MatrixXd frictionJumps(const RobotModel& model, const std::vector<double>& time,
                              const std::vector<JointInMotion>& joints) {
  const ArrivalSearch arrivals(model, time, joints);
  Eigen::MatrixXd variance = Eigen::MatrixXd::Zero(static_cast<Index>(time.size()), model.size());
  for (Index i = 0; i < model.size(); ++i) {
    if (model.description().joints[static_cast<std::size_t>(i)].friction > 0.0) arrivals.search(i, variance);
  }
  return variance;
}

}  // namespace demo_logger
