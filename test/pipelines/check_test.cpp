#include "demo_logger/pipelines/check.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>

#include "demo_logger/formats/demonstration_file.h"
#include "test/pipelines/sine_demonstration.h"

namespace demo_logger {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

TEST(CheckTest, AGoodRecordingHasNothingToFind) {
  const CheckResult result = check(makeSineDemonstration());
  EXPECT_TRUE(result.findings.empty()) << result.findings[0].sentence;
  EXPECT_FALSE(hasErrors(result));
}

TEST(CheckTest, TheSummaryGivesRateGapsAgesAndMissingValues) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values(0, 6) = kMissing;
  demonstration.values(1, 6) = 0.0;
  demonstration.values(2, 6) = 0.05;
  removeRows(demonstration, 100, 3);
  const CheckSummary summary = check(demonstration).summary;
  EXPECT_EQ(summary.rows, 497U);
  EXPECT_DOUBLE_EQ(summary.duration, 4.99);
  EXPECT_DOUBLE_EQ(summary.mean_rate, 496 / 4.99);
  EXPECT_NEAR(summary.median_period, 0.01, 1e-12);
  EXPECT_NEAR(summary.largest_gap, 0.04, 1e-12) << "three rows taken out of 10 ms each";
  EXPECT_DOUBLE_EQ(summary.largest_gap_at, 0.99);
  EXPECT_EQ(summary.ages.at("u_age").min, 0.0);
  EXPECT_EQ(summary.ages.at("u_age").median, 0.02);
  EXPECT_EQ(summary.ages.at("u_age").max, 0.05);
  EXPECT_EQ(summary.receipt_delay->median, 0.002);
  EXPECT_EQ(summary.missing, (std::map<std::string, double>{{"u_age", 1.0 / 497}}));
}

TEST(CheckTest, TheMedianOfAnEvenNumberLiesBetweenTheMiddleTwo) {
  Demonstration demonstration = makeSineDemonstration();
  for (int row = 0; row < 500; ++row) {
    demonstration.values(row, 6) = row < 250 ? 0.01 : 0.03;
  }
  EXPECT_DOUBLE_EQ(check(demonstration).summary.ages.at("u_age").median, 0.02);
}

TEST(CheckTest, AGapIsToldWithItsLengthAndWhatWasExpected) {
  Demonstration demonstration = makeSineDemonstration();
  removeRows(demonstration, 100, 6);
  const Finding gap = onlyFinding(check(demonstration));
  EXPECT_EQ(gap.kind, "gap");
  EXPECT_EQ(gap.severity, Severity::warning);
  EXPECT_EQ(gap.sentence,
            "no rows for 70 ms at 0.990 s, expected one every 10 ms; joint states were lost on the way, or the arm's "
            "driver paused.");
}

TEST(CheckTest, AGapOfFivePeriodsIsStillUsual) {
  Demonstration demonstration = makeSineDemonstration();
  removeRows(demonstration, 100, 3);
  EXPECT_TRUE(check(demonstration).findings.empty());
}

TEST(CheckTest, ALongGapIsAnError) {
  Demonstration demonstration = makeSineDemonstration();
  removeRows(demonstration, 100, 50);
  EXPECT_TRUE(hasErrors(check(demonstration)));
}

TEST(CheckTest, ManyGapsAreToldThreeTimesAndThenCounted) {
  Demonstration demonstration = makeSineDemonstration();
  for (int first = 20; first < 400; first += 40) {
    removeRows(demonstration, first, 6);
  }
  const CheckResult result = check(demonstration);
  ASSERT_EQ(result.findings.size(), 4U);
  EXPECT_EQ(result.findings[3].sentence, "and 7 more of this kind.");
}

TEST(CheckTest, ARecordingOfOneRowHasNoRate) {
  Demonstration demonstration = makeSineDemonstration();
  removeRows(demonstration, 1, 499);
  const CheckResult result = check(demonstration);
  EXPECT_EQ(onlyFinding(result).sentence,
            "the recording has 1 row, expected at least two; was it stopped at once, or does the arm publish nothing?");
  EXPECT_TRUE(hasErrors(result));
  EXPECT_EQ(result.summary.mean_rate, 0.0);
}

TEST(CheckTest, ClocksThatDifferAreSuspectedFromTheReceiptDelay) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.col(4).setConstant(-0.35);
  EXPECT_EQ(
      onlyFinding(check(demonstration)).sentence,
      "joint states reached the recorder 350 ms before their stamps (median), expected from -20 ms to 100 ms; the "
      "clocks of the two machines differ, or the driver stamps late or early.");
}

TEST(CheckTest, JointStatesThatCameLateAreCounted) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values(7, 4) = 0.4;
  EXPECT_EQ(onlyFinding(check(demonstration)).sentence,
            "1 joint state came more than 100 ms later than the usual 2 ms, up to 400 ms; the network or this machine "
            "was busy, so commands from that time may be missing.");
}

TEST(CheckTest, MissingValuesOfAStateAreAnErrorAboveOnePercent) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.col(0).segment(50, 5).setConstant(kMissing);
  EXPECT_EQ(onlyFinding(check(demonstration)).severity, Severity::warning) << "5 of 500 are 1 %";
  demonstration.values(80, 0) = kMissing;
  const Finding missing = onlyFinding(check(demonstration));
  EXPECT_EQ(missing.severity, Severity::error);
  EXPECT_EQ(missing.sentence,
            "column q_elbow is missing in 6 rows (1.2 %), first at 0.500 s, expected a value in each; messages were "
            "lost, came too late, or carried NaN.");
}

TEST(CheckTest, AnObserverMaySettleButNotStartAnewUnnoticed) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.columns.push_back({"tau_h_elbow", "N m", Role::auxiliary, Interpolation::linear, "observer"});
  demonstration.values.conservativeResize(Eigen::NoChange, demonstration.values.cols() + 1);
  demonstration.values.rightCols<1>().setConstant(0.5);
  demonstration.values.rightCols<1>().head(10).setConstant(kMissing);
  EXPECT_TRUE(check(demonstration).findings.empty());
  demonstration.values.rightCols<1>().segment(300, 10).setConstant(kMissing);
  EXPECT_EQ(onlyFinding(check(demonstration)).sentence.rfind("column tau_h_elbow is missing in 10 rows", 0), 0U);
}

TEST(CheckTest, ColumnsWithoutAnyValueAreToldTogether) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.values.middleCols(2, 2).setConstant(kMissing);
  const Finding finding = onlyFinding(check(demonstration));
  EXPECT_EQ(finding.severity, Severity::warning);
  EXPECT_EQ(
      finding.sentence,
      "no row has a value of dq_elbow and dq_wrist, expected some in a state or control; the robot or device does "
      "not send them. Leave the columns out, or derive them.");
}

TEST(CheckTest, ARobotWithoutTorqueSensorsIsNoFinding) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.columns[4] = {"tau_elbow", "N m", Role::auxiliary, Interpolation::linear, ""};
  demonstration.values.col(4).setConstant(kMissing);
  const CheckResult result = check(demonstration);
  EXPECT_TRUE(result.findings.empty());
  EXPECT_EQ(result.summary.missing.at("tau_elbow"), 1.0);
}

TEST(CheckTest, AnOrientationMustBeAUnitQuaternion) {
  Demonstration demonstration = makeSineDemonstration();
  const auto rows = demonstration.values.rows();
  demonstration.values.conservativeResize(Eigen::NoChange, 11);
  demonstration.values.rightCols(4).setConstant(0.5);
  for (const char* name : {"hand_qx", "hand_qy", "hand_qz", "hand_qw"}) {
    demonstration.columns.push_back({name, "", Role::auxiliary, Interpolation::slerp, ""});
  }
  EXPECT_TRUE(check(demonstration).findings.empty());
  demonstration.values.row(rows - 1).tail(4) << 0, 0, 0, 0.9;
  EXPECT_EQ(
      onlyFinding(check(demonstration)).sentence,
      "orientation hand_qx … qw is no unit quaternion in 1 row, first at 4.990 s with length 0.9, expected 1; did "
      "its publisher leave it zero, or average quaternions?");
}

TEST(CheckTest, WhatTheRecorderNotedIsPassedOn) {
  Demonstration demonstration = makeSineDemonstration();
  demonstration.metadata.status = "interrupted: killed";
  demonstration.metadata.start_stamp = 100 * kNanosecondsPerSecond;
  demonstration.metadata.counters = {{"rows", 500}, {"late_rows", 3}, {"overflow", 1}, {"gremlins", 2}};
  StreamMetadata stream;
  stream.name = "teleop_cmd";
  stream.topic = "/teleop_cmd";
  stream.received = 40;
  stream.late = 2;
  stream.dropped = 1;
  demonstration.metadata.streams = {stream};
  demonstration.metadata.faults = {
      {100 * kNanosecondsPerSecond + 1'500'000'000, "joint states changed their frame_id", 3, Severity::warning}};
  CheckLimits limits;
  limits.shown = 10;
  std::vector<std::string> sentences;
  for (const Finding& finding : check(demonstration, limits).findings) {
    sentences.push_back((finding.severity == Severity::error ? "E " : "W ") + finding.sentence);
  }
  EXPECT_EQ(
      sentences,
      (std::vector<std::string>{
          "E the recording is interrupted: killed; its last moments may be missing, so the task may not have been "
          "finished.",
          "W counter gremlins is 2, expected 0.",
          "W counter late_rows is 3, expected 0: joint states came after later ones had become rows and are lost; a "
          "longer "
          "max_wait gives them time.",
          "E counter overflow is 1, expected 0: messages found the recorder's queue full and are lost; was the machine "
          "overloaded?",
          "W stream teleop_cmd (/teleop_cmd): 2 of 40 messages came too late for the rows they belong to; a longer "
          "max_wait gives them time.",
          "W stream teleop_cmd (/teleop_cmd): 1 of 40 messages were dropped; the faults say why.",
          "W the recorder noted at 1.500 s and 2 times more: joint states changed their frame_id."}));
}

// Whatever a file may hold, check says it in numbers; it never fails.
TEST(CheckTest, AnyValuesCanBeChecked) {
  std::mt19937 generator(11);
  const double values[] = {0.0, -1.0, 1e300, -1e300, 5e-324, kMissing};
  for (int trial = 0; trial < 300; ++trial) {
    Demonstration demonstration = makeSineDemonstration();
    removeRows(demonstration, 0, static_cast<int>(generator() % 500));
    for (std::uint32_t i = generator() % 1000; i > 0; --i) {
      demonstration.values(static_cast<Eigen::Index>(generator() % demonstration.time.size()),
                           static_cast<Eigen::Index>(generator() % 7)) = values[generator() % 6];
    }
    for (const Finding& finding : check(demonstration).findings) {
      for (const char* no_number : {"nan ", "inf ", "nan%", "inf%"}) {
        EXPECT_EQ(finding.sentence.find(no_number), std::string::npos) << finding.sentence;
      }
    }
  }
}

TEST(CheckTest, TheGapOfARealHandGuidedDemonstrationIsFound) {
  const char* data = std::getenv("DEMO_LOGGER_DATA");
  if (data == nullptr) {
    GTEST_SKIP() << "DEMO_LOGGER_DATA does not name a folder of recordings";
  }
  const auto file = std::filesystem::path(data) / "sawyer_pose_demo2.csv";
  const CheckResult result = check(readDemonstration(file).demonstration);
  EXPECT_EQ(result.summary.rows, 557U);
  EXPECT_EQ(onlyFinding(result).sentence,
            "no rows for 636.5 ms at 5.702 s, expected one every 9.999 ms; joint states were lost on the way, or the "
            "arm's driver paused.");
}

}  // namespace
}  // namespace demo_logger
