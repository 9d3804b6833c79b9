#include "demo_logger/recording/stream_configuration.h"

#include <gtest/gtest.h>

#include <limits>

#include "builders.h"
#include "demo_logger/recording/synchroniser.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger::testing_support {
namespace {

/// The sentence with which the configuration is refused, "" if it is not.
std::string complaintAbout(const SynchroniserConfiguration& configuration) {
  try {
    validate(configuration);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "";
}

SynchroniserConfiguration with(const StreamConfiguration& stream) {
  SynchroniserConfiguration configuration;
  configuration.streams = {stream};
  return configuration;
}

TEST(StreamConfigurationTest, TheDefaultsAreValid) {
  EXPECT_EQ(complaintAbout(SynchroniserConfiguration{}), "");
  EXPECT_EQ(complaintAbout(with(makeStream("teleop_cmd", std::nullopt))), "");
}

TEST(StreamConfigurationTest, WaitsAndGapsAreFiniteAndNotNegative) {
  SynchroniserConfiguration configuration;
  configuration.max_wait = -0.1;
  EXPECT_EQ(complaintAbout(configuration), "max_wait is -0.1 s, expected a finite time of at least 0 s");
  configuration = {};
  configuration.max_gap = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaintAbout(configuration), "max_gap is nan s, expected a finite time of at least 0 s");
  configuration = {};
  configuration.wait_for_streams = std::numeric_limits<double>::infinity();
  EXPECT_EQ(complaintAbout(configuration), "wait_for_streams is inf s, expected a finite time of at least 0 s");
}

TEST(StreamConfigurationTest, StreamNamesBeginColumnsOfTheirOwn) {
  EXPECT_EQ(complaintAbout(with(makeStream("", std::nullopt))),
            "streams has one without a name, expected a prefix for its columns");
  EXPECT_EQ(
      complaintAbout(with(makeStream("left arm", std::nullopt))),
      "streams: the name 'left arm' cannot begin a column, expected a letter or _, then letters, digits and _, at "
      "most 63 characters");
  SynchroniserConfiguration configuration = with(makeStream("u", std::nullopt));
  configuration.streams.push_back(makeStream("teleop_cmd", std::nullopt));
  EXPECT_EQ(complaintAbout(configuration),
            "streams: teleop_cmd is given twice (teleop_cmd is written as u), expected each name once");
}

TEST(StreamConfigurationTest, TopicLatencyAndAlignmentAreChecked) {
  StreamConfiguration stream = makeStream("force", StreamType::wrench);
  stream.topic = "";
  EXPECT_EQ(complaintAbout(with(stream)), "streams: force has an empty topic, expected the topic to record");
  stream = makeStream("force", StreamType::wrench);
  stream.latency = -10.5;
  EXPECT_EQ(complaintAbout(with(stream)), "streams: force has a latency of -10.5 s, expected one from -10 s to 10 s");
  stream.latency = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(complaintAbout(with(stream)), "streams: force has a latency of nan s, expected one from -10 s to 10 s");
  EXPECT_EQ(
      complaintAbout(with(makeStream("stick", StreamType::joy, Alignment::linear))),
      "streams: stick is a joystick aligned linear, but there is nothing between a button's 0 and 1; expected hold "
      "or nearest");
}

TEST(StreamConfigurationTest, JointsAreNamedOnceAndMergingNeedsThem) {
  SynchroniserConfiguration configuration;
  configuration.joints = {"a", "b", "a"};
  EXPECT_EQ(complaintAbout(configuration), "joints names 'a' twice, expected each joint once");
  configuration.joints = {"a", ""};
  EXPECT_EQ(complaintAbout(configuration), "joints has an empty name, expected the name of a joint");
  configuration.joints = {};
  configuration.merge_joint_states = true;
  EXPECT_EQ(complaintAbout(configuration),
            "merge_joint_states is set, but joints is empty: which message makes a row follows from the first joint. "
            "List the arm's joints, or give a robot description with base and tip");
}

TEST(StreamConfigurationTest, ASynchroniserRefusesWhatIsNotValid) {
  SynchroniserConfiguration configuration;
  configuration.max_wait = -1.0;
  EXPECT_THROW(Synchroniser{configuration}, ConfigurationError);
}

}  // namespace
}  // namespace demo_logger::testing_support
