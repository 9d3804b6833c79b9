#include "src/nodes/demo_logger_parameters.h"

#include <gtest/gtest.h>

#include <array>

#include <fstream>
#include <functional>
#include <sstream>

namespace demo_logger {
namespace {

using XmlRpc::XmlRpcValue;

std::string twoLinkUrdf() {
  std::ostringstream text;
  text << std::ifstream(DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf").rdbuf();
  return text.str();
}

DemoLoggerParameters parse(const XmlRpcValue& values, const std::string& robot_description = "") {
  Parameters parameters("/demo_logger", values);
  return parseDemoLoggerParameters(parameters, robot_description);
}

std::string refusal(const std::function<void(XmlRpcValue&)>& fill, const std::string& robot_description = "") {
  XmlRpcValue values;
  fill(values);
  try {
    parse(values, robot_description);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(DemoLoggerParametersTest, WithoutAnyTheNodeRecordsAtOnceIntoDemosWithTheTeleopCommandHeld) {
  const DemoLoggerParameters parameters = parse(XmlRpcValue());
  EXPECT_TRUE(parameters.recorder.autostart);
  EXPECT_EQ(parameters.recorder.output_directory, std::filesystem::current_path() / "demos");
  EXPECT_EQ(parameters.recorder.metadata.channel, "unknown");
  EXPECT_EQ(parameters.recorder.synchroniser.max_wait, 0.1);
  ASSERT_EQ(parameters.recorder.synchroniser.streams.size(), 1U);
  EXPECT_EQ(parameters.recorder.synchroniser.streams[0].name, "teleop_cmd");
  EXPECT_EQ(parameters.recorder.synchroniser.streams[0].type, StreamType::twist);
  EXPECT_FALSE(parameters.robot.has_value());
  EXPECT_FALSE(parameters.buttons.any());
}

TEST(DemoLoggerParametersTest, StreamsAreAddedToTheTeleopCommandOrDescribeIt) {
  XmlRpcValue values;
  values["streams"][0]["name"] = "wrench";
  values["streams"][0]["topic"] = "/ft/raw";
  values["streams"][0]["align"] = "linear";
  values["streams"][0]["latency"] = 0.004;
  values["streams"][0]["in_order"] = true;
  values["streams"][1]["name"] = "teleop_cmd";
  values["streams"][1]["topic"] = "cmd_vel";
  const auto streams = parse(values).recorder.synchroniser.streams;
  ASSERT_EQ(streams.size(), 2U);
  EXPECT_EQ(streams[0].name, "teleop_cmd");
  EXPECT_EQ(streams[0].topic, "cmd_vel");
  EXPECT_EQ(streams[1].name, "wrench");
  EXPECT_EQ(streams[1].topic, "/ft/raw");
  EXPECT_EQ(streams[1].alignment, Alignment::linear);
  EXPECT_EQ(streams[1].latency, 0.004);
  EXPECT_TRUE(streams[1].in_order);
}

TEST(DemoLoggerParametersTest, AStreamThatSaysItsTypeHasItsColumnsBeforeAnyonePublishes) {
  const auto typeOf = [](const std::string& type) {
    XmlRpcValue values;
    values["streams"][0]["name"] = "hand";
    if (!type.empty()) values["streams"][0]["type"] = type;
    return parse(values).recorder.synchroniser.streams.at(1).type;
  };
  EXPECT_EQ(typeOf("twist"), StreamType::twist);
  EXPECT_EQ(typeOf("pose"), StreamType::pose);
  EXPECT_EQ(typeOf("wrench"), StreamType::wrench);
  EXPECT_EQ(typeOf("number"), StreamType::number);
  EXPECT_EQ(typeOf(""), std::nullopt) << "that of its topic";
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["streams"][0]["name"] = "device";
              values["streams"][0]["type"] = "joy";
            }),
            "/demo_logger/streams[0]/type is \"joy\", expected one of twist, pose, wrench, number.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["streams"][0]["name"] = "teleop_cmd";
              values["streams"][0]["type"] = "pose";
            }),
            "/demo_logger/streams[0]/type is \"pose\", expected twist, as teleop_cmd always is, or none.");
}

TEST(DemoLoggerParametersTest, ATipMakesTheChainsJointsTheArm) {
  XmlRpcValue values;
  values["tip"] = "tool_tip";
  const DemoLoggerParameters parameters = parse(values, twoLinkUrdf());
  ASSERT_TRUE(parameters.robot.has_value());
  EXPECT_EQ(parameters.recorder.synchroniser.joints, (std::vector<std::string>{"joint_1", "joint_2"}));
  EXPECT_EQ(parameters.recorder.metadata.robot.base, "base_link");
  EXPECT_EQ(parameters.recorder.metadata.robot.name, "two_link");
}

TEST(DemoLoggerParametersTest, ARobotDescriptionAloneChangesNothing) {
  EXPECT_FALSE(parse(XmlRpcValue(), twoLinkUrdf()).robot.has_value());
}

TEST(DemoLoggerParametersTest, TheMeaningOfTheEffortAndTheSettingsStandInTheSidecar) {
  XmlRpcValue values;
  values["effort"]["side"] = "link";
  values["effort"]["timing"] = "held";
  values["effort"]["includes_gravity"] = false;
  values["effort"]["control_period"] = 0.001;
  values["max_wait"] = 0.25;
  const Metadata metadata = parse(values).recorder.metadata;
  EXPECT_EQ(metadata.effort.side, "link");
  EXPECT_EQ(metadata.effort.timing, "held");
  EXPECT_FALSE(metadata.effort.includes_gravity);
  EXPECT_EQ(metadata.effort.control_period, 0.001);
  EXPECT_EQ(std::get<double>(metadata.parameters.at("max_wait")), 0.25);
}

TEST(DemoLoggerParametersTest, WhatIsWrongIsNamedInFullWithWhatWasExpected) {
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["max_wait"] = -1.0; }),
            "/demo_logger/max_wait is -1 s, expected a number from 0 to 10 s.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["autostart"] = "yes"; }),
            "/demo_logger/autostart is the text \"yes\", expected true or false.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["channel"] = "telepathy"; }),
            "/demo_logger/channel is \"telepathy\", expected one of teleoperation, kinesthetic, vr, unknown.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["output_dir"] = ""; }),
            "/demo_logger/output_dir is empty, expected a directory.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["buttons"]["start"] = 1000; }),
            "/demo_logger/buttons/start is 1000, expected a whole number from -1 to 255.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["buttons"]["start"] = 1;
              values["buttons"]["stop"] = 1;
            }),
            "/demo_logger/buttons/stop is 1, which is start already; expected a button of its own for each request.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["joints"][0] = "a";
              values["joints"][1] = "a";
            }),
            "/demo_logger/joints names 'a' twice, expected each joint once");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["effort"]["side"] = "left"; }),
            "/demo_logger/effort/side is \"left\", expected one of motor, link.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["streams"][0]["topic"] = "x"; }),
            "/demo_logger/streams[0]/name is missing, expected the name of the stream's columns.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["streams"][0]["name"] = "wrench";
              values["streams"][0]["align"] = "spline";
            }),
            "/demo_logger/streams[0]/align is \"spline\", expected one of hold, linear, nearest.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["tip"] = "tool_tip"; }),
            "/demo_logger/tip is given but robot_description is not set, here or in a namespace above; expected the "
            "URDF of the arm there, or neither.");
}

TEST(DemoLoggerParametersTest, AnUnknownNameIsRefusedAtEveryLevel) {
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["autosart"] = true;
            }).rfind("/demo_logger/autosart is not a parameter that is understood here; known are ", 0),
            0U);
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["streams"][0]["name"] = "wrench";
              values["streams"][0]["delay"] = 1.0;
            }).rfind("/demo_logger/streams[0]/delay is not a parameter", 0),
            0U);
  EXPECT_EQ(refusal([](XmlRpcValue& values) {
              values["buttons"]["pause"] = 1;
            }).rfind("/demo_logger/buttons/pause is not a parameter", 0),
            0U);
}

TEST(DemoLoggerParametersTest, HumanTorqueIsAFlagOrAGroupAndAsksForTheWholeChain) {
  XmlRpcValue flag;
  flag["human_torque"] = true;
  const DemoLoggerParameters plain = parse(flag, twoLinkUrdf());
  ASSERT_TRUE(plain.human_torque.has_value());
  EXPECT_EQ(plain.human_torque->observer.gain, 50.0);
  EXPECT_EQ(plain.human_torque->observer.cutoff, 30.0);
  EXPECT_EQ(plain.robot->tip, "tool_tip");

  XmlRpcValue group;
  group["human_torque"]["gain"] = 100;
  group["human_torque"]["gravity_compensated"] = true;
  group["human_torque"]["wrench"] = "ft";
  group["human_torque"]["wrench_link"] = "link_1";
  group["streams"][0]["name"] = "ft";
  group["effort"]["side"] = "link";
  const DemoLoggerParameters detailed = parse(group, twoLinkUrdf());
  EXPECT_EQ(detailed.human_torque->observer.gain, 100.0);
  EXPECT_TRUE(detailed.human_torque->observer.gravity_compensated);
  EXPECT_EQ(detailed.human_torque->observer.effort.side, "link");
  EXPECT_EQ(detailed.wrench->arm_to_sensor.jointNames(), std::vector<std::string>{"joint_1"});
  EXPECT_EQ(detailed.recorder.synchroniser.streams[1].type, StreamType::wrench) << "its columns are always there";

  XmlRpcValue off;
  off["human_torque"]["observe"] = false;
  EXPECT_FALSE(parse(off).human_torque.has_value()) << "and no robot is asked for";
  off["human_torque"] = false;
  EXPECT_FALSE(parse(off).human_torque.has_value());
}

TEST(DemoLoggerParametersTest, WhatHumanTorqueCannotDoWithoutIsNamed) {
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["human_torque"] = true; }),
            "/demo_logger/human_torque is given but robot_description is not set, here or in a namespace above; "
            "expected the URDF of the arm there, or neither.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["human_torque"] = "yes"; }, twoLinkUrdf()),
            "/demo_logger/human_torque is the text \"yes\", expected true, false or a group of parameters.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["human_torque"] = 3; }, twoLinkUrdf()),
            "/demo_logger/human_torque is 3, expected true, false or a group of parameters.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["human_torque"]["wrench_link"] = "link_1"; }, twoLinkUrdf()),
            "/demo_logger/human_torque/wrench_link is \"link_1\" but /demo_logger/human_torque/wrench is not given, "
            "expected the name of the stream there.");
  EXPECT_EQ(refusal(
                [](XmlRpcValue& values) {
                  values["human_torque"]["wrench"] = "ft";
                  values["streams"][0]["name"] = "ft";
                  values["streams"][0]["type"] = "twist";
                },
                twoLinkUrdf()),
            "/demo_logger/human_torque/wrench is \"ft\", a stream of another type; expected one of type wrench.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["human_torque"]["gain"] = 0.0; }, twoLinkUrdf()),
            "/demo_logger/human_torque/gain is 0 1/s, expected a number from 0.1 to 10000 1/s.");
  EXPECT_EQ(refusal([](XmlRpcValue& values) { values["human_torque"]["wrench"] = "ft"; }, twoLinkUrdf()),
            "/demo_logger/human_torque/wrench is \"ft\", which is no stream; expected the name of one of "
            "/demo_logger/streams, of geometry_msgs/WrenchStamped.");
  EXPECT_EQ(refusal(
                [](XmlRpcValue& values) {
                  values["human_torque"]["wrench"] = "ft";
                  values["human_torque"]["wrench_link"] = "wrist";
                  values["streams"][0]["name"] = "ft";
                },
                twoLinkUrdf())
                .rfind("/demo_logger/human_torque/wrench_link: ", 0),
            0U);
  for (const bool observe : {true, false}) {
    EXPECT_EQ(refusal(
                  [&](XmlRpcValue& values) {
                    values["human_torque"]["observe"] = observe;
                    values["human_torque"]["model"] = "such.yaml";
                  },
                  twoLinkUrdf()),
              "/demo_logger/human_torque/model: " + (std::filesystem::current_path() / "such.yaml").string() +
                  ": no such file, expected a model (YAML)")
        << "observe: " << observe;
  }
  EXPECT_EQ(refusal(
                [](XmlRpcValue& values) {
                  values["human_torque"] = true;
                  values["effort"]["timing"] = "held";
                },
                twoLinkUrdf()),
            "/demo_logger/effort/control_period is 0 s, expected that of the arm's controller, since its efforts are "
            "held: a held effort acts half of it late.");
}

TEST(DemoLoggerParametersTest, AnArmOfWhichAJointWouldNotBeRecordedIsRefused) {
  const std::string expected =
      "/demo_logger/joints: 'joint_2' is not among them, which the arm from base_link to tool_tip has; add it, or "
      "leave "
      "out the list for all of the arm's.";
  EXPECT_EQ(refusal(
                [](XmlRpcValue& values) {
                  values["human_torque"] = true;
                  values["joints"][0] = "joint_1";
                },
                twoLinkUrdf()),
            expected);
  EXPECT_EQ(refusal(
                [](XmlRpcValue& values) {
                  values["tip"] = "tool_tip";
                  values["joints"][0] = "gripper";
                  values["joints"][1] = "joint_1";
                },
                twoLinkUrdf()),
            expected);
  XmlRpcValue others_too;
  others_too["tip"] = "tool_tip";
  for (int i = 0; i < 3; ++i) others_too["joints"][i] = std::array{"joint_2", "gripper", "joint_1"}.at(i);
  EXPECT_EQ(parse(others_too, twoLinkUrdf()).recorder.synchroniser.joints.size(), 3U);
}

TEST(DemoLoggerParametersTest, AStreamThatTwoShareOrALinkThatIsMissingIsASentence) {
  EXPECT_NE(refusal([](XmlRpcValue& values) {
              values["streams"][0]["name"] = "wrench";
              values["streams"][1]["name"] = "wrench";
            }).find("wrench"),
            std::string::npos);
  EXPECT_NE(refusal([](XmlRpcValue& values) { values["tip"] = "hand"; }, twoLinkUrdf()).find("hand"),
            std::string::npos);
}

}  // namespace
}  // namespace demo_logger
