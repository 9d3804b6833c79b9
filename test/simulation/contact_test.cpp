// What touches the arm: wrenches upon links, the floor, obstacles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/simulation/bullet_arm.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr int kSubsteps = 4;

/// A ball of 2 kg and 0.1 m on a vertical slide along z, and a horizontal one along x before it if asked for.
RobotDescription makeSlide(bool aside) {
  RobotDescription slide;
  slide.name = "slide";
  slide.has_inertia = true;
  ArmJoint joint;
  joint.name = "aside";
  joint.type = JointType::prismatic;
  joint.axis = Eigen::Vector3d::UnitX();
  joint.body.mass = 1e-6;
  if (aside) slide.joints.push_back(joint);
  joint.name = "up";
  joint.axis = Eigen::Vector3d::UnitZ();
  joint.body.mass = 2.0;
  slide.joints.push_back(joint);
  return slide;
}

Surroundings makeFloor(const RobotDescription& slide) {
  Surroundings surroundings;
  surroundings.floor = 0.0;
  AttachedLink ball;
  ball.joint = static_cast<int>(slide.joints.size()) - 1;
  ball.shapes.push_back({CollisionShape::Kind::sphere, {0.1, 0.0, 0.0}, Eigen::Isometry3d::Identity()});
  surroundings.links = {ball};
  return surroundings;
}

Eigen::VectorXd vectorOf(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

TEST(WrenchTest, AWrenchUponTheTipIsTheTransposedJacobianTimesIt) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const RobotModel kdl(description);
  BulletArm arm(description);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::VectorXd q(7), wrench(6);
    for (double& value : q) value = std::clamp(normal(random), -1.5, 1.5);
    for (double& value : wrench) value = 10.0 * normal(random);
    arm.reset({q, Eigen::VectorXd::Zero(7)});
    LinkWrench tip{6, description.X_lastlink_tip.translation(), wrench.head<3>(), wrench.tail<3>(), false};
    const Eigen::VectorXd expected = kdl.jacobian(q).transpose() * wrench;
    EXPECT_LT((arm.externalTorque({tip}) - expected).cwiseAbs().maxCoeff(), 1e-11);

    const Eigen::Matrix3d R_link_base =
        (kdl.forwardKinematics(q) * description.X_lastlink_tip.inverse()).linear().transpose();
    tip.force = R_link_base * tip.force;
    tip.torque = R_link_base * tip.torque;
    tip.in_link_axes = true;
    EXPECT_LT((arm.externalTorque({tip}) - expected).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(WrenchTest, AWrenchMovesTheArmLikeTheTorquesItIsWorth) {
  RobotDescription description = describeOwnArm("demo_arm");
  for (ArmJoint& joint : description.joints) joint.friction = 0.0;
  const RobotModel kdl(description);
  BulletArm pushed(description), driven(description);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(7, 0.4);
  pushed.reset({q, Eigen::VectorXd::Zero(7)});
  driven.reset({q, Eigen::VectorXd::Zero(7)});
  const std::vector<LinkWrench> wrenches{{3, {0.0, 0.1, 0.0}, {5.0, -3.0, 8.0}, {0.0, 1.0, 0.0}, false}};
  pushed.step(kdl.gravity(q), 1e-4, 1, wrenches);
  driven.step(kdl.gravity(q) + driven.externalTorque(wrenches), 1e-4, 1);
  EXPECT_LT((pushed.state().dq - driven.state().dq).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT(pushed.state().dq.norm(), 1e-4);
}

TEST(ContactTest, ABallThatFallsOnTheFloorComesToRestUponIt) {
  const RobotDescription slide = makeSlide(/*aside=*/false);
  BulletArm arm(slide, makeFloor(slide));
  arm.reset({vectorOf({0.5}), vectorOf({0.0})});
  double lowest = 1.0;
  for (int tick = 0; tick < 1000; ++tick) {
    arm.step(vectorOf({0.0}), kPeriod, kSubsteps);
    lowest = std::min(lowest, arm.state().q[0]);
  }
  EXPECT_NEAR(arm.state().q[0], 0.1, 1e-5) << "its radius above the floor";
  EXPECT_GT(lowest, 0.1 - 1e-5) << "it never sinks in";
  EXPECT_NEAR(arm.state().dq[0], 0.0, 1e-6);
  ASSERT_EQ(arm.contacts().size(), 1U);
  EXPECT_NEAR(arm.contacts()[0].force, 2.0 * 9.81, 1e-3) << "[N], its weight";
}

TEST(ContactTest, FrictionWithTheFloorHoldsUpToItsCoefficientTimesTheWeight) {
  const RobotDescription slide = makeSlide(/*aside=*/true);
  Surroundings floor = makeFloor(slide);
  floor.friction = 0.5;
  BulletArm arm(slide, floor);
  arm.reset({vectorOf({0.0, 0.1}), vectorOf({0.0, 0.0})});
  const double limit = 0.5 * 2.0 * 9.81;
  for (int tick = 0; tick < 1000; ++tick) arm.step(vectorOf({0.95 * limit, 0.0}), kPeriod, kSubsteps);
  EXPECT_NEAR(arm.state().q[0], 0.0, 1e-4) << "weaker pushes are held";
  for (int tick = 0; tick < 1000; ++tick) arm.step(vectorOf({1.5 * limit, 0.0}), kPeriod, kSubsteps);
  EXPECT_NEAR(arm.state().dq[0], 0.5 * limit / 2.0, 0.02) << "the rest accelerates 2 kg for 1 s";
}

TEST(ContactTest, AnArmThatFallsLiesOnTheFloorAndNotInIt) {
  RobotDescription description = describeOwnArm("demo_arm");
  Surroundings floor;
  floor.floor = -0.2;
  BulletArm arm(description, floor);  // rods for links, as none are given
  Eigen::VectorXd q(7);
  q << 0.0, 1.2, 0.0, 0.5, 0.0, 0.3, 0.0;
  arm.reset({q, Eigen::VectorXd::Zero(7)});
  double deepest = 0.0;
  std::size_t most = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    arm.step(Eigen::VectorXd::Zero(7), kPeriod, kSubsteps);
    ASSERT_TRUE(arm.state().q.allFinite() && arm.state().dq.allFinite()) << "tick " << tick;
    most = std::max(most, arm.contacts().size());
    for (const Contact& contact : arm.contacts()) deepest = std::min(deepest, contact.distance);
  }
  EXPECT_GT(most, 2U);
  EXPECT_GT(deepest, -2e-3) << "[m]";
  EXPECT_LT(arm.state().dq.cwiseAbs().maxCoeff(), 1e-3) << "it has come to rest: " << arm.state().dq.transpose();
}

TEST(ContactTest, ABoxASphereAndACylinderStopTheBallWhereTheirSurfaceIs) {
  const RobotDescription slide = makeSlide(/*aside=*/false);
  for (const CollisionShape::Kind kind :
       {CollisionShape::Kind::box, CollisionShape::Kind::sphere, CollisionShape::Kind::cylinder}) {
    Surroundings table = makeFloor(slide);
    table.floor.reset();
    CollisionShape shape;
    shape.kind = kind;
    shape.size = kind == CollisionShape::Kind::box      ? Eigen::Vector3d(1.0, 1.0, 0.4)
                 : kind == CollisionShape::Kind::sphere ? Eigen::Vector3d(0.2, 0.0, 0.0)
                                                        : Eigen::Vector3d(0.5, 0.4, 0.0);
    shape.pose.translation().z() = 0.3;  // its top at 0.5 m
    table.obstacles = {shape};
    BulletArm arm(slide, table);
    arm.reset({vectorOf({0.8}), vectorOf({0.0})});
    for (int tick = 0; tick < 1000; ++tick) arm.step(vectorOf({0.0}), kPeriod, kSubsteps);
    EXPECT_NEAR(arm.state().q[0], 0.6, 1e-3) << "obstacle " << static_cast<int>(kind);
    ASSERT_FALSE(arm.contacts().empty());
    EXPECT_GT(arm.contacts()[0].normal.z(), 0.999) << "out of the obstacle";
  }
}

TEST(ContactTest, TheSameFallGivesTheSameBitsAndGoesOnFromItsStateAlone) {
  RobotDescription description = describeOwnArm("demo_arm");
  Surroundings surroundings;
  surroundings.floor = -0.2;
  CollisionShape box;
  box.size = {0.3, 0.3, 0.3};
  box.pose.translation() = Eigen::Vector3d(0.6, 0.0, -0.05);
  surroundings.obstacles = {box};
  BulletArm whole(description, surroundings), first(description, surroundings), second(description, surroundings);
  Eigen::VectorXd q(7);
  q << 0.0, 1.0, 0.0, 0.5, 0.0, 0.3, 0.0;
  whole.reset({q, Eigen::VectorXd::Zero(7)});
  first.reset({q, Eigen::VectorXd::Zero(7)});
  bool touched = false;
  for (int tick = 0; tick < 2000; ++tick) {
    whole.step(Eigen::VectorXd::Zero(7), kPeriod, kSubsteps);
    BulletArm& other = tick < 1000 ? first : second;
    if (tick == 1000) second.reset(first.state());
    other.step(Eigen::VectorXd::Zero(7), kPeriod, kSubsteps);
    ASSERT_EQ(whole.state().q, other.state().q) << "tick " << tick;
    ASSERT_EQ(whole.state().dq, other.state().dq) << "tick " << tick;
    touched = touched || (tick > 1000 && !whole.contacts().empty());
  }
  EXPECT_TRUE(touched);
}

TEST(ContactTest, AnObstacleWithoutSizeIsRefused) {
  const RobotDescription slide = makeSlide(/*aside=*/false);
  Surroundings nothing;
  nothing.obstacles.emplace_back();
  try {
    BulletArm arm(slide, nothing);
    FAIL() << "taken";
  } catch (const ModelError& error) {
    EXPECT_STREQ(error.what(), "an obstacle has a size of 0 m, expected above 0");
  }
}

TEST(ContactTest, WhatIsTouchedAtTheStartIsSaidWithLinkAndDepth) {
  RobotDescription slide = makeSlide(/*aside=*/false);
  slide.joints[0].link = "ball";
  SimulatedArmConfiguration configuration;
  configuration.surroundings = makeFloor(slide);
  configuration.surroundings.floor = -0.09;  // the ball has a radius of 0.1 m
  CollisionShape box;
  box.size = {0.1, 0.1, 0.1};
  box.pose.translation() = Eigen::Vector3d(0.0, 0.0, 0.5);
  configuration.surroundings.obstacles = {box};
  const std::string rest = ", which pushes it out; move that, or let the arm start elsewhere (initial_position).";
  const auto overlaps = [&] { return SimulatedArm(slide, configuration).overlaps(); };
  EXPECT_EQ(overlaps(), (std::vector<std::string>{"ball is 10.0 mm inside the floor" + rest}));
  configuration.surroundings.floor = -0.1;
  EXPECT_EQ(overlaps(), (std::vector<std::string>{"ball touches the floor" + rest}));
  configuration.surroundings.floor = -0.101;
  EXPECT_EQ(overlaps(), std::vector<std::string>{}) << "1 mm above the floor";
  box.pose.translation() = Eigen::Vector3d(0.0, 0.0, 0.12);
  configuration.surroundings.obstacles.push_back(box);
  EXPECT_EQ(overlaps(), (std::vector<std::string>{"ball is 30.0 mm inside obstacles[1]" + rest}));
}

}  // namespace
}  // namespace demo_logger
