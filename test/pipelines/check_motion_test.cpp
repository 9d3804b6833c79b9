#include <gtest/gtest.h>

#include <limits>

#include "demo_logger/pipelines/check.h"
#include "test/pipelines/sine_demonstration.h"

namespace demo_logger {
namespace {

TEST(CheckMotionTest, AJumpIsToldWithWhatTheVelocityAllows) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.col(0).tail(300).array() += 0.25;
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.kind, "jump");
  EXPECT_EQ(finding.severity, Severity::error);
  // By hand, at 2 s: velocity cos(4) = -0.6536, before it cos(3.98) = -0.6686 rad/s; step 0.25 - 0.0066 rad;
  // (2 * 0.6686 + 0.5) rad/s * (10 + 5) ms = 0.02756 rad, and twice the elbow's smallest step, 0.01 mrad at the crest.
  EXPECT_EQ(finding.sentence,
            "joint elbow jumps by 0.2434 rad within 10 ms at 2.000 s, expected at most 0.02758 rad at a velocity of "
            "0.6686 rad/s; was the encoder reset, or are two robots' states mixed?");
}

TEST(CheckMotionTest, JointsThatJumpTogetherAreToldTogether) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.leftCols(2).bottomRows(300).array() += 1.0;
  EXPECT_EQ(onlyFinding(check(demonstration)).sentence.substr(0, 27), "joint elbow and wrist jump ");
}

TEST(CheckMotionTest, AnAngleThatWrapsIsRecognised) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.col(1).tail(250).array() -= 2.0 * 3.14159265358979;
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_NE(finding.sentence.find("the angle wraps around by a full turn."), std::string::npos) << finding.sentence;
}

TEST(CheckMotionTest, StampsThatJitterAreNoJump) {
  Demonstration demonstration = makeSineDemonstration();
  for (std::size_t row = 1; row < demonstration.time.size(); row += 2) {
    demonstration.time[row] += 0.0099;  // 0.1 ms before the next row
  }
  for (const Finding& finding : check(demonstration).findings) {
    EXPECT_NE(finding.kind, "jump") << finding.sentence;
  }
}

TEST(CheckMotionTest, PositionsThatStandStillInMotionAreAStuckSensor) {
  Demonstration demonstration = makeSineDemonstration();
  for (Eigen::Index row = 301; row <= 320; ++row) {
    demonstration.values.row(row).head<2>() = demonstration.values.row(300).head<2>();
  }
  const CheckResult result = check(demonstration);
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings[0].sentence,
            "the joint positions stand still for 200 ms at 3.000 s although the velocities say that the arm moves; the "
            "driver repeats an old state.");
}

TEST(CheckMotionTest, RowsThatRepeatInMotionAreCounted) {
  Demonstration demonstration = makeSineDemonstration();
  for (Eigen::Index row = 1; row < 500; row += 2) {  // a controller at half the rate of the driver
    demonstration.values.row(row).head<4>() = demonstration.values.row(row - 1).head<4>();
  }
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.kind, "repeated_rows");
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_NE(finding.sentence.find("% of the rows repeat the joint positions of the row before while the arm moves, "
                                  "first at 0.010 s"),
            std::string::npos)
      << finding.sentence;
}

TEST(CheckMotionTest, AnArmAtRestMayRepeatItself) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.leftCols(2).setConstant(0.3);
  demonstration.values.middleCols(2, 2).setZero();
  EXPECT_TRUE(check(demonstration).findings.empty());
}

TEST(CheckMotionTest, ACoarseEncoderInSlowMotionMayRepeatItself) {
  Demonstration demonstration = makeSineDemonstration();
  constexpr double kQuantum = 0.02;  // [rad] more than a row's motion at 1 rad/s and 100 Hz
  for (Eigen::Index row = 0; row < 500; ++row) {
    for (Eigen::Index joint = 0; joint < 2; ++joint) {
      demonstration.values(row, joint) = kQuantum * std::round(demonstration.values(row, joint) / kQuantum);
    }
  }
  const CheckResult result = check(demonstration);
  EXPECT_TRUE(result.findings.empty()) << result.findings[0].sentence;
}

TEST(CheckMotionTest, VelocitiesFilledWithZerosAreToldAndNotUsed) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.middleCols(2, 2).setZero();
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.kind, "no_velocity");
  EXPECT_EQ(
      finding.sentence,
      "dq_elbow and dq_wrist are 0 in every row although the positions move by up to 1; the driver fills in zeros. "
      "Differentiate the positions instead of using the velocities.");
}

}  // namespace
}  // namespace demo_logger
