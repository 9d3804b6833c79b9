#include <gtest/gtest.h>

#include <limits>

#include "demo_logger/pipelines/check.h"
#include "test/pipelines/sine_demonstration.h"

namespace demo_logger {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr Eigen::Index kCommand = 5;
constexpr Eigen::Index kAge = 6;

void removeCommands(Demonstration& demonstration, Eigen::Index rows) {
  demonstration.values.block(0, kCommand, rows, 2).setConstant(kMissing);
}

TEST(CheckCommandsTest, RowsBeforeTheFirstCommandAreUsual) {
  Demonstration demonstration = makeSineDemonstration();
  removeCommands(demonstration, 50);
  EXPECT_TRUE(check(demonstration).findings.empty()) << "10 % of the rows";
}

TEST(CheckCommandsTest, ManyRowsWithoutACommandAreAnError) {
  Demonstration demonstration = makeSineDemonstration();
  removeCommands(demonstration, 200);
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.severity, Severity::error);
  EXPECT_EQ(
      finding.sentence,
      "stream u: 40 % of the rows have no command, expected at most 10 % before the first; did the recording begin "
      "long before the demonstrator?");
}

TEST(CheckCommandsTest, ARecordingWithoutAnyCommandIsAnError) {
  Demonstration demonstration = makeSineDemonstration();
  removeCommands(demonstration, 500);
  const CheckResult result = check(demonstration);
  ASSERT_FALSE(result.findings.empty());
  EXPECT_EQ(result.findings[0].sentence,
            "stream u: no row has a command; was the device off, its topic another one, or its clock far away?");
  EXPECT_TRUE(result.summary.ages.empty());
}

TEST(CheckCommandsTest, AHandThatGuidesTheArmNeedsNoCommand) {
  Demonstration demonstration = makeSineDemonstration();
  removeCommands(demonstration, 500);
  demonstration.metadata.channel = "kinesthetic";
  EXPECT_TRUE(check(demonstration).findings.empty());
}

TEST(CheckCommandsTest, OldCommandsAreToldWithTheirShareAndTheOldest) {
  Demonstration demonstration = makeSineDemonstration();
  for (Eigen::Index row = 100; row < 200; ++row) {
    demonstration.values(row, kAge) = 0.02 + 0.01 * static_cast<double>(row - 100);
  }
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.severity, Severity::error);
  EXPECT_EQ(
      finding.sentence,
      "stream u: 10.2 % of the rows hold a command older than 500 ms, first at 1.490 s, the oldest 1.01 s at 1.990 "
      "s; the device stopped sending while the arm went on.");
}

TEST(CheckCommandsTest, AnOldCommandInAFewRowsIsAWarning) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values(100, kAge) = 0.6;
  EXPECT_EQ(onlyFinding(check(demonstration)).severity, Severity::warning);
}

TEST(CheckCommandsTest, AButtonMayBePressedLongAgo) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.columns[5] = {"pad_button0", "", Role::auxiliary, Interpolation::hold, ""};
  demonstration.columns[6].name = "pad_age";
  demonstration.values.col(kAge).setConstant(3.0);
  EXPECT_TRUE(check(demonstration).findings.empty());
}

TEST(CheckCommandsTest, AHeldCommandFromTheFutureIsAnError) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values(100, kAge) = -0.003;
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.severity, Severity::error);
  EXPECT_EQ(
      finding.sentence,
      "stream u: a message from the future stands in 1 row, by up to 3 ms, first at 1.000 s; expected ages of 0 s or "
      "more. Was the file changed after the recording?");
}

TEST(CheckCommandsTest, TheNearestMessageMayBeALaterOne) {
  Demonstration demonstration = makeSineDemonstration();
  StreamMetadata stream;
  stream.name = "teleop_cmd";
  stream.align = "nearest";
  demonstration.metadata.streams = {stream};
  demonstration.values(100, kAge) = -0.003;
  EXPECT_TRUE(check(demonstration).findings.empty());
}

TEST(CheckCommandsTest, ValuesMissingBesideAnAgeAreToldThoseBeforeTheFirstMessageAreNot) {
  Demonstration demonstration = makeSineDemonstration();
  removeCommands(demonstration, 20);
  demonstration.values(30, kCommand) = kMissing;
  EXPECT_EQ(
      onlyFinding(check(demonstration)).sentence,
      "column u_vx is missing in 1 row (0.2083 %), first at 0.300 s, expected a value in each; messages were lost, "
      "came too late, or carried NaN.")
      << "1 of the 480 rows that had a message";
}

}  // namespace
}  // namespace demo_logger
