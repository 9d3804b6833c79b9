#include "constraint_problem.h"

#include <algorithm>
#include <cmath>

namespace demo_logger {
namespace {

// [(rad/s) / (N m)] A joint held by its friction and its stop at once is held twice; without a trace of softness the
// exact solver finds no answer to that. Stiction then creeps by 1e-12 rad in 2 s.
constexpr double kSoftness = 1e-12;

}  // namespace

void ConstraintProblem::clear() {
  rows_.clear();
  used_directions_ = 0;
}

int ConstraintProblem::addJoint(int joint, double target, double lowest, double highest) {
  rows_.push_back({joint, -1, target, lowest, highest, -1, 0.0});
  return rows() - 1;
}

int ConstraintProblem::add(const Eigen::VectorXd& direction, double target, double lowest, double highest,
                           double softness) {
  return addAlong(direction, {-1, -1, target, lowest, highest, -1, softness});
}

int ConstraintProblem::addSliding(const Eigen::VectorXd& direction, double coefficient, int normal, double softness) {
  return addAlong(direction, {-1, -1, 0.0, -coefficient, coefficient, normal, softness});
}

int ConstraintProblem::addAlong(const Eigen::VectorXd& direction, const Row& row) {
  if (used_directions_ == static_cast<int>(directions_.size())) directions_.emplace_back();
  directions_[static_cast<std::size_t>(used_directions_)] = direction;
  rows_.push_back(row);
  rows_.back().direction = used_directions_++;
  return rows() - 1;
}

void ConstraintProblem::fillJacobian(Eigen::Index joints) {
  jacobian_.setZero(rows(), joints);
  for (int i = 0; i < rows(); ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    if (row.joint >= 0) {
      jacobian_(i, row.joint) = 1.0;
    } else {
      jacobian_.row(i) = directions_[static_cast<std::size_t>(row.direction)];
    }
  }
}

void ConstraintProblem::solve(const Eigen::MatrixXd& W, Eigen::VectorXd& velocity) {
  const int n = rows();
  if (n == 0) return;
  if (used_directions_ > 0) {
    fillJacobian(velocity.size());
    response_.noalias() = W * jacobian_.transpose();
    matrix_.noalias() = jacobian_ * response_;
    wanted_.noalias() = -(jacobian_ * velocity);
  } else {  // J only picks joints
    response_.resize(velocity.size(), n);
    matrix_.resize(n, n);
    wanted_.resize(n);
    for (int i = 0; i < n; ++i) {
      const int joint = rows_[static_cast<std::size_t>(i)].joint;
      response_.col(i) = W.col(joint);
      wanted_[i] = -velocity[joint];
      for (int k = 0; k < n; ++k) matrix_(k, i) = W(rows_[static_cast<std::size_t>(k)].joint, joint);
    }
  }
  matrix_.diagonal().array() += kSoftness;
  lowest_.resize(n);
  highest_.resize(n);
  normals_.resize(rows_.size());
  for (int i = 0; i < n; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    wanted_[i] += row.target;
    matrix_(i, i) *= 1.0 + row.softness;
    lowest_[i] = row.lowest;
    highest_[i] = row.highest;
    normals_[static_cast<std::size_t>(i)] = row.normal;
  }
  impulses_.setZero(n);
  left_.setZero(n);
  factored_ = matrix_;
  Eigen::VectorXd wanted = wanted_, lowest = lowest_, highest = highest_;  // the solver reorders them
  const bool solved = btSolveDantzigLCP(n, factored_.data(), impulses_.data(), wanted.data(), left_.data(), /*nub=*/0,
                                        lowest.data(), highest.data(), normals_.data(), scratch_);
  if (!solved || !impulses_.allFinite()) sweep();
  velocity.noalias() += response_ * impulses_;
}

/// Projected Gauss and Seidel's relaxation, for problems that the exact solver gives up: several contacts that slide
/// and hold the same body may have no exact solution.
void ConstraintProblem::sweep() {
  constexpr int kSweeps = 200;
  impulses_.setZero();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int i = 0; i < rows(); ++i) {
      const Row& row = rows_[static_cast<std::size_t>(i)];
      const double scale = row.normal < 0 ? 1.0 : impulses_[row.normal];
      const double change = (wanted_[i] - matrix_.row(i).dot(impulses_)) / matrix_(i, i);
      impulses_[i] = std::clamp(impulses_[i] + change, scale * row.lowest, scale * row.highest);
    }
  }
}

}  // namespace demo_logger
