#include <gtest/gtest.h>

#include "demo_logger/recording/recorder.h"
#include "test/recording/recorder_fixture.h"

namespace demo_logger {
namespace {

TEST_F(RecorderTest, StartRefusesAnUnknownChannelNamingThoseItKnows) {
  make(configuration());
  const Reply reply = recorder_->start(at(0), "telepathy", "", "", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message, "channel is \"telepathy\", expected teleoperation, kinesthetic, vr or unknown.");
  EXPECT_EQ(recorder_->status().state, RecorderState::idle);
  EXPECT_EQ(listing(), "");
}

TEST_F(RecorderTest, StartTellsTheIdAtOnceAndRefusesASecondEpisode) {
  make(configuration());
  const Reply first = recorder_->start(at(0), "vr", "stir", "Ann", "");
  EXPECT_TRUE(first.success);
  EXPECT_EQ(first.message, "Recording demo_000001.");
  EXPECT_EQ(first.file, file("demo_000001.csv"));
  const Reply second = recorder_->start(at(0), "", "", "", "");
  EXPECT_FALSE(second.success);
  EXPECT_EQ(second.message, "demo_000001 is being recorded; stop or discard it before the next start.");
  run(0.0, 0.5);
  recorder_->stop(at(0.5), "", "");
  EXPECT_EQ(saved("demo_000001").channel, "vr");
  EXPECT_EQ(saved("demo_000001").task, "stir");
  EXPECT_EQ(saved("demo_000001").operator_name, "Ann");
}

TEST_F(RecorderTest, StopWhileIdleFails) {
  make(configuration());
  const Reply reply = recorder_->stop(at(0), "success", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message, "Nothing is being recorded; start an episode first.");
}

TEST_F(RecorderTest, StopWithAnUnknownOutcomeFailsAndTheEpisodeGoesOn) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  const Reply reply = recorder_->stop(at(1.0), "great", "lost notes");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message, "outcome is \"great\", expected success, failure or unknown.");
  EXPECT_EQ(recorder_->status().state, RecorderState::recording);
  run(1.0, 2.0);
  EXPECT_EQ(recorder_->stop(at(2.0), "failure", "").rows, 200U);
  EXPECT_EQ(saved("demo_000001").outcome, "failure");
  EXPECT_EQ(saved("demo_000001").notes, "");
}

TEST_F(RecorderTest, NotesOfTheStopAreAddedToThoseOfTheStart) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "with the red cup");
  run(0.0, 0.5);
  recorder_->stop(at(0.5), "", "spilt some");
  EXPECT_EQ(saved("demo_000001").notes, "with the red cup\nspilt some");
}

TEST_F(RecorderTest, AnEpisodeWithoutARowLeavesNoFileAndTheStopNamesTheTopic) {
  RecorderConfiguration named = configuration();
  named.joint_states_topic = "/arm/joint_states";
  make(named);
  recorder_->start(at(0), "", "", "", "");
  Reply reply = recorder_->stop(at(5.0), "success", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message,
            "demo_000001 has no row and left no file: no joint state has arrived on /arm/joint_states. Is the robot "
            "publishing, and on this topic?");
  EXPECT_EQ(listing(), "");

  run(5.0, 6.0);
  EXPECT_EQ(recorder_->start(at(6.0), "", "", "", "").id, "demo_000001") << "the number was given back";
  reply = recorder_->stop(at(7.0), "success", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message,
            "demo_000001 has no row and left no file: no joint state with the arm's joints has arrived on "
            "/arm/joint_states since the start. Is the robot publishing, and are these its joints?");
  EXPECT_EQ(listing(), "");
}

TEST_F(RecorderTest, DiscardMovesTheOpenEpisodeAsideAndThenTheOneBeforeIt) {
  make(configuration());
  for (const int episode : {1, 2}) {
    recorder_->start(at(episode), "", "", "", "");
    run(episode, episode + 0.5);
    if (episode == 1) recorder_->stop(at(1.5), "", "");
  }
  Reply reply = recorder_->discard(at(2.5));
  EXPECT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(reply.id, "demo_000002");
  EXPECT_EQ(reply.rows, 50U);
  EXPECT_EQ(reply.file, file("discarded/demo_000002.csv"));
  EXPECT_EQ(reply.message, "Discarded demo_000002; its data are kept in " + reply.file.string() + ".");
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json discarded");
  EXPECT_EQ(recorder_->status().state, RecorderState::idle);

  reply = recorder_->discard(at(3.0));
  EXPECT_EQ(reply.id, "demo_000001");
  EXPECT_TRUE(recorder_->finished().empty());
  EXPECT_EQ(listing("discarded"), "demo_000001.csv demo_000001.json demo_000002.csv demo_000002.json");

  reply = recorder_->discard(at(3.0));
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message, "There is no episode to discard: this recorder has none.");
}

TEST_F(RecorderTest, DiscardOfAnEpisodeWithoutARowSparesTheOneBeforeIt) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 0.5);
  recorder_->stop(at(0.5), "", "");
  recorder_->start(at(1.0), "", "", "", "");
  const Reply reply = recorder_->discard(at(1.5));
  EXPECT_TRUE(reply.success);
  EXPECT_EQ(reply.message, "Discarded demo_000002, which had no row yet and left no file.");
  EXPECT_EQ(listing(), "demo_000001.csv demo_000001.json");
}

TEST_F(RecorderTest, LabelChangesTheOpenTheLastOrANamedEpisode) {
  make(configuration());
  Reply reply = recorder_->label("", "success", "", "", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message, "There is no episode to label: this recorder has none yet. Give the id of one in " +
                               file("").parent_path().string() + ".");

  recorder_->start(at(0), "", "", "", "");
  EXPECT_EQ(recorder_->label("", "success", "", "Ann", "").id, "demo_000001");
  run(0.0, 0.5);
  recorder_->stop(at(0.5), "", "");
  EXPECT_EQ(saved("demo_000001").outcome, "success") << "an empty outcome at the stop changes nothing";
  EXPECT_EQ(saved("demo_000001").operator_name, "Ann");
  EXPECT_EQ(saved("demo_000001").task, "pour");

  reply = recorder_->label("", "failure", "", "", "on closer look, spilt");
  EXPECT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(reply.message, "Labelled demo_000001.");
  EXPECT_EQ(reply.file, file("demo_000001.csv"));
  EXPECT_EQ(saved("demo_000001").outcome, "failure");
  EXPECT_EQ(saved("demo_000001").notes, "on closer look, spilt");

  recorder_->start(at(1.0), "", "", "", "");
  run(1.0, 1.5);
  EXPECT_TRUE(recorder_->label("demo_000001", "unknown", "", "", "").success);
  recorder_->stop(at(1.5), "", "");
  EXPECT_EQ(saved("demo_000001").outcome, "unknown");
  EXPECT_EQ(saved("demo_000002").outcome, "unknown");
}

TEST_F(RecorderTest, LabelRefusesWhatIsNoOutcomeAndWhatIsNoEpisode) {
  make(configuration());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 0.5);
  EXPECT_EQ(recorder_->label("", "great", "", "", "").message,
            "outcome is \"great\", expected success, failure or unknown.");
  EXPECT_EQ(recorder_->label("../x", "success", "", "", "").message,
            "\"../x\" is not the id of an episode; expected letters, digits, _ and - alone, as in demo_000001.");
  EXPECT_EQ(recorder_->label("", "", "", "", "").message,
            "Nothing was changed: outcome, task, operator_name and notes are all empty.");
  EXPECT_EQ(recorder_->label("demo_000007", "success", "", "", "").message,
            file("").parent_path().string() + " has no finished episode demo_000007, expected a file demo_000007.csv.");
}

TEST_F(RecorderTest, StatusTellsRowsRateAndFile) {
  make(configuration());
  EXPECT_EQ(recorder_->status().minutes_left, std::numeric_limits<double>::infinity());
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 2.0);
  RecorderStatus status = recorder_->status();
  EXPECT_EQ(status.state, RecorderState::recording);
  EXPECT_EQ(status.id, "demo_000001");
  EXPECT_EQ(status.file, file("demo_000001.csv"));
  EXPECT_GT(status.rows, 180U) << "all but those within max_wait are final";
  EXPECT_NEAR(status.rate, 100.0, 1e-9);
  recorder_->stop(at(2.0), "", "");
  status = recorder_->status();
  EXPECT_EQ(status.state, RecorderState::idle);
  EXPECT_EQ(status.id, "demo_000001");
  EXPECT_EQ(status.rows, 200U);
  EXPECT_EQ(status.duration, 1.99);
}

}  // namespace
}  // namespace demo_logger
