#include "src/tool/stream_option.h"

#include <gtest/gtest.h>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

std::string messageOf(const std::string& text) {
  try {
    parseStreamOption(text);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(StreamOptionTest, NameAndTopicAreEnoughAndTheMessageIsHeld) {
  const StreamConfiguration stream = parseStreamOption("wrench=/ft_sensor/raw");
  EXPECT_EQ(stream.name, "wrench");
  EXPECT_EQ(stream.topic, "/ft_sensor/raw");
  EXPECT_EQ(stream.alignment, Alignment::hold);
  EXPECT_EQ(stream.latency, 0.0);
  EXPECT_FALSE(stream.type.has_value());
}

TEST(StreamOptionTest, AlignmentAndLatencyMayFollow) {
  EXPECT_EQ(parseStreamOption("a=/b:hold").alignment, Alignment::hold);
  EXPECT_EQ(parseStreamOption("a=/b:nearest").alignment, Alignment::nearest);
  const StreamConfiguration stream = parseStreamOption("a=/b:linear:-0.004");
  EXPECT_EQ(stream.topic, "/b");
  EXPECT_EQ(stream.alignment, Alignment::linear);
  EXPECT_EQ(stream.latency, -0.004);
  EXPECT_EQ(parseStreamOption("a=/b::0.5").latency, 0.5) << "an empty alignment is the default one";
}

TEST(StreamOptionTest, WhatIsWrongIsSaidWithTheForm) {
  const std::string form = ", expected NAME=TOPIC[:hold|linear|nearest[:LATENCY_S]]";
  EXPECT_EQ(messageOf("/cmd_vel"), "--stream /cmd_vel: no =" + form);
  EXPECT_EQ(messageOf("=/cmd_vel"), "--stream =/cmd_vel: no name" + form);
  EXPECT_EQ(messageOf("u="), "--stream u=: no topic" + form);
  EXPECT_EQ(messageOf("u=/b:spline"), "--stream u=/b:spline: alignment \"spline\" is not known" + form);
  EXPECT_EQ(messageOf("u=/b:hold:5ms"), "--stream u=/b:hold:5ms: latency \"5ms\" is not a number of seconds" + form);
}

}  // namespace
}  // namespace demo_logger
