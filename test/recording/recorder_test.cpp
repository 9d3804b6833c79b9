#include "demo_logger/recording/recorder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demo_logger/formats/demonstration_file.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/recorder_fixture.h"

namespace demo_logger {
namespace {

TEST_F(RecorderTest, SamplesInRowsOnDisk) {
  make(configuration());
  EXPECT_TRUE(recorder_->start(at(0), "", "", "", "").success);
  run(0.0, 2.0);
  const Reply reply = recorder_->stop(at(2.0), "success", "");

  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(reply.message, "Saved demo_000001 with 200 rows.");
  EXPECT_EQ(reply.id, "demo_000001");
  EXPECT_EQ(reply.file, file("demo_000001.csv"));
  EXPECT_EQ(reply.rows, 200U);
  EXPECT_EQ(recorder_->finished(), std::vector<std::filesystem::path>{reply.file});
  const Table table = readTable(reply.file);
  EXPECT_EQ(table.header,
            "time,q_shoulder,q_elbow,dq_shoulder,dq_elbow,tau_shoulder,tau_elbow,receipt_delay,u_vx,u_vy,u_vz,u_wx,"
            "u_wy,u_wz,u_age");
  ASSERT_EQ(table.rows.size(), 200U);
  for (int k = 0; k < 200; ++k) {
    const std::vector<double>& row = table.rows[static_cast<std::size_t>(k)];
    EXPECT_EQ(row[0], k / 100.0);
    EXPECT_EQ(row[1], k / 100.0);
    EXPECT_EQ(row[2], -k / 100.0);
    EXPECT_TRUE(std::isnan(row[3])) << "the robot sends no velocities";
    EXPECT_EQ(row[7], 0.001) << "from stamp to receipt";
    EXPECT_EQ(row[8], k / 100.0) << "the command of the same stamp is in force";
    EXPECT_EQ(row[14], 0.0) << "and new";
  }
  const Metadata metadata = saved("demo_000001");
  EXPECT_EQ(metadata.id, "demo_000001");
  EXPECT_EQ(metadata.channel, "teleoperation");
  EXPECT_EQ(metadata.task, "pour");
  EXPECT_EQ(metadata.outcome, "success");
  EXPECT_EQ(metadata.status, "complete");
  EXPECT_EQ(metadata.start_stamp, kStart);
  EXPECT_EQ(metadata.duration, 1.99);
  EXPECT_EQ(metadata.rows, 200U);
  EXPECT_EQ(metadata.counters.at("rows"), 200U);
  EXPECT_EQ(metadata.counters.at("rows_not_written"), 0U);
  EXPECT_EQ(metadata.software, "demo_logger 0.1.0");
  ASSERT_EQ(metadata.streams.size(), 1U);
  EXPECT_EQ(metadata.streams[0].received, 200U);
  EXPECT_EQ(std::get<double>(metadata.parameters.at("clock_offset")), 0.001);
}

TEST_F(RecorderTest, WhatIsRecordedIsReadBackAsADemonstrationWithoutARemark) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  const LoadedDemonstration loaded = readDemonstration(recorder_->stop(at(1.0), "success", "").file);
  EXPECT_TRUE(loaded.notes.empty()) << loaded.notes.front();
  const Demonstration& demonstration = loaded.demonstration;
  ASSERT_EQ(demonstration.columns.size(), 14U);
  EXPECT_EQ(demonstration.columns[0].name, "q_shoulder");
  EXPECT_EQ(demonstration.columns[0].role, Role::state);
  EXPECT_EQ(demonstration.columns[7].name, "u_vx");
  EXPECT_EQ(demonstration.columns[7].role, Role::control);
  ASSERT_EQ(demonstration.time.size(), 100U);
  EXPECT_EQ(demonstration.time[99], 0.99);
  EXPECT_EQ(demonstration.values(99, 7), 0.99);
}

TEST_F(RecorderTest, AutostartBeginsWithTheFirstJointStateAndOnlyOnce) {
  RecorderConfiguration autostart = configuration();
  autostart.autostart = true;
  make(autostart);
  EXPECT_EQ(recorder_->status().state, RecorderState::idle);
  EXPECT_EQ(listing(), "") << "nothing is left behind where no robot ever publishes";
  run(0.0, 1.0);
  EXPECT_EQ(recorder_->status().state, RecorderState::recording);
  EXPECT_TRUE(recorder_->stop(at(1.0), "", "").success);
  run(1.0, 2.0);
  EXPECT_EQ(recorder_->status().state, RecorderState::idle) << "who has stopped it starts it again";
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json");
  EXPECT_EQ(secondsOf("demo_000001"), ticks(0, 1)) << "the first joint state is the first row";
}

TEST_F(RecorderTest, RowsAreThoseReceivedFromTheStartToTheStop) {
  make(configuration());
  run(0.0, 1.0);
  EXPECT_EQ(recorder_->start(at(1.0), "", "", "", "").id, "demo_000001");
  run(1.0, 2.0);
  EXPECT_EQ(recorder_->stop(at(2.0), "", "").rows, 100U);
  run(2.0, 3.0);
  EXPECT_EQ(recorder_->start(at(3.0), "", "", "", "").id, "demo_000002");
  run(3.0, 3.5);
  for (const double seconds : {3.5, 3.51, 3.52}) {
    recorder_->push(0, command(seconds));
    recorder_->push(jointState(seconds));
  }
  EXPECT_EQ(recorder_->stop(at(3.5), "", "").rows, 50U) << "what was received after the stop does not belong to it";
  EXPECT_EQ(secondsOf("demo_000001"), ticks(1, 2));
  EXPECT_EQ(secondsOf("demo_000002"), ticks(3, 3.5));
  EXPECT_EQ(saved("demo_000002").streams[0].received, 50U) << "counters are those of the episode";
}

/// A column that remembers nothing from one episode to the next, as the contract of DerivedColumns asks.
class RowCount : public DerivedColumns {
 public:
  explicit RowCount(std::string name) : name_(std::move(name)) {}
  std::vector<Column> open(const std::vector<Column>& recorded) override {
    recorded_ = recorded.size();
    rows_ = 0;
    return {{name_, "", Role::auxiliary, Interpolation::none, "rows"}};
  }
  void append(Row& row) override {
    EXPECT_EQ(row.values.size(), recorded_);
    row.values.push_back(rows_++);
  }

 private:
  std::string name_;
  std::size_t recorded_ = 0;
  int rows_ = 0;
};

TEST_F(RecorderTest, DerivedColumnsStandBehindTheRecordedOnesUnderPortableNamesAndStartAnewWithEachEpisode) {
  derived_.push_back(std::make_unique<RowCount>("row count"));
  derived_.push_back(std::make_unique<RowCount>("q_elbow"));
  make(configuration());
  for (const int episode : {1, 2}) {
    recorder_->start(at(episode), "", "", "", "");
    run(episode, episode + 0.5);
    const Reply reply = recorder_->stop(at(episode + 0.5), "", "");
    const Table table = readTable(reply.file);
    EXPECT_NE(table.header.find(",u_age,row_count,q_elbow_2"), std::string::npos) << table.header;
    ASSERT_EQ(table.rows.size(), 50U);
    EXPECT_EQ(table.rows[49][15], 49.0);
    EXPECT_EQ(table.rows[49][16], 49.0);
    const std::map<std::string, std::string> expected = {{"row_count", "row count"}, {"q_elbow_2", "q_elbow"}};
    EXPECT_EQ(saved(reply.id).original_names, expected);
  }
}

TEST_F(RecorderTest, AClockJumpEndsTheEpisodeAndWithAutostartTheNextOneTakesEveryRowAfterIt) {
  RecorderConfiguration autostart = configuration();
  autostart.autostart = true;
  make(autostart);
  run(0.0, 1.0);
  clock_skew_ = -100 * kNanosecondsPerSecond;
  run(1.0, 2.0);
  EXPECT_TRUE(recorder_->close(at(2.0)).success);
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json demo_000002.csv demo_000002.json");
  EXPECT_EQ(secondsOf("demo_000001"), ticks(0, 1));
  EXPECT_EQ(saved("demo_000001").status, "interrupted: clock jumped");
  EXPECT_EQ(secondsOf("demo_000002"), ticks(1, 2)) << "also the one that first showed the jump";
  EXPECT_EQ(saved("demo_000002").status, "complete");
  EXPECT_EQ(saved("demo_000002").start_stamp, at(1.0) + clock_skew_);
  EXPECT_EQ(recorder_->finished().size(), 2U);
}

TEST_F(RecorderTest, WithoutAutostartTheRecorderIsIdleAfterAClockJump) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  clock_skew_ = 100 * kNanosecondsPerSecond;
  run(1.0, 2.0);
  const Reply reply = recorder_->stop(at(2.0), "", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message, "Nothing is being recorded; start an episode first.");
  recorder_->close(at(2.0));
  EXPECT_EQ(secondsOf("demo_000001"), ticks(0, 1));
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json");
}

TEST_F(RecorderTest, AStopThatMeetsAClockJumpReportsTheEpisodeThatTheJumpEnded) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  clock_skew_ = 100 * kNanosecondsPerSecond;
  for (const double seconds : {1.0, 1.01, 1.02}) {
    recorder_->push(jointState(seconds));  // not advanced: the stop is the first to look at them
  }
  const Reply reply = recorder_->stop(at(1.1), "success", "");
  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(reply.id, "demo_000001");
  EXPECT_EQ(saved("demo_000001").status, "interrupted: clock jumped");
}

TEST_F(RecorderTest, APauseLongerThanSplitGapSeparatesEpisodesOfTheSameWork) {
  RecorderConfiguration split = configuration();
  split.split_gap = 0.5;
  make(split);
  recorder_->start(at(0), "kinesthetic", "stir", "Ann", "with the spoon");
  run(0.0, 1.0);
  run(1.4, 2.0);  // 0.41 s are no pause
  run(3.0, 4.0);
  run(9.0, 10.0);
  const Reply reply = recorder_->close(at(10.0));
  EXPECT_TRUE(reply.success) << reply.message;
  ASSERT_EQ(recorder_->finished().size(), 3U);
  EXPECT_EQ(secondsOf("demo_000001").size(), 160U);
  EXPECT_EQ(secondsOf("demo_000002"), ticks(3, 4));
  EXPECT_EQ(secondsOf("demo_000003"), ticks(9, 10));
  for (const char* id : {"demo_000001", "demo_000002", "demo_000003"}) {
    EXPECT_EQ(saved(id).status, "complete");
    EXPECT_EQ(saved(id).channel, "kinesthetic");
    EXPECT_EQ(saved(id).task, "stir");
    EXPECT_EQ(saved(id).notes, "with the spoon");
  }
  EXPECT_EQ(saved("demo_000002").counters.at("rows"), 100U);
}

TEST_F(RecorderTest, MessagesOfOtherJointsDoNotBridgeAPause) {
  RecorderConfiguration split = configuration();
  split.split_gap = 0.5;
  split.synchroniser.joints = {"shoulder", "elbow"};
  make(split);
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  for (double seconds = 1.0; seconds < 3.0; seconds += 0.1) {
    JointStateSample gripper = jointState(seconds);
    gripper.names = {"left_finger", "right_finger"};
    recorder_->push(gripper);
    recorder_->advance(at(seconds));
  }
  run(3.0, 4.0);
  recorder_->close(at(4.0));
  EXPECT_EQ(recorder_->finished().size(), 2U);
}

TEST_F(RecorderTest, LossesBeforeTheRecorderAreCountedInTheEpisodeInWhichTheyHappened) {
  make(configuration());
  recorder_->countLost("ring_overflow", 5);
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  recorder_->countLost("ring_overflow", 12);
  recorder_->stop(at(1.0), "", "");
  EXPECT_EQ(saved("demo_000001").counters.at("ring_overflow"), 7U);
}

TEST_F(RecorderTest, ATeleopMapThatArrivesLateIsInTheOpenEpisodeAndInLaterOnes) {
  make(configuration());
  TeleopMapMetadata map;
  map.mode = "rate";
  for (const int episode : {1, 2}) {
    recorder_->start(at(episode), "", "", "", "");
    run(episode, episode + 0.5);
    recorder_->setTeleopMap(map);
    map.mode = "pose";
    const Reply reply = recorder_->stop(at(episode + 0.5), "", "");
    ASSERT_TRUE(saved(reply.id).teleop_map.has_value());
    EXPECT_EQ(saved(reply.id).teleop_map->mode, "rate");
  }
}

TEST_F(RecorderTest, CloseSavesTheOpenEpisodeAsCompleteAndNoneBeginsAfterIt) {
  RecorderConfiguration autostart = configuration();
  autostart.autostart = true;
  make(autostart);
  run(0.0, 1.0);
  EXPECT_EQ(recorder_->close(at(1.0)).message, "Saved demo_000001 with 100 rows.");
  EXPECT_EQ(saved("demo_000001").status, "complete");
  run(1.0, 2.0);
  const Reply reply = recorder_->close(at(2.0));
  EXPECT_TRUE(reply.success);
  EXPECT_EQ(reply.message, "No episode was open.");
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json");
}

TEST_F(RecorderTest, WithoutCloseTheOpenEpisodeIsSavedAsInterrupted) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  recorder_.reset();
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json");
  EXPECT_EQ(saved("demo_000001").status, "interrupted: not finished");
  EXPECT_EQ(saved("demo_000001").streams[0].received, 100U);
}

TEST_F(RecorderTest, WhatAKilledRecorderLeftIsFinishedByTheNext) {
  std::filesystem::create_directory(directory_ / "demos");
  writeFile(file("demo_000001.csv.part"), "time,q_a\n0,1\n0.1,2\n0.2,");
  make(configuration());
  ASSERT_EQ(recorder_->recovered().size(), 1U);
  EXPECT_EQ(recorder_->recovered()[0].rows, 2U);
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json");
  EXPECT_EQ(saved("demo_000001").status, "interrupted: killed");
  EXPECT_EQ(recorder_->start(at(0), "", "", "", "").id, "demo_000002");
}

TEST_F(RecorderTest, RefusesAConfigurationNamingTheValueAndWhatWasExpected) {
  const auto messageOf = [](const RecorderConfiguration& wrong) -> std::string {
    try {
      const Recorder recorder(wrong, {});
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "";
  };
  RecorderConfiguration wrong = configuration();
  wrong.split_gap = 0.05;
  EXPECT_EQ(messageOf(wrong), "split_gap is 0.05 s, expected 0 (never) or more than max_wait, which is 0.1 s.");
  wrong = configuration();
  wrong.metadata.channel = "telepathy";
  EXPECT_EQ(messageOf(wrong), "channel is \"telepathy\", expected teleoperation, kinesthetic, vr or unknown.");
}

}  // namespace
}  // namespace demo_logger
