#include "posture_plan.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pose_error.h"

namespace demo_logger {
namespace {

constexpr std::size_t kMostCandidates = 24;  // kept at a knot
constexpr double kApart = 0.12;              // [rad or m] by which candidates differ at least, in some joint
constexpr double kUsed = 0.6;                // share of the velocity and acceleration limits that a plan makes use of
constexpr double kSelfMotion = 0.144;        // [rad or m] largest joint move of a side step
constexpr double kReached = 1e-5;            // [m] and [rad]
constexpr double kGood = 1e-4;               // residual beyond which a posture counts as off the path
constexpr int kIterations = 12;
constexpr int kSweeps = 15;

// Costs. Those of a posture and of speed are per second; the others are large, for what should not be.
constexpr double kOffCentre = 0.1;
constexpr double kNearLimit = 0.02;
constexpr double kSingular = 0.05;
constexpr double kSpeed = 0.1;
constexpr double kAcceleration = 0.02;
constexpr double kOffPath = 300.0;
constexpr double kTooFast = 100.0;
constexpr double kTooAbrupt = 10.0;

}  // namespace

PosturePlanner::PosturePlanner(const RobotDescription& robot, const MotionLimits& limits)
    : kinematics_(robot),
      ranges_(robot),
      limits_(limits),
      descent_(kinematics_, ranges_),
      velocity_(limits.finiteVelocity()) {}

std::vector<JointVector> PosturePlanner::plan(const std::vector<Knot>& knots, const JointVector& start) const {
  std::vector<std::vector<Candidate>> layers(1);
  Candidate first;
  first.q = start;
  first.move = JointVector::Zero(start.size());
  layers.front().push_back(first);
  for (std::size_t k = 1; k < knots.size(); ++k) {
    layers.push_back(expanded(layers.back(), knots[k], knots[k].time - knots[k - 1].time));
  }
  std::vector<JointVector> postures(knots.size());
  std::size_t way = 0;  // the candidates of a layer are in order of their cost
  for (std::size_t k = knots.size(); k-- > 0;) {
    postures[k] = layers[k][way].q;
    way = layers[k][way].parent;
  }
  smooth(knots, postures);
  return postures;
}

std::vector<PosturePlanner::Candidate> PosturePlanner::expanded(const std::vector<Candidate>& parents, const Knot& knot,
                                                                double dt) const {
  std::vector<Candidate> children;
  for (std::size_t parent = 0; parent < parents.size(); ++parent) addChildren(parents, parent, knot, dt, children);
  std::sort(children.begin(), children.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  const double apart = std::min(kApart, 0.6 * kUsed * velocity_.minCoeff() * dt);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : children) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Candidate& other) {
      return (other.q - candidate.q).cwiseAbs().maxCoeff() < apart;
    });
    if (is_new) kept.push_back(candidate);
    if (kept.size() == kMostCandidates) break;
  }
  return kept;
}

void PosturePlanner::addChildren(const std::vector<Candidate>& parents, std::size_t parent, const Knot& knot, double dt,
                                 std::vector<Candidate>& children) const {
  const auto add = [&](const JointVector& guess) {
    children.push_back(child(parents[parent], guess, knot, dt));
    children.back().parent = parent;
  };
  const JointVector& q = parents[parent].q;
  add(q + parents[parent].move);
  add(q);
  JointVector direction;
  for (int which = 0; which < kinematics_.size() - 6; ++which) {
    if (!selfMotion(q, which, direction)) continue;
    double step = kSelfMotion;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      if (direction[i] != 0.0) step = std::min(step, kUsed * velocity_[i] * dt / std::abs(direction[i]));
    }
    add(q + step * direction);
    add(q - step * direction);
  }
}

PosturePlanner::Candidate PosturePlanner::child(const Candidate& parent, const JointVector& guess, const Knot& knot,
                                                double dt) const {
  PoseDescent::Found found;
  reach(knot, guess, found);
  Candidate candidate;
  candidate.q = found.q;
  candidate.move = found.q - parent.q;
  candidate.cost = parent.cost + dt * discomfort(found.q) + kOffPath * std::max(0.0, found.residual - kGood);
  for (Eigen::Index i = 0; i < found.q.size(); ++i) {
    const double speed = std::abs(candidate.move[i]) / (velocity_[i] * dt);
    const double change = std::abs(candidate.move[i] - parent.move[i]) / (limits_.acceleration() * dt * dt);
    candidate.cost += dt * (kSpeed * speed * speed + kAcceleration * change * change) +
                      kTooFast * std::max(0.0, speed - kUsed) + kTooAbrupt * std::max(0.0, change - kUsed);
  }
  return candidate;
}

/// Of the tip, metres made comparable to radians.
JacobianMatrix PosturePlanner::scaledJacobian(const JointVector& q) const {
  RigidPose pose;
  JacobianMatrix jacobian;
  kinematics_.forward(q, pose, jacobian);
  jacobian.topRows<3>() *= descent_.perMetre();
  return jacobian;
}

double PosturePlanner::discomfort(const JointVector& q) const {
  double cost = 0.0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double half = 0.5 * (limits_.upper()[i] - limits_.lower()[i]);
    if (!std::isfinite(half) || half <= 0.0) continue;
    const double share = (q[i] - limits_.lower()[i]) / half - 1.0;
    cost += kOffCentre * share * share + kNearLimit / std::max(1e-3, 1.0 - share * share);
  }
  const JacobianMatrix jacobian = scaledJacobian(q);
  Matrix6 A = jacobian * jacobian.transpose();
  A.diagonal().array() += 1e-5;
  return cost - kSingular * std::log(A.determinant());
}

/// A direction in which the joints can move with the tip at rest, of largest component 1.
bool PosturePlanner::selfMotion(const JointVector& q, int which, JointVector& direction) const {
  const JacobianMatrix jacobian = scaledJacobian(q);
  Matrix6 A = jacobian * jacobian.transpose();
  A.diagonal().array() += 1e-6;
  // Any vector will do that is not, by chance, one of those that move the tip.
  direction.resize(q.size());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    direction[i] = 0.3 + std::cos(1.7 * static_cast<double>((i + 1) * (which + 1)));
  }
  const Vector6 twist = jacobian * direction;
  direction -= jacobian.transpose() * A.ldlt().solve(twist);
  const double largest = direction.cwiseAbs().maxCoeff();
  if (largest < 1e-3) return false;
  direction /= largest;
  return true;
}

bool PosturePlanner::reach(const Knot& knot, const JointVector& guess, PoseDescent::Found& found) const {
  int iterations = kIterations;
  const JointVector start = guess.cwiseMax(limits_.lower()).cwiseMin(limits_.upper());
  descent_.run(knot.pose, start, kReached, iterations, found);
  found.q = found.q.cwiseMax(limits_.lower()).cwiseMin(limits_.upper());
  return found.residual <= kGood;
}

double PosturePlanner::speed(const JointVector& from, const JointVector& to, double dt) const {
  return ((to - from).array().abs() / (velocity_.array() * dt)).maxCoeff();
}

void PosturePlanner::smooth(const std::vector<Knot>& knots, std::vector<JointVector>& postures) const {
  PoseDescent::Found found;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t k = 1; k + 1 < knots.size(); ++k) {
      const double before = knots[k].time - knots[k - 1].time, after = knots[k + 1].time - knots[k].time;
      const JointVector between = postures[k - 1] + before / (before + after) * (postures[k + 1] - postures[k - 1]);
      if (!reach(knots[k], 0.5 * (between + postures[k]), found)) continue;
      const auto fastest = [&](const JointVector& q) {
        return std::max(speed(postures[k - 1], q, before), speed(q, postures[k + 1], after));
      };
      if (fastest(found.q) <= std::max(fastest(postures[k]), kUsed)) postures[k] = found.q;
    }
  }
}

void interpolatePostures(const std::vector<PosturePlanner::Knot>& knots, const std::vector<JointVector>& postures,
                         double time, Eigen::VectorXd& q, Eigen::VectorXd& velocity) {
  const std::size_t last = knots.size() - 1;
  const auto behind = std::upper_bound(knots.begin(), knots.end(), time,
                                       [](double t, const PosturePlanner::Knot& knot) { return t < knot.time; });
  const auto k = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(behind - knots.begin() - 1, 0, static_cast<std::ptrdiff_t>(last) - 1));
  const double h = knots[k + 1].time - knots[k].time;
  const double s = std::clamp((time - knots[k].time) / h, 0.0, 1.0);
  const auto slope = [&](std::size_t i) -> JointVector {
    if (i == 0 || i == last) return JointVector::Zero(postures[i].size());
    return (postures[i + 1] - postures[i - 1]) / (knots[i + 1].time - knots[i - 1].time);
  };
  const JointVector change = (postures[k + 1] - postures[k]) / h;
  const JointVector from = slope(k) - change, to = slope(k + 1) - change;
  // On the straight line, plus what the slopes at both ends ask for beyond it.
  q = postures[k] + h * (s * change + s * (1.0 - s) * ((1.0 - s) * from - s * to));
  velocity = change + (1.0 - s) * (1.0 - 3.0 * s) * from + s * (3.0 * s - 2.0) * to;
}

}  // namespace demo_logger
