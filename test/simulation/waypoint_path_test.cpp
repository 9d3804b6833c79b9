#include "src/simulation/waypoint_path.h"

#include <gtest/gtest.h>

#include <cmath>

namespace demo_logger {
namespace {

Eigen::Isometry3d makeStart() {
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
  start.translation() << 0.5, 0.0, 0.4;
  start.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return start;
}

const Waypoint kAside{{0.0, 0.2, 0.0}, {0.0, 0.0, 0.5}, 2.0};
const Waypoint kDown{{0.0, 0.2, -0.1}, {0.0, 0.3, 0.5}, 1.0};

TEST(WaypointPathTest, RestsInTheFirstPoseBeforeAndInTheLastPoseAfter) {
  const WaypointPath path(makeStart(), {kAside, kDown});
  EXPECT_DOUBLE_EQ(path.duration(), 3.0);
  EXPECT_TRUE(path.at(-1.0).pose.isApprox(makeStart()));
  EXPECT_TRUE(path.at(-1.0).twist.isZero(0.0));
  EXPECT_TRUE(path.at(5.0).pose.translation().isApprox(makeStart().translation() + kDown.shift));
  EXPECT_TRUE(path.at(5.0).twist.isZero(0.0));
}

TEST(WaypointPathTest, IsHalfWayAtHalfTimeWithThePeakVelocityOfMinimumJerk) {
  const ToolPoint middle = WaypointPath(makeStart(), {kAside}).at(1.0);
  EXPECT_TRUE(middle.pose.translation().isApprox(makeStart().translation() + kAside.shift / 2.0));
  EXPECT_NEAR(middle.twist[1], 15.0 / 8.0 * 0.2 / 2.0, 1e-15) << "15/8 of the mean velocity";
  EXPECT_NEAR(middle.twist[5], 15.0 / 8.0 * 0.5 / 2.0, 1e-12);
}

TEST(WaypointPathTest, WithAnOverlapOneMovementRunsIntoTheNext) {
  const WaypointPath path(makeStart(), {kAside, kDown}, 0.5);
  EXPECT_DOUBLE_EQ(path.duration(), 2.0) << "the second begins half-way through the first";
  EXPECT_TRUE(path.at(1.0).pose.isApprox(WaypointPath(makeStart(), {kAside}).at(1.0).pose));
  const ToolPoint both = path.at(1.5);
  EXPECT_GT(both.twist[1], 0.01) << "aside and down at once";
  EXPECT_LT(both.twist[2], -0.01);
  EXPECT_TRUE(path.at(2.0).pose.isApprox(WaypointPath(makeStart(), {kAside, kDown}).at(3.0).pose));
}

TEST(WaypointPathTest, ItsTwistIsTheDerivativeOfItsPose) {
  for (const double overlap : {0.0, 0.6}) {
    const WaypointPath path(makeStart(), {kAside, kDown}, overlap);
    const double step = 1e-6;
    for (double time = 0.05; time < 3.0; time += 0.1) {
      const ToolPoint before = path.at(time - step);
      const ToolPoint after = path.at(time + step);
      Eigen::Matrix<double, 6, 1> derivative;
      derivative << (after.pose.translation() - before.pose.translation()) / (2.0 * step),
          rotationVector(after.pose.linear() * before.pose.linear().transpose()) / (2.0 * step);
      EXPECT_TRUE((path.at(time).twist - derivative).isZero(1e-6)) << "at " << time << " s";
    }
  }
}

}  // namespace
}  // namespace demo_logger
