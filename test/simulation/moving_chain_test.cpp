#include "src/simulation/moving_chain.h"

#include <gtest/gtest.h>

#include <random>

#include "demo_logger/robot/robot_model.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

/// The demo arm with a sliding joint in its middle and one at its end.
RobotDescription describeSlidingArm() {
  RobotDescription description = describeOwnArm("demo_arm");
  description.joints[3].type = JointType::prismatic;
  description.joints[6].type = JointType::prismatic;
  return description;
}

void expectAgreement(const RobotDescription& description) {
  constexpr double kRounding = 1e-12;
  const RobotModel kdl(description);
  MovingChain chain(description);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> position(-2.9, 2.9);
  Eigen::VectorXd q(kdl.size());
  for (int trial = 0; trial < 200; ++trial) {
    for (double& value : q) value = position(random);
    chain.place(q);
    ASSERT_LT((chain.massMatrix() - kdl.massMatrix(q)).cwiseAbs().maxCoeff(), kRounding);

    const Eigen::Isometry3d X_base_tip = chain.pose(kdl.size() - 1) * description.X_lastlink_tip;
    ASSERT_TRUE(X_base_tip.isApprox(kdl.forwardKinematics(q), kRounding));
    const Eigen::MatrixXd jacobian = kdl.jacobian(q);
    for (int i = 0; i < kdl.size(); ++i) {
      Eigen::VectorXd column(6);
      column << chain.pointVelocity(i, X_base_tip.translation()), chain.angularVelocity(i);
      ASSERT_LT((column - jacobian.col(i)).cwiseAbs().maxCoeff(), kRounding) << "joint " << i;
    }
  }
}

TEST(MovingChainTest, AgreesWithKdlOnTurningJoints) { expectAgreement(describeOwnArm("demo_arm")); }

TEST(MovingChainTest, AgreesWithKdlOnSlidingJoints) { expectAgreement(describeSlidingArm()); }

}  // namespace
}  // namespace demo_logger
