// Bullet's articulated-body algorithm and KDL's recursive Newton-Euler know nothing of each other; built from one
// description they must agree on kinematics, gravity and the whole of forward dynamics.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "src/robot/body_inertia.h"
#include "test/robot/own_arms.h"
#include "test/robot/real_arms.h"

namespace demo_logger {
namespace {

constexpr double kTolerance = 1e-9;  // [m, N m], torques reach 120 N m

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

/// Frames, axes, types and bodies at random; every body is four point masses, so its inertia is possible.
RobotDescription makeRandomArm(unsigned seed) {
  std::mt19937 generator(seed);
  const auto uniform = [&](double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(generator);
  };
  const auto vector = [&](double bound) {
    return Eigen::Vector3d(uniform(-bound, bound), uniform(-bound, bound), uniform(-bound, bound));
  };
  const auto pose = [&] {
    const Eigen::AngleAxisd turn(uniform(-3.0, 3.0), vector(1.0).normalized());
    return Eigen::Isometry3d(Eigen::Translation3d(vector(0.5)) * turn);
  };
  RobotDescription arm;
  arm.name = "random arm " + std::to_string(seed);
  arm.has_inertia = true;
  arm.gravity = 9.81 * vector(1.0).normalized();
  arm.X_lastlink_tip = pose();
  const int size = std::uniform_int_distribution<int>(1, 9)(generator);
  for (int i = 0; i < size; ++i) {
    ArmJoint joint;
    joint.name = "joint_" + std::to_string(i + 1);
    joint.link = "link_" + std::to_string(i + 1);
    joint.type = uniform(0.0, 1.0) < 0.3 ? JointType::prismatic : JointType::revolute;
    joint.X_parent_joint = pose();
    joint.axis = vector(1.0).normalized();
    for (int point = 0; point < 4; ++point) {
      BodyInertia mass;
      mass.mass = uniform(0.1, 2.0);
      mass.center = vector(0.2);
      joint.body = lumped(joint.body, mass);
    }
    arm.joints.push_back(joint);
  }
  return arm;
}

TEST(BulletAgainstKdlTest, AgreeOnThePackagesArms) {
  for (const std::string name : {"demo_arm", "two_link"}) expectAgreement(describeOwnArm(name), 1000, 1, name);
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
    expectAgreement(description, 500, 2, arm.file + " " + arm.tip);
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
