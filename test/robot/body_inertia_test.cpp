#include "src/robot/body_inertia.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

BodyInertia solidBox(double mass, const Eigen::Vector3d& size) {
  BodyInertia box;
  box.mass = mass;
  const Eigen::Vector3d squares = size.cwiseAbs2();
  box.inertia.diagonal() << squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y();
  box.inertia *= mass / 12.0;
  return box;
}

TEST(BodyInertiaTest, TwoHalvesOfABoxLumpIntoTheBox) {
  const BodyInertia whole = solidBox(6.0, {0.8, 0.3, 0.2});
  const BodyInertia half = solidBox(3.0, {0.4, 0.3, 0.2});

  const BodyInertia left = movedTo(Eigen::Isometry3d(Eigen::Translation3d(-0.2, 0.0, 0.0)), half);
  const BodyInertia right = movedTo(Eigen::Isometry3d(Eigen::Translation3d(0.2, 0.0, 0.0)), half);
  const BodyInertia both = lumped(left, right);

  EXPECT_DOUBLE_EQ(both.mass, 6.0);
  EXPECT_TRUE(both.center.isZero(1e-15));
  EXPECT_TRUE(both.inertia.isApprox(whole.inertia, 1e-14));
}

TEST(BodyInertiaTest, AQuarterTurnExchangesTheMoments) {
  const BodyInertia box = solidBox(6.0, {0.8, 0.3, 0.2});
  const Eigen::Isometry3d quarter_turn(Eigen::AngleAxisd(M_PI / 2.0, Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(movedTo(quarter_turn, box).inertia.isApprox(solidBox(6.0, {0.3, 0.8, 0.2}).inertia, 1e-14));
}

TEST(BodyInertiaTest, NothingAddedChangesNothing) {
  BodyInertia box = solidBox(2.0, {0.1, 0.2, 0.3});
  box.center = {1.0, 2.0, 3.0};
  const BodyInertia sum = lumped(BodyInertia(), box);
  EXPECT_EQ(sum.mass, box.mass);
  EXPECT_TRUE(sum.center.isApprox(box.center, 1e-15));
  EXPECT_TRUE(sum.inertia.isApprox(box.inertia, 1e-15));
  EXPECT_EQ(lumped(BodyInertia(), BodyInertia()).mass, 0.0);
}

TEST(BodyInertiaTest, PointsRodsPlatesAndBoxesArePossible) {
  BodyInertia point;
  point.mass = 1.0;
  EXPECT_EQ(impossibility(point), "");
  EXPECT_EQ(impossibility(solidBox(1.0, {0.0, 0.0, 0.5})), "") << "rod";
  EXPECT_EQ(impossibility(solidBox(1.0, {0.4, 0.0, 0.5})), "") << "plate";
  EXPECT_EQ(impossibility(solidBox(1.0, {0.4, 0.3, 0.5})), "") << "box";
  EXPECT_EQ(impossibility(BodyInertia()), "") << "no matter at all";
}

TEST(BodyInertiaTest, RoundingIsForgiven) {
  BodyInertia body;
  body.mass = 0.05;
  body.inertia.diagonal() << 0.0, 0.0, 1e-6;  // printed with six decimals
  EXPECT_EQ(implausibility(body), "");
  body.inertia.diagonal() << -1e-20, 0.0, 1e-20;  // a point mass, turned
  EXPECT_EQ(implausibility(body), "");
}

TEST(BodyInertiaTest, AFewPerCentBeyondThePossibleAreDoubtfulOnly) {
  BodyInertia body;
  body.mass = 1.0;
  body.inertia.diagonal() << 1.0, 1.0, 2.1;
  EXPECT_EQ(impossibility(body), "");
  EXPECT_EQ(implausibility(body),
            "principal moments of inertia 1, 1, 2.1 kg m², which no body has: the largest may not exceed the sum of "
            "the other two");
}

TEST(BodyInertiaTest, SaysWhatIsImpossible) {
  BodyInertia body;
  body.mass = 1.0;
  body.inertia.diagonal() << 1.0, 2.0, 4.0;
  EXPECT_EQ(impossibility(body),
            "principal moments of inertia 1, 2, 4 kg m², which no body has: the largest may not exceed the sum of the "
            "other two");
  body.inertia.diagonal() << -0.5, 2.0, 2.0;
  EXPECT_EQ(impossibility(body),
            "principal moments of inertia -0.5, 2, 2 kg m², which no body has: none may be negative");
  body.mass = -2.0;
  EXPECT_EQ(impossibility(body), "mass -2 kg, expected a positive one");
  body.mass = 0.0;
  EXPECT_EQ(impossibility(body), "inertia without mass");
}

}  // namespace
}  // namespace demo_logger
