#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigLCP.h>

#include <Eigen/Core>
#include <vector>

namespace demo_logger {

/// What friction, stops and contacts do to an arm in one step, in the space of its joints. Each row is an impulse λ
/// along a direction J of joint velocities, within bounds, that brings J q̇ as near to its target as it can:
///   q̇ = q̇₀ + W Jᵀ λ,     λ at its lower bound: J q̇ ≥ target,  at its upper: J q̇ ≤ target,  between: J q̇ = target
/// W is the inverse of the arm's mass matrix. All rows are solved at once and exactly by Bullet's Dantzig algorithm:
/// sweeps from row to row would leave an arm at rest creeping. Nothing is remembered from one step to the next.
class ConstraintProblem {
 public:
  void clear();

  /// A row for the velocity of one joint alone; returns its number. The bounds must enclose 0.
  int addJoint(int joint, double target, double lowest, double highest);
  /// A row along any direction. It yields to its impulse by `softness` times what the arm itself does.
  int add(const Eigen::VectorXd& direction, double target, double lowest, double highest, double softness = 0.0);
  /// As above with target 0, bounded by ± `coefficient` times the impulse of row `normal`, which it slides upon.
  int addSliding(const Eigen::VectorXd& direction, double coefficient, int normal, double softness = 0.0);

  /// Turns the velocity without constraints into the one with them.
  void solve(const Eigen::MatrixXd& W, Eigen::VectorXd& velocity);

  /// λ of a row after solve() [N m s or N s].
  double impulse(int row) const { return impulses_[row]; }
  int rows() const { return static_cast<int>(rows_.size()); }

 private:
  struct Row {
    int joint;      // -1: along a direction
    int direction;  // its index then
    double target;
    double lowest;
    double highest;
    int normal;  // -1: the bounds are its own
    double softness;
  };

  int addAlong(const Eigen::VectorXd& direction, const Row& row);
  void fillJacobian(Eigen::Index joints);
  void sweep();

  std::vector<Row> rows_;
  std::vector<Eigen::VectorXd> directions_;  // those in use come first
  int used_directions_ = 0;
  Eigen::MatrixXd jacobian_;  // J, rows x joints
  Eigen::MatrixXd response_;  // W Jᵀ
  Eigen::MatrixXd matrix_;    // J W Jᵀ
  Eigen::MatrixXd factored_;  // scratch of the solver, as the following
  Eigen::VectorXd wanted_, left_, impulses_, lowest_, highest_;
  std::vector<int> normals_;
  btDantzigScratchMemory scratch_;
};

}  // namespace demo_logger
