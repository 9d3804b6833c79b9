#include "demo_logger/trajectory/interpolation.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace demo_logger {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-14;  // a few operations on numbers near one

// A turn about a fixed axis; the definition against which slerp is judged.
Eigen::Vector4d turn(const Eigen::Vector3d& axis, double angle) {
  Eigen::Vector4d quaternion;
  quaternion << axis.normalized() * std::sin(angle / 2.0), std::cos(angle / 2.0);
  return quaternion;
}

// Distance of two orientations: q and -q are the same.
double distance(const Eigen::Vector4d& a, const Eigen::Vector4d& b) { return std::min((a - b).norm(), (a + b).norm()); }

double anyFraction() { return *rc::gen::inRange(0, 1'000'001) / 1e6; }
double anyBetween(double low, double high) { return low + (high - low) * anyFraction(); }
Eigen::Vector3d anyAxis() {
  const double height = anyBetween(-1.0, 1.0);
  const double longitude = anyBetween(0.0, 2.0 * kPi);
  const double radius = std::sqrt(1.0 - height * height);
  return {radius * std::cos(longitude), radius * std::sin(longitude), height};
}

TEST(InterpolationTest, FractionIsExactBetweenInstantsSinceTheEpoch) {
  const Nanoseconds epoch = 1'600'000'000'000'000'000;
  EXPECT_DOUBLE_EQ(fractionBetween(epoch, epoch + 3, epoch + 4), 0.75) << "as doubles, all four would be equal";
  EXPECT_EQ(fractionBetween(epoch, epoch, epoch), 0.0);
}

TEST(InterpolationTest, LinearIsExactAtItsEnds) {
  EXPECT_EQ(interpolateLinearly(0.1, 0.7, 0.0), 0.1);
  EXPECT_EQ(interpolateLinearly(0.1, 0.7, 1.0), 0.7);
  EXPECT_DOUBLE_EQ(interpolateLinearly(1.0, 3.0, 0.25), 1.5);
}

RC_GTEST_PROP(InterpolationTest, LinearLeavesAConstantAlone, ()) {
  const double constant = anyBetween(-1e3, 1e3);
  RC_ASSERT(interpolateLinearly(constant, constant, anyFraction()) == constant);
}

TEST(InterpolationTest, AMissingEndIsMissing) {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(interpolateLinearly(missing, 1.0, 0.5)));
  EXPECT_TRUE(std::isnan(interpolateLinearly(1.0, missing, 0.25)));
}

TEST(InterpolationTest, AQuarterTurnHalfwayIsAnEighthTurn) {
  const Eigen::Vector4d none(0, 0, 0, 1);
  const Eigen::Vector4d quarter(0, 0, std::sqrt(0.5), std::sqrt(0.5));
  const Eigen::Vector4d eighth(0, 0, std::sin(kPi / 8), std::cos(kPi / 8));
  EXPECT_LT(distance(interpolateSpherically(none, quarter, 0.5), eighth), kRounding);
}

RC_GTEST_PROP(InterpolationTest, SlerpTurnsAboutTheAxisAtConstantSpeed, ()) {
  const Eigen::Vector3d axis = anyAxis();
  const double from = anyBetween(-3.0, 3.0);
  const double angle = anyBetween(-0.999 * kPi, 0.999 * kPi);
  const double fraction = anyFraction();
  const Eigen::Vector4d found = interpolateSpherically(turn(axis, from), turn(axis, from + angle), fraction);
  RC_ASSERT(distance(found, turn(axis, from + fraction * angle)) < 1e-12);
}

RC_GTEST_PROP(InterpolationTest, SlerpDependsNeitherOnTheSignNorOnTheLengthOfAQuaternion, ()) {
  const Eigen::Vector4d from = turn(anyAxis(), anyBetween(-1.0, 1.0));
  const Eigen::Vector4d to = turn(anyAxis(), anyBetween(-1.0, 1.0));
  const double fraction = anyFraction();
  const Eigen::Vector4d expected = interpolateSpherically(from, to, fraction);
  RC_ASSERT(distance(interpolateSpherically(from, -to, fraction), expected) < 1e-12);
  RC_ASSERT(distance(interpolateSpherically(3.0 * from, 0.01 * to, fraction), expected) < 1e-12);
}

RC_GTEST_PROP(InterpolationTest, SlerpAgreesWithEigen, ()) {
  const Eigen::Vector4d from = turn(anyAxis(), anyBetween(-3.0, 3.0));
  const Eigen::Vector4d to = turn(anyAxis(), anyBetween(-3.0, 3.0));
  RC_PRE(std::abs(from.dot(to)) > 1e-6);  // at half a turn both arcs are right
  const double fraction = anyFraction();
  const Eigen::Vector4d peer = Eigen::Quaterniond(from).slerp(fraction, Eigen::Quaterniond(to)).coeffs();
  RC_ASSERT(distance(interpolateSpherically(from, to, fraction), peer) < 1e-9);
}

TEST(InterpolationTest, SlerpIsAccurateBetweenNeighbours) {
  const Eigen::Vector3d axis(1, 2, 3);
  for (const double angle : {0.0, 1e-300, 1e-12, 1e-9, 2.1e-9, 1e-8, 1e-6}) {
    const Eigen::Vector4d found = interpolateSpherically(turn(axis, 0.0), turn(axis, angle), 0.25);
    const double expected = std::sin(angle / 8.0);
    EXPECT_NEAR(found.head<3>().stableNorm(), expected, 1e-7 * expected) << "neighbours " << angle << " rad apart";
  }
}

TEST(InterpolationTest, SlerpOfHalfATurnTakesOneOfTheTwoArcs) {
  const Eigen::Vector3d axis(0, 1, 0);
  for (const double off : {0.0, 1e-16, -1e-16, 1e-9, -1e-9}) {
    const Eigen::Vector4d found = interpolateSpherically(turn(axis, 0.0), turn(axis, kPi + off), 0.5);
    EXPECT_NEAR(found.norm(), 1.0, kRounding);
    EXPECT_NEAR(std::abs(found.y()), std::sin(kPi / 4), 1e-9) << "a quarter turn, one way or the other";
  }
}

TEST(InterpolationTest, AQuaternionOfZerosOrNaNHasNoOrientation) {
  const Eigen::Vector4d unit(0, 0, 0, 1);
  const Eigen::Vector4d missing = Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(interpolateSpherically(Eigen::Vector4d::Zero(), unit, 0.5).array().isNaN().all());
  EXPECT_TRUE(interpolateSpherically(unit, missing, 0.5).array().isNaN().all());
}

}  // namespace
}  // namespace demo_logger
