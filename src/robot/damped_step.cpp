#include "damped_step.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace demo_logger {
namespace {

constexpr double kLongestStep = 1.0;  // [rad or m] of one joint; the linear model says little beyond
constexpr int kPasses = 3;

/// Solves A y = b for a symmetric positive definite A, both in place, by A = L D Lᵀ. Each column is subtracted from the
/// rest as soon as it is known, which leaves the processor independent operations to overlap.
void solveInPlace(Matrix6& A, Vector6& b) {
  Vector6 inverse;  // of D
  for (int j = 0; j < 6; ++j) {
    inverse[j] = 1.0 / A(j, j);
    for (int c = j + 1; c < 6; ++c) {
      const double factor = A(c, j) * inverse[j];
      for (int r = c; r < 6; ++r) A(r, c) -= A(r, j) * factor;
      b[c] -= factor * b[j];
    }
  }
  for (int i = 5; i >= 0; --i) {
    for (int k = i + 1; k < 6; ++k) b[i] -= A(k, i) * b[k];
    b[i] *= inverse[i];
  }
}

}  // namespace

void dampedStep(const JacobianMatrix& jacobian, const Vector6& error, double damping, const JointVector& q,
                const JointVector& lower, const JointVector& upper, JointVector& step) {
  const Eigen::Index n = q.size();
  std::array<bool, kMostJoints> free{};
  for (Eigen::Index i = 0; i < n; ++i) {
    const double push = jacobian.col(i).dot(error);
    free[static_cast<std::size_t>(i)] = !(q[i] <= lower[i] && push < 0.0) && !(q[i] >= upper[i] && push > 0.0);
  }
  step.setZero(n);
  Vector6 rest = error;
  for (int pass = 0; pass < kPasses; ++pass) {
    Matrix6 A = Matrix6::Zero();
    A.diagonal().setConstant(damping);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!free[static_cast<std::size_t>(i)]) continue;
      const Vector6 column = jacobian.col(i);
      A.noalias() += column * column.transpose();
    }
    Vector6 y = rest;
    solveInPlace(A, y);
    double longest = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!free[static_cast<std::size_t>(i)]) continue;
      step[i] = jacobian.col(i).dot(y);
      longest = std::max(longest, std::abs(step[i]));
    }
    const double scale = longest > kLongestStep ? kLongestStep / longest : 1.0;
    bool stopped = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!free[static_cast<std::size_t>(i)]) continue;
      step[i] = std::clamp(scale * step[i], lower[i] - q[i], upper[i] - q[i]);
      if (q[i] + step[i] > lower[i] && q[i] + step[i] < upper[i]) continue;
      free[static_cast<std::size_t>(i)] = false;
      rest -= step[i] * jacobian.col(i);
      stopped = true;
    }
    if (!stopped) break;
  }
}

}  // namespace demo_logger
