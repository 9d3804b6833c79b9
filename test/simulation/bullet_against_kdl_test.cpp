// Bullet's articulated-body algorithm and KDL's recursive Newton-Euler know nothing of each other; built from one
// description they must agree on kinematics, gravity and the whole of forward dynamics.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "test/robot/own_arms.h"
#include "test/robot/random_arm.h"
#include "test/robot/real_arms.h"

namespace demo_logger {
namespace {

constexpr double kTolerance = 1e-9;  // [m, N m], torques reach 120 N m
constexpr int kStates = 2000;

struct Disagreement {
  double pose = 0.0;     // [m], and elements of the rotation
  double gravity = 0.0;  // [N m]
  double torque = 0.0;   // [N m]
};

Disagreement worstDisagreement(const RobotDescription& description, int states, unsigned seed) {
  const RobotModel kdl(description);
  BulletArm bullet(description);
  const int n = kdl.size();
  std::mt19937 generator(seed);
  const auto uniform = [&](double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(generator);
  };
  Disagreement worst;
  for (int state = 0; state < states; ++state) {
    Eigen::VectorXd q(n), dq(n), torque(n);
    for (int i = 0; i < n; ++i) {
      const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
      q[i] = uniform(std::max(joint.lower, -3.0), std::min(joint.upper, 3.0));
      dq[i] = uniform(-2.0, 2.0);
      torque[i] = uniform(-20.0, 20.0);
    }
    bullet.reset({q, dq});
    const Eigen::VectorXd ddq = bullet.acceleration(torque);
    worst.torque = std::max(worst.torque, (kdl.inverseDynamics(q, dq, ddq) - torque).cwiseAbs().maxCoeff());
    worst.pose =
        std::max(worst.pose, (bullet.tipPose().matrix() - kdl.forwardKinematics(q).matrix()).cwiseAbs().maxCoeff());

    bullet.reset({q, Eigen::VectorXd::Zero(n)});
    const Eigen::VectorXd residual = kdl.massMatrix(q) * bullet.acceleration(kdl.gravity(q));
    worst.gravity = std::max(worst.gravity, residual.cwiseAbs().maxCoeff());
  }
  return worst;
}

void expectAgreement(const RobotDescription& description, int states, unsigned seed, const std::string& name) {
  const Disagreement worst = worstDisagreement(description, states, seed);
  EXPECT_LT(worst.pose, kTolerance) << name;
  EXPECT_LT(worst.gravity, kTolerance) << name;
  EXPECT_LT(worst.torque, kTolerance) << name;
}

TEST(BulletAgainstKdlTest, AgreeOnThePackagesArms) {
  for (const std::string name : {"demo_arm", "two_link"}) expectAgreement(describeOwnArm(name), kStates, 1, name);
}

TEST(BulletAgainstKdlTest, AgreeOnArmsAtRandomWithPrismaticJointsAndTiltedBases) {
  for (unsigned seed = 0; seed < 40; ++seed) expectAgreement(makeRandomArm(seed), 50, seed, std::to_string(seed));
}

TEST(BulletAgainstKdlTest, AgreeOnArmsThatPeopleOwn) {
  if (realArmFolder().empty()) GTEST_SKIP() << "set DEMO_LOGGER_URDF to a folder of arms";
  int compared = 0;
  for (const RealArm& arm : realArms()) {
    const RobotDescription description = describeRealArm(arm);
    if (!description.has_inertia) continue;
    expectAgreement(description, kStates, 2, arm.file + " " + arm.tip);
    ++compared;
  }
  EXPECT_EQ(compared, 11);
}

TEST(BulletAgainstKdlTest, AgreeWithALoadInTheHand) {
  BodyInertia load;
  load.mass = 1.5;
  load.center = {0.02, -0.01, 0.05};
  load.inertia.diagonal() << 2e-3, 2e-3, 1e-3;
  expectAgreement(withLoad(describeOwnArm("demo_arm"), load), 200, 3, "loaded");
}

}  // namespace
}  // namespace demo_logger
