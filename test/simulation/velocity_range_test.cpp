#include "src/simulation/velocity_range.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace demo_logger {
namespace {

ArmJoint makeJoint() {
  ArmJoint joint;
  joint.lower = -1.0;
  joint.upper = 2.0;
  joint.velocity_limit = 3.0;
  return joint;
}

TEST(VelocityRangeTest, FarFromPositionLimitsItIsTheVelocityLimitLessThreePercent) {
  ArmJoint joint = makeJoint();
  joint.type = JointType::continuous;
  joint.lower = -std::numeric_limits<double>::infinity();
  joint.upper = std::numeric_limits<double>::infinity();
  const VelocityRange range = velocityRange(joint, 100.0, {});
  EXPECT_DOUBLE_EQ(range.upper, 2.91);
  EXPECT_DOUBLE_EQ(range.lower, -2.91);
  EXPECT_FALSE(range.upper_by_position);
}

TEST(VelocityRangeTest, NearAPositionLimitItIsWhatBrakingAllows) {
  // Without the discrete step v² = 2 a d; here d = 0.05 m and a = 10: v = 1.
  const VelocityRange range = velocityRange(makeJoint(), 1.95, {10.0, 1e-9, 0.0});
  EXPECT_NEAR(range.upper, 1.0, 1e-6);
  EXPECT_TRUE(range.upper_by_position);
  EXPECT_FALSE(range.lower_by_position);
}

TEST(VelocityRangeTest, AtOrBeyondALimitOnlyTheWayBackIsOpen) {
  const VelocityRange range = velocityRange(makeJoint(), 2.1, {10.0, 0.001, 0.01});
  EXPECT_EQ(range.upper, 0.0);
  EXPECT_DOUBLE_EQ(range.lower, -2.91);
}

TEST(VelocityRangeTest, FromTheFastestVelocityAllowedTheJointAlwaysStopsBeforeTheMarginWithinItsDeceleration) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> start(-1.0, 1.98);
  std::uniform_real_distribution<double> deceleration(1.0, 50.0);
  std::uniform_real_distribution<double> period(0.0005, 0.01);
  for (int trial = 0; trial < 200; ++trial) {
    const BrakingRule rule{deceleration(random), period(random), 0.01};
    double q = start(random);
    double v = velocityRange(makeJoint(), q, rule).upper;
    for (int k = 0; k < 10'000; ++k) {
      q += v * rule.period;
      ASSERT_LE(q, 2.0 - rule.margin + 1e-12);
      const double next = velocityRange(makeJoint(), q, rule).upper;
      ASSERT_GE(next, v - rule.deceleration * rule.period - 1e-12) << "the rule asks for more than it promises";
      v = next;
    }
    EXPECT_NEAR(q, 2.0 - rule.margin, 0.01) << "and it is not needlessly shy";
  }
}

}  // namespace
}  // namespace demo_logger
