#include "src/robot/motion_limits.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <random>

#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(BrakingVelocityTest, UsesTheDistanceToTheLastInVeryShortStepsAfterOneLongOne) {
  constexpr double a = 10.0, dt = 0.05, h = 1e-6;
  double v = brakingVelocity(0.5, a, dt);
  double distance = v * dt;
  for (v -= 0.5 * a * (dt + h); v > 0.0; v -= a * h) distance += v * h;
  EXPECT_NEAR(distance, 0.5, 1e-5);
}

TEST(BrakingVelocityTest, AShortWayIsCoveredInOneStep) {
  EXPECT_DOUBLE_EQ(brakingVelocity(1e-4, 10.0, 0.01), 1e-2);  // half of 10 rad/s² · (0.01 s)² is 5e-4 rad
}

TEST(BrakingVelocityTest, ApproachesTheTextbookForShortSteps) {
  EXPECT_NEAR(brakingVelocity(0.5, 10.0, 1e-6), std::sqrt(2.0 * 10.0 * 0.5), 1e-4);
}

TEST(BrakingVelocityTest, WithoutAnAccelerationLimitTheDistanceIsCoveredInOneStep) {
  EXPECT_DOUBLE_EQ(brakingVelocity(0.5, kInfinity, 0.01), 50.0);
  EXPECT_EQ(brakingVelocity(kInfinity, 10.0, 0.01), kInfinity);
  EXPECT_EQ(brakingVelocity(0.0, 10.0, 0.01), 0.0);
  EXPECT_EQ(brakingVelocity(-1.0, 10.0, 0.01), 0.0);
}

/// Whatever is chosen within the boxes, the next box is not empty and no limit is passed.
RC_GTEST_PROP(MotionLimitsProperty, ThereIsAlwaysAWayOn, ()) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const bool even = *rc::gen::arbitrary<bool>();
  double dt = *rc::gen::element(0.001, 0.01, 0.05), previous_dt = dt;
  const double acceleration = *rc::gen::element(1.0, 10.0, 300.0);
  const MotionLimits limits(arm, 1.5, acceleration);
  std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
  JointVector q = JointVector::Zero(7), velocity = JointVector::Zero(7), direction = JointVector::Ones(7);
  MotionBox box;
  for (int step = 0; step < 1000; ++step) {
    if (!even) dt = std::pow(10.0, std::uniform_real_distribution<double>(-4.0, -0.5)(generator));
    limits.box(q, velocity, previous_dt, dt, box);
    RC_ASSERT((box.lower.array() <= box.upper.array()).all());
    if (step % 100 == 0) {
      for (double& value : direction) value = std::uniform_real_distribution<double>(-0.5, 1.5)(generator);
    }
    JointVector x(7);
    for (int i = 0; i < 7; ++i) {  // mostly at a bound of the box, as far as it goes
      x[i] = box.lower[i] + std::clamp(direction[i], 0.0, 1.0) * (box.upper[i] - box.lower[i]);
      RC_ASSERT(std::abs(x[i] / dt) <= 1.5);
      RC_ASSERT(std::abs(x[i] / dt - velocity[i]) <= acceleration * 0.5 * (previous_dt + dt));
    }
    q += x;
    velocity = x / dt;
    previous_dt = dt;
    for (int i = 0; i < 7; ++i) {
      RC_ASSERT(q[i] >= arm.joints[static_cast<std::size_t>(i)].lower);
      RC_ASSERT(q[i] <= arm.joints[static_cast<std::size_t>(i)].upper);
    }
  }
}

}  // namespace
}  // namespace demo_logger
