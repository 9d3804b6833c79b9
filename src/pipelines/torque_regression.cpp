#include "torque_regression.h"

#include <algorithm>

namespace demo_logger {
namespace {

using Index = Eigen::Index;

/// The parameters that joint i's equations know, in the order of JointSums.
Eigen::VectorXd known(const TorqueRegression& regression, Index joint, const Eigen::VectorXd& theta) {
  const Index inertial = regression.inertial.cols();
  Eigen::VectorXd own(inertial + TorqueRegression::kOfJoint);
  own << theta.head(inertial), theta.segment<TorqueRegression::kOfJoint>(regression.indexOf(joint, 0));
  return own;
}

}  // namespace

double TorqueRegression::residual(Index row, Index joint, const Eigen::VectorXd& theta) const {
  return unexplained(row, joint) - inertial.row(row * joints + joint).dot(theta.head(inertial.cols())) -
         theta[indexOf(joint, kBias)] - velocity(row, joint) * theta[indexOf(joint, kDamping)] -
         sign(row, joint) * theta[indexOf(joint, kFriction)];
}

JointSums::JointSums(Index inertial)
    : xx(Eigen::MatrixXd::Zero(inertial + TorqueRegression::kOfJoint, inertial + TorqueRegression::kOfJoint)),
      xy(Eigen::VectorXd::Zero(inertial + TorqueRegression::kOfJoint)) {}

void JointSums::add(const TorqueRegression& regression, Index row, Index joint) {
  if (!regression.says(row, joint)) return;
  Eigen::VectorXd x(xy.size());
  x << regression.inertial.row(row * regression.joints + joint).transpose(), 1.0, regression.velocity(row, joint),
      regression.sign(row, joint);
  const double y = regression.unexplained(row, joint);
  xx.noalias() += x * x.transpose();
  xy += y * x;
  yy += y * y;
  count += 1.0;
}

JointSums& JointSums::operator+=(const JointSums& other) {
  xx += other.xx;
  xy += other.xy;
  yy += other.yy;
  count += other.count;
  return *this;
}

double JointSums::squares(const TorqueRegression& regression, Index joint, const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd own = known(regression, joint, theta);
  return std::max(0.0, yy - 2.0 * own.dot(xy) + own.dot(xx * own));
}

RidgeEstimate solveRegression(const TorqueRegression& regression, const std::vector<JointSums>& sums,
                              const Eigen::VectorXd& weight, const Prior& prior) {
  const Index inertial = regression.inertial.cols();
  constexpr Index kOwn = TorqueRegression::kOfJoint;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(regression.parameters(), regression.parameters());
  Eigen::VectorXd b = Eigen::VectorXd::Zero(regression.parameters());
  for (Index i = 0; i < regression.joints; ++i) {
    const JointSums& joint = sums[static_cast<std::size_t>(i)];
    const Index at = regression.indexOf(i, 0);
    A.topLeftCorner(inertial, inertial) += weight[i] * joint.xx.topLeftCorner(inertial, inertial);
    A.block(0, at, inertial, kOwn) = weight[i] * joint.xx.topRightCorner(inertial, kOwn);
    A.block(at, 0, kOwn, inertial) = weight[i] * joint.xx.bottomLeftCorner(kOwn, inertial);
    A.block(at, at, kOwn, kOwn) = weight[i] * joint.xx.bottomRightCorner(kOwn, kOwn);
    b.head(inertial) += weight[i] * joint.xy.head(inertial);
    b.segment(at, kOwn) = weight[i] * joint.xy.tail(kOwn);
  }
  return solveRidge(A, b, prior);
}

}  // namespace demo_logger
