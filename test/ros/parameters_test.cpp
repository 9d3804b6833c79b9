#include "src/ros/parameters.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace demo_logger {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue makeList(const std::vector<XmlRpcValue>& items) {
  XmlRpcValue list;
  list.setSize(static_cast<int>(items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) list[static_cast<int>(i)] = items[i];
  return list;
}

Parameters makeParameters(const std::string& key, const XmlRpcValue& value) {
  XmlRpcValue values;
  values[key] = value;
  return {"/arm", values};
}

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ParametersTest, AbsentNamesTakeTheirDefaults) {
  Parameters parameters("/arm", XmlRpcValue());
  EXPECT_EQ(parameters.number("rate", 500.0, {1.0, 1000.0, "Hz"}), 500.0);
  EXPECT_EQ(parameters.integer("seed", 7), 7);
  EXPECT_TRUE(parameters.flag("clock", true));
  EXPECT_EQ(parameters.text("base", "base_link"), "base_link");
  EXPECT_EQ(parameters.texts("joints", {"a"}), std::vector<std::string>{"a"});
  EXPECT_TRUE(parameters.groups("streams").empty());
  EXPECT_NO_THROW(parameters.rejectUnknown());
}

TEST(ParametersTest, AWholeNumberIsAlsoANumber) {
  EXPECT_EQ(makeParameters("rate", XmlRpcValue(250)).number("rate", 500.0), 250.0);
}

TEST(ParametersTest, AWrongTypeIsNamedWithWhatWasExpected) {
  EXPECT_EQ(messageOf([] {
              makeParameters("rate", XmlRpcValue("fast")).number("rate", 1.0, {1.0, 1000.0, "Hz"});
            }),
            "/arm/rate is the text \"fast\", expected a number from 1 to 1000 Hz.");
  EXPECT_EQ(messageOf([] { makeParameters("clock", XmlRpcValue(1)).flag("clock", false); }),
            "/arm/clock is 1, expected true or false.");
  EXPECT_EQ(messageOf([] { makeParameters("base", XmlRpcValue(1.5)).text("base", ""); }),
            "/arm/base is 1.5, expected a text.");
  EXPECT_EQ(messageOf([] {
              makeParameters("seed", XmlRpcValue(1.5)).integer("seed", 1, {0.0, 9.0, ""});
            }),
            "/arm/seed is 1.5, expected a whole number from 0 to 9.");
  EXPECT_EQ(messageOf([] { makeParameters("rate", XmlRpcValue(true)).number("rate", 1.0); }),
            "/arm/rate is the truth value true, expected a number.");
}

TEST(ParametersTest, AValueOutOfRangeIsNamedWithItsUnit) {
  EXPECT_EQ(messageOf([] {
              makeParameters("timeout", XmlRpcValue(-0.5)).number("timeout", 1.0, {0.0, INFINITY, "s"});
            }),
            "/arm/timeout is -0.5 s, expected a number of at least 0 s.");
  EXPECT_EQ(messageOf([] {
              makeParameters("seed", XmlRpcValue(-1)).integer("seed", 1, {0.0, INFINITY, ""});
            }),
            "/arm/seed is -1, expected a whole number of at least 0.");
}

TEST(ParametersTest, NotANumberIsOutOfEveryRange) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(messageOf([&] { makeParameters("gain", XmlRpcValue(not_a_number)).number("gain", 1.0); }),
            "/arm/gain is nan, expected a number.");
}

TEST(ParametersTest, ElementsOfAListAreNamedByTheirIndex) {
  EXPECT_EQ(messageOf([] {
              makeParameters("scale", makeList({XmlRpcValue(1.0), XmlRpcValue("x")})).numbers("scale", {});
            }),
            "/arm/scale[1] is the text \"x\", expected a number.");
}

TEST(ParametersTest, AListOfWholeNumbersTakesNoOthers) {
  EXPECT_EQ(makeParameters("axes", makeList({XmlRpcValue(2), XmlRpcValue(0)})).integers("axes", {}),
            (std::vector<int>{2, 0}));
  EXPECT_EQ(messageOf([] { makeParameters("axes", makeList({XmlRpcValue(1.5)})).integers("axes", {}); }),
            "/arm/axes[0] is 1.5, expected a whole number.");
}

TEST(ParametersTest, RowsOfAMatrixAreEquallyLong) {
  const XmlRpcValue rows = makeList({makeList({XmlRpcValue(1), XmlRpcValue(2)}), makeList({XmlRpcValue(3)})});
  EXPECT_EQ(messageOf([&] { makeParameters("gain", rows).matrix("gain", {}); }),
            "/arm/gain[1] is a row of 1, expected 2 as in the first row.");
}

TEST(ParametersTest, AChoiceOutsideTheListNamesTheList) {
  EXPECT_EQ(messageOf([] {
              makeParameters("mode", XmlRpcValue("speed")).choice("mode", "rate", {"rate", "pose"});
            }),
            "/arm/mode is \"speed\", expected one of rate, pose.");
}

TEST(ParametersTest, AnUnknownNameIsRefusedAndTheKnownOnesAreListed) {
  Parameters parameters = makeParameters("publsh_rate", XmlRpcValue(100));
  parameters.number("publish_rate", 500.0);
  parameters.text("base", "");
  EXPECT_EQ(
      messageOf([&] { parameters.rejectUnknown(); }),
      "/arm/publsh_rate is not a parameter that is understood here; known are base, publish_rate. Is it a slip of "
      "the pen, or left over from an earlier run (rosparam delete /arm/publsh_rate)?");
}

TEST(ParametersTest, GroupsInAListAreReadLikeTheNamespaceItself) {
  XmlRpcValue stream;
  stream["name"] = "gripper";
  stream["latncy"] = 0.1;
  Parameters parameters = makeParameters("streams", makeList({stream}));
  std::vector<Parameters> streams = parameters.groups("streams");
  ASSERT_EQ(streams.size(), 1U);
  EXPECT_EQ(streams[0].text("name", ""), "gripper");
  EXPECT_THROW(streams[0].rejectUnknown(), ConfigurationError);
  EXPECT_EQ(streams[0].fullName("latncy"), "/arm/streams[0]/latncy");
}

TEST(ParametersTest, AListInTheWrongPlaceIsCounted) {
  XmlRpc::XmlRpcValue values;
  values["gain"][0] = 1.0;
  values["gain"][1] = 2.0;
  Parameters parameters("/arm", values);
  try {
    parameters.flag("gain", false);
    FAIL() << "a list is no flag";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "/arm/gain is a list of 2, expected true or false.");
  }
}

}  // namespace
}  // namespace demo_logger
