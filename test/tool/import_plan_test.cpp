#include "src/tool/import_plan.h"

#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>

#include "demo_logger/trajectory/error.h"
#include "test/tool/temporary_directory.h"

namespace demo_logger {
namespace {

class ImportPlanTest : public testing::Test {
 public:
  ImportPlanTest() : path_(directory_ / "teleoperation.bag"), bag_(path_.string(), rosbag::bagmode::Write) {}

  template <class Message>
  ImportPlanTest& with(const std::string& topic) {
    bag_.write(topic, ros::Time(1, 0), Message());
    return *this;
  }

  ImportPlan plan(const std::vector<StreamConfiguration>& streams = {},
                  const std::optional<std::string>& joint_states = std::nullopt) {
    bag_.close();
    return planImport(BagReader(path_), joint_states, streams);
  }

  std::string refusal(const std::vector<StreamConfiguration>& streams = {},
                      const std::optional<std::string>& joint_states = std::nullopt) {
    try {
      plan(streams, joint_states);
    } catch (const FileError& error) {
      return error.what();
    }
    return "nothing was thrown";
  }

  static StreamConfiguration stream(const std::string& name, const std::string& topic) {
    StreamConfiguration configuration;
    configuration.name = name;
    configuration.topic = topic;
    return configuration;
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_;
  rosbag::Bag bag_;
};

using JointState = sensor_msgs::JointState;

TEST_F(ImportPlanTest, JointStatesOfTheUsualTopicAreTakenWithoutAWord) {
  const ImportPlan found = with<JointState>("/joint_states").with<JointState>("/gripper/joint_states").plan();
  EXPECT_EQ(found.joint_states, "/joint_states");
  EXPECT_EQ(found.notes, std::vector<std::string>{"left out: /gripper/joint_states (sensor_msgs/JointState, 1)"});
}

TEST_F(ImportPlanTest, TheOnlyJointStatesAreTakenAndSaid) {
  const ImportPlan found = with<JointState>("/arm/state").plan();
  EXPECT_EQ(found.joint_states, "/arm/state");
  EXPECT_EQ(found.notes, std::vector<std::string>{"joint states from /arm/state, the only ones in the bag"});
}

TEST_F(ImportPlanTest, SeveralJointStatesAreNotGuessedBetween) {
  EXPECT_EQ(with<JointState>("/a").with<JointState>("/b").refusal(),
            path_.string() +
                ": several topics with joint states, /a (sensor_msgs/JointState, 1), /b (sensor_msgs/JointState, 1); "
                "choose one with --joint-states");
}

TEST_F(ImportPlanTest, ABagWithoutJointStatesIsRefusedWithTheTopicsThatExist) {
  EXPECT_EQ(with<geometry_msgs::Twist>("/cmd_vel").with<std_msgs::String>("/chat").refusal(),
            path_.string() +
                ": no joint states (sensor_msgs/JointState) to make rows of; it holds /chat (std_msgs/String, 1), "
                "/cmd_vel (geometry_msgs/Twist, 1)");
}

TEST_F(ImportPlanTest, AnEmptyBagSaysSo) {
  EXPECT_EQ(refusal(), path_.string() + ": holds no messages, nothing to import");
}

TEST_F(ImportPlanTest, TheTopicAskedForMustExistAndCarryJointStates) {
  with<JointState>("/arm/state").with<std_msgs::String>("/chat");
  EXPECT_EQ(plan({}, "arm/state").joint_states, "/arm/state") << "a leading slash may be left out";
}

TEST_F(ImportPlanTest, AMissingTopicIsNamedWithThoseThatExist) {
  EXPECT_EQ(with<JointState>("/arm/state").refusal({}, "/arms"),
            path_.string() + ": no topic /arms; it holds /arm/state (sensor_msgs/JointState, 1)");
}

TEST_F(ImportPlanTest, ATopicOfAnotherTypeIsNotTakenForJointStates) {
  EXPECT_EQ(with<std_msgs::String>("/chat").refusal({}, "/chat"),
            path_.string() + ": /chat is of type std_msgs/String, expected sensor_msgs/JointState");
}

TEST_F(ImportPlanTest, TheOneTwistNamedCmdVelBecomesTheCommand) {
  const ImportPlan found = with<JointState>("/joint_states")
                               .with<geometry_msgs::Twist>("/robot/cmd_vel")
                               .with<std_msgs::String>("/chat")
                               .plan();
  ASSERT_EQ(found.streams.size(), 1U);
  EXPECT_EQ(found.streams[0].name, "teleop_cmd");
  EXPECT_EQ(found.streams[0].topic, "/robot/cmd_vel");
  EXPECT_EQ(found.streams[0].type, StreamType::twist);
  EXPECT_EQ(found.streams[0].alignment, Alignment::hold);
  EXPECT_EQ(found.notes,
            (std::vector<std::string>{"stream teleop_cmd from /robot/cmd_vel (geometry_msgs/Twist, 1), held",
                                      "left out: /chat (std_msgs/String, 1)"}));
}

TEST_F(ImportPlanTest, ATopicNamedTeleopCmdIsPreferredToCmdVel) {
  const ImportPlan found = with<JointState>("/joint_states")
                               .with<geometry_msgs::Twist>("/cmd_vel")
                               .with<geometry_msgs::TwistStamped>("/teleop_cmd")
                               .plan();
  ASSERT_EQ(found.streams.size(), 1U);
  EXPECT_EQ(found.streams[0].topic, "/teleop_cmd");
}

TEST_F(ImportPlanTest, TwoPossibleCommandsAreNotGuessedBetween) {
  const ImportPlan found = with<JointState>("/joint_states")
                               .with<geometry_msgs::Twist>("/a/cmd_vel")
                               .with<geometry_msgs::Twist>("/b/cmd_vel")
                               .plan();
  EXPECT_TRUE(found.streams.empty());
  ASSERT_FALSE(found.notes.empty());
  EXPECT_EQ(found.notes[0],
            "no command stream: /a/cmd_vel (geometry_msgs/Twist, 1), /b/cmd_vel (geometry_msgs/Twist, 1) could each be "
            "it; choose with --stream teleop_cmd=TOPIC");
}

TEST_F(ImportPlanTest, GivenStreamsReplaceTheGuessAndKnowTheirType) {
  const ImportPlan found = with<JointState>("/joint_states")
                               .with<geometry_msgs::Twist>("/cmd_vel")
                               .with<std_msgs::Float64>("/grip")
                               .plan({stream("grip", "grip")});
  ASSERT_EQ(found.streams.size(), 1U);
  EXPECT_EQ(found.streams[0].topic, "/grip");
  EXPECT_EQ(found.streams[0].type, StreamType::number);
  EXPECT_EQ(found.notes, std::vector<std::string>{"left out: /cmd_vel (geometry_msgs/Twist, 1)"});
}

TEST_F(ImportPlanTest, AStreamOfAnUnsupportedTypeIsRefusedWithTheSupportedOnes) {
  const std::string message =
      with<JointState>("/joint_states").with<std_msgs::String>("/chat").refusal({stream("chat", "/chat")});
  EXPECT_EQ(
      message.rfind(path_.string() + ": /chat is of type std_msgs/String, which cannot be a stream; supported are "
                                     "demo_logger/AppliedCommand, ",
                    0),
      0U)
      << message;
}

}  // namespace
}  // namespace demo_logger
