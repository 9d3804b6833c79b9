#include "step_solver.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pose_error.h"

namespace demo_logger {
namespace {

constexpr double kShortestReach = 1e-3;  // [m] an arm of rotations alone has none
constexpr double kLongestReach = 1e3;    // [m] a prismatic joint may have no limits
constexpr double kSmallChange = 1e-4;    // [rad or m] the next one would be its square
constexpr double kLeastDexterity = 1e-4;

}  // namespace

StepSolver::StepSolver(const RobotDescription& robot)
    : kinematics_(robot), per_metre_(2.0 / std::clamp(kinematics_.reach(), kShortestReach, kLongestReach)) {}

Vector6 StepSolver::errorAt(const RigidPose& target, const JointVector& q) {
  kinematics_.forward(q, pose_);
  return poseError(target, pose_);
}

double StepSolver::weighed(const Vector6& error, double rotation) const {
  return std::hypot(per_metre_ * error.head<3>().norm(), rotation * error.tail<3>().norm());
}

void StepSolver::weigh(double rotation) {
  error_.head<3>() *= per_metre_;
  error_.tail<3>() *= rotation;
  jacobian_.topRows<3>() *= per_metre_;
  jacobian_.bottomRows<3>() *= rotation;
}

void StepSolver::formHessian(double damping) {
  const Eigen::Index n = jacobian_.cols();
  hessian_.resize(n, n);
  for (Eigen::Index column = 0; column < n; ++column) {
    for (Eigen::Index row = column; row < n; ++row) {
      hessian_(row, column) = jacobian_.col(row).dot(jacobian_.col(column));
    }
  }
  hessian_.diagonal().array() += damping;
}

void StepSolver::approach(const RigidPose& target, const JointVector& q, const StepWishes& wishes, const MotionBox& box,
                          int iterations, JointVector& x) {
  for (int i = 0; i < iterations; ++i) {
    change_ = q + x;
    kinematics_.forward(change_, pose_, jacobian_);
    error_ = poseError(target, pose_);
    weigh(wishes.rotation);
    formHessian(wishes.weight + wishes.calming);
    gradient_.noalias() = jacobian_.transpose() * error_;
    gradient_ += wishes.weight * (wishes.displacement - x);
    if (wishes.calming > 0.0) gradient_ += wishes.calming * (wishes.calm - x);
    left_.lower = box.lower - x;
    left_.upper = box.upper - x;
    minimiseInBox(hessian_, gradient_, left_.lower, left_.upper, change_);
    x = (x + change_).cwiseMax(box.lower).cwiseMin(box.upper);
    if (change_.cwiseAbs().maxCoeff() < kSmallChange) return;
  }
}

void StepSolver::follow(const Vector6& twist, const StepWishes& wishes, const MotionBox& box, JointVector& x) {
  error_ = twist;
  error_.head<3>() *= per_metre_;
  error_.tail<3>() *= wishes.rotation;
  formHessian(wishes.weight);
  gradient_.noalias() = jacobian_.transpose() * error_;
  gradient_ += wishes.weight * wishes.displacement;
  minimiseInBox(hessian_, gradient_, box.lower, box.upper, x);
}

double StepSolver::logDexterity(const JointVector& q) {
  kinematics_.forward(q, pose_, jacobian_);
  jacobian_.topRows<3>() *= per_metre_;
  Matrix6 A = Matrix6::Zero();
  A.diagonal().setConstant(kLeastDexterity);
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const Vector6 column = jacobian_.col(i);
    A.noalias() += column * column.transpose();
  }
  return 0.5 * std::log(A.determinant());
}

}  // namespace demo_logger
