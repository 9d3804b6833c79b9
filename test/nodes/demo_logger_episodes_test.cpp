#include <demo_logger/Label.h>
#include <demo_logger/Start.h>
#include <demo_logger/Stop.h>
#include <sensor_msgs/Joy.h>
#include <std_srvs/Trigger.h>

#include "test/nodes/recorder_under_test.h"

// Episodes begin and end: by themselves, by services, by buttons.

namespace demo_logger {
namespace {

using EpisodesTest = RecorderUnderTest;

TEST_F(EpisodesTest, TheFirstJointStateBeginsTheFirstEpisode) {
  start();
  EXPECT_EQ(statuses_.back().state, Status::IDLE);
  move(100);
  ASSERT_TRUE(waitForRows(100));
  EXPECT_EQ(statuses_.back().state, Status::RECORDING);
  EXPECT_EQ(statuses_.back().id, "demo_000001");
  EXPECT_EQ(statuses_.back().file, output("demo_000001.csv"));
  EXPECT_NEAR(statuses_.back().rate, 500.0, 250.0);
  EXPECT_GT(statuses_.back().minutes_left, 0.0);
  process_->signal(SIGINT);
  EXPECT_EQ(process_->wait(), 0) << process_->output();
  expectCounting(read("demo_000001"), 0, 100);
  EXPECT_EQ(read("demo_000001").metadata.status, "complete");
}

TEST_F(EpisodesTest, StartAndStopBoundAnEpisodeThatKnowsItsChannelTaskAndPeople) {
  start({"_autostart:=false", "_channel:=vr", "_task:=reach", "_operator:=nobody"});
  move(20);
  Start::Request begin;
  begin.channel = "kinesthetic";
  begin.operator_name = "Ada";
  begin.notes = "first try";
  std::string id;
  // The service answers when a joint state has arrived, so one must come while it waits.
  const int before = moved_;
  ros::Timer arm = node_.createTimer(
      ros::Duration(0.005), [&](const ros::TimerEvent&) { joint_states_.publish(makeJointState(ros::Time::now())); });
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const Start::Response begun = call<Start>("start", begin);
  spinner.stop();
  EXPECT_TRUE(begun.success) << begun.message;
  EXPECT_EQ(begun.id, "demo_000001");
  ASSERT_TRUE(waitForRows(50));
  arm.stop();

  Stop::Request end;
  end.outcome = "success";
  end.notes = "went well";
  const Stop::Response ended = call<Stop>("stop", end);
  EXPECT_TRUE(ended.success) << ended.message;
  EXPECT_EQ(ended.id, "demo_000001");
  EXPECT_EQ(ended.file, output("demo_000001.csv"));
  const Demonstration demonstration = read("demo_000001");
  EXPECT_EQ(ended.rows, demonstration.time.size());
  EXPECT_GE(column(demonstration, "q_joint_1").front(), before) << "rows are those received after the request";
  EXPECT_EQ(demonstration.metadata.channel, "kinesthetic");
  EXPECT_EQ(demonstration.metadata.task, "reach") << "empty in the request: the parameter";
  EXPECT_EQ(demonstration.metadata.operator_name, "Ada");
  EXPECT_EQ(demonstration.metadata.outcome, "success");
  EXPECT_NE(demonstration.metadata.notes.find("first try"), std::string::npos);
  EXPECT_NE(demonstration.metadata.notes.find("went well"), std::string::npos);
  EXPECT_TRUE(waitForState(Status::IDLE));
}

TEST_F(EpisodesTest, AStartWithoutJointStatesFailsNamingTheTopic) {
  startBesideTheArm({"_autostart:=false", "joint_states:=/nobody/joint_states"});
  const Start::Response response = call<Start>("start");
  EXPECT_FALSE(response.success);
  EXPECT_EQ(
      response.message,
      "no JointState on /nobody/joint_states within 2 s; is the robot's driver running, and is the topic remapped "
      "(joint_states:=…)?");
  EXPECT_TRUE(waitForState(Status::IDLE));
  EXPECT_FALSE(std::filesystem::exists(output("demo_000001.csv.part")));
}

TEST_F(EpisodesTest, AStopWithNothingOpenFailsAndAStartWhileOneIsOpenToo) {
  start();
  EXPECT_FALSE(call<Stop>("stop").success);
  move(50);
  ASSERT_TRUE(waitForState(Status::RECORDING));
  const Start::Response second = call<Start>("start");
  EXPECT_FALSE(second.success);
  EXPECT_NE(second.message.find("demo_000001"), std::string::npos) << second.message;
}

TEST_F(EpisodesTest, AStoppedEpisodeKeepsEverythingReceivedBefore) {
  start();
  move(250);
  ASSERT_TRUE(waitForRows(250));
  move(50);  // these may still be waiting for stragglers when the stop comes
  ASSERT_TRUE(waitUntil([&] { return statuses_.back().rows > 250; }));
  const Stop::Response ended = call<Stop>("stop");
  EXPECT_TRUE(ended.success) << ended.message;
  expectCounting(read("demo_000001"), 0, 300);
  EXPECT_EQ(read("demo_000001").metadata.outcome, "unknown");
}

TEST_F(EpisodesTest, ADiscardedEpisodeIsMovedAsideAndNeverDeleted) {
  start();
  move(50);
  ASSERT_TRUE(waitForRows(50));
  const auto response = call<std_srvs::Trigger>("discard");
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_FALSE(std::filesystem::exists(output("demo_000001.csv")));
  expectCounting(readDemonstration(output("discarded/demo_000001.csv")).demonstration, 0, 50);
}

TEST_F(EpisodesTest, AFinishedEpisodeCanBeLabelledLater) {
  start();
  move(50);
  ASSERT_TRUE(waitForRows(50));
  ASSERT_TRUE(call<Stop>("stop").success);
  Label::Request label;
  label.outcome = "failure";
  label.task = "pour";
  const Label::Response response = call<Label>("label", label);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(read("demo_000001").metadata.outcome, "failure");
  EXPECT_EQ(read("demo_000001").metadata.task, "pour");

  label.id = "demo_000077";
  EXPECT_FALSE(call<Label>("label", label).success);
  label.id = "../../etc/passwd";
  EXPECT_FALSE(call<Label>("label", label).success);
}

TEST_F(EpisodesTest, TheLastStatusWaitsForWhoeverComesLate) {
  start();
  move(50);
  ASSERT_TRUE(waitForRows(50));
  ASSERT_TRUE(call<Stop>("stop").success);
  ASSERT_TRUE(waitForState(Status::IDLE));
  const auto late = ros::topic::waitForMessage<Status>("demo_logger/status", node_, ros::Duration(20.0));
  ASSERT_NE(late, nullptr);
  EXPECT_EQ(late->state, Status::IDLE);
  EXPECT_EQ(late->id, "demo_000001");
  EXPECT_EQ(late->rows, 50U);
}

TEST_F(EpisodesTest, TheStatusGoesFromRecordingOverSavingToIdle) {
  start();
  move(50);
  ASSERT_TRUE(waitForRows(50));
  ASSERT_TRUE(call<Stop>("stop").success);
  ASSERT_TRUE(waitForState(Status::IDLE));
  std::vector<std::string> states;
  for (const Status& status : statuses_) {
    if (states.empty() || states.back() != status.state) states.push_back(status.state);
  }
  EXPECT_EQ(states, (std::vector<std::string>{"idle", "recording", "saving", "idle"}));
}

class ButtonsTest : public RecorderUnderTest {
 protected:
  void startWithButtons() {
    ros::param::set(namespace_ + "/demo_logger/buttons/start", 0);
    ros::param::set(namespace_ + "/demo_logger/buttons/stop", 1);
    ros::param::set(namespace_ + "/demo_logger/buttons/success", 2);
    ros::param::set(namespace_ + "/demo_logger/buttons/failure", 3);
    ros::param::set(namespace_ + "/demo_logger/buttons/discard", 4);
    joy_ = node_.advertise<sensor_msgs::Joy>("joy", 10);
    start({"_autostart:=false"});
    ASSERT_TRUE(waitUntil([&] { return joy_.getNumSubscribers() > 0; }));
    arm_ = node_.createTimer(ros::Duration(0.005),
                             [&](const ros::TimerEvent&) { joint_states_.publish(makeJointState(ros::Time::now())); });
  }

  /// Down and up again.
  void press(std::size_t button) {
    sensor_msgs::Joy joy;
    joy.buttons.assign(5, 0);
    joy.buttons[button] = 1;
    joy_.publish(joy);
    joy.buttons[button] = 0;
    joy_.publish(joy);
  }

  void record() {
    press(0);
    ASSERT_TRUE(waitForState(Status::RECORDING));
    ASSERT_TRUE(waitForRows(20));
  }

  ros::Publisher joy_;
  ros::Timer arm_;
};

TEST_F(ButtonsTest, StartAndStopAreAtHand) {
  startWithButtons();
  record();
  press(1);
  ASSERT_TRUE(waitForState(Status::IDLE));
  EXPECT_EQ(read("demo_000001").metadata.outcome, "unknown");
}

TEST_F(ButtonsTest, SuccessStopsAndAFailurePressedLaterCorrectsIt) {
  startWithButtons();
  record();
  press(2);
  ASSERT_TRUE(waitForState(Status::IDLE));
  EXPECT_EQ(read("demo_000001").metadata.outcome, "success");
  press(3);
  EXPECT_TRUE(waitUntil([&] { return read("demo_000001").metadata.outcome == "failure"; }));
}

TEST_F(ButtonsTest, DiscardPutsTheOpenEpisodeAside) {
  startWithButtons();
  record();
  press(4);
  ASSERT_TRUE(waitForState(Status::IDLE));
  EXPECT_TRUE(std::filesystem::exists(output("discarded/demo_000001.csv")));
}

TEST_F(ButtonsTest, AButtonThatIsHeldDownActsOnce) {
  startWithButtons();
  sensor_msgs::Joy held;
  held.buttons.assign(5, 0);
  held.buttons[0] = 1;
  joy_.publish(held);
  ASSERT_TRUE(waitForState(Status::RECORDING));
  ASSERT_TRUE(waitForRows(20));
  held.buttons[1] = 1;  // stop as well, with start still down
  joy_.publish(held);
  ASSERT_TRUE(waitForState(Status::IDLE));
  joy_.publish(held);
  press(2);  // labels the episode; what was sent before it has been handled by then
  ASSERT_TRUE(waitUntil([&] { return read("demo_000001").metadata.outcome == "success"; }));
  EXPECT_EQ(statuses_.back().state, Status::IDLE);
}

}  // namespace
}  // namespace demo_logger
