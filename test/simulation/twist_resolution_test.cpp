#include "src/simulation/twist_resolution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/robot/robot_model.h"
#include "test/simulation/arms.h"

namespace demo_logger {
namespace {

TEST(TwistResolutionTest, AwayFromSingularitiesTheTipMovesExactlyAsAsked) {
  const RobotModel model(describeDemoArm());
  const std::vector<double> bent = bentPosition();
  const Eigen::MatrixXd jacobian = model.jacobian(Eigen::Map<const Eigen::VectorXd>(bent.data(), 7));
  Eigen::VectorXd twist(6);
  twist << 0.1, -0.2, 0.05, 0.3, 0.0, -0.1;

  const ResolvedTwist resolved = resolveTwist(jacobian, twist);

  EXPECT_TRUE((jacobian * resolved.velocity).isApprox(twist, 1e-12));
  EXPECT_FALSE(resolved.damped);
}

TEST(TwistResolutionTest, OfManySolutionsItTakesTheShortest) {
  Eigen::MatrixXd jacobian(1, 2);
  jacobian << 1.0, 1.0;
  const Eigen::VectorXd twist = Eigen::VectorXd::Constant(1, 1.0);
  EXPECT_TRUE(resolveTwist(jacobian, twist).velocity.isApprox(Eigen::Vector2d(0.5, 0.5), 1e-15));
}

TEST(TwistResolutionTest, NoJointEverRacesHoweverSingularTheArm) {
  // Two links of 1 m, elbow angle shrinking to the stretched singularity, driven along the arm where it cannot go.
  for (double elbow = 1.0; elbow > 1e-12; elbow /= 2.0) {
    Eigen::MatrixXd jacobian(2, 2);
    jacobian << -std::sin(elbow), -std::sin(elbow), 1.0 + std::cos(elbow), std::cos(elbow);
    const ResolvedTwist resolved = resolveTwist(jacobian, Eigen::Vector2d(-0.1, 0.0));
    EXPECT_LE(resolved.velocity.norm(), 0.1 / 0.04 + 1e-9) << "1/ε bounds the gain, at elbow angle " << elbow;
    EXPECT_EQ(resolved.damped, elbow < 0.08) << "at elbow angle " << elbow;
  }
}

TEST(TwistResolutionTest, RestNeedsNoJointAndCountsAsReached) {
  const ResolvedTwist resolved = resolveTwist(Eigen::MatrixXd::Zero(6, 7), Eigen::VectorXd::Zero(6));
  EXPECT_TRUE(resolved.velocity.isZero(0.0));
  EXPECT_FALSE(resolved.damped);
}

}  // namespace
}  // namespace demo_logger
