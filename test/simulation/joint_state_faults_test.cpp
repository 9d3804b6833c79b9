#include "demo_logger/simulation/joint_state_faults.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;
const std::vector<std::string> kJoints{"a", "b", "c", "d"};

/// A reading that tells its own number and joint: q of joint i at message k is 10 k + i.
JointReading makeReading(int k) {
  const Eigen::Vector4d base(0.0, 1.0, 2.0, 3.0);
  const Eigen::VectorXd q = base.array() + 10.0 * k;
  return {q, 2.0 * q, 3.0 * q};
}

struct Sent {
  Nanoseconds at;
  JointStateMessage message;
};

std::vector<Sent> run(JointStateFaults& faults, int readings) {
  std::vector<Sent> sent;
  for (int tick = 0; tick < readings + 1000; ++tick) {
    const Nanoseconds now = kNanosecondsPerSecond + tick * kMillisecond;
    if (tick < readings) faults.offer(now, makeReading(tick));
    for (JointStateMessage& message : faults.take(now)) sent.push_back({now, std::move(message)});
  }
  return sent;
}

TEST(JointStateFaultsTest, WithoutFaultsEveryReadingIsOneMessageAtOnce) {
  JointStateFaults faults({}, kJoints);
  const std::vector<Sent> sent = run(faults, 100);
  ASSERT_EQ(sent.size(), 100U);
  for (int k = 0; k < 100; ++k) {
    const Sent& one = sent[static_cast<std::size_t>(k)];
    EXPECT_EQ(one.message.stamp, one.at);
    EXPECT_EQ(one.message.names, kJoints);
    EXPECT_EQ(one.message.reading.q, makeReading(k).q);
  }
}

/// Whatever the faults, what arrives is the truth under another order, and everything else is counted.
TEST(JointStateFaultsTest, WhatIsSentIsTheTruthAndWhatIsNotIsCounted) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> share(0.0, 0.5);
  for (int trial = 0; trial < 100; ++trial) {
    JointStateFaultsConfiguration configuration;
    configuration.delay = 0.02 * share(random);
    configuration.jitter = 0.02 * share(random);
    configuration.drop = share(random);
    configuration.duplicate = share(random);
    configuration.zero_stamp = share(random);
    configuration.permute = share(random);
    configuration.split = trial % 4;
    configuration.seed = static_cast<std::uint64_t>(trial);
    JointStateFaults faults(configuration, kJoints);
    const int readings = 300;
    const std::vector<Sent> sent = run(faults, readings);

    const JointStateFaults::Counters& counted = faults.counters();
    EXPECT_EQ(counted.messages, static_cast<std::uint64_t>(readings * (configuration.split > 0 ? 2 : 1)));
    EXPECT_EQ(sent.size(), counted.messages - counted.dropped + counted.duplicated);
    std::uint64_t zero_stamped = 0;
    double last = -1.0;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      const JointStateMessage& message = sent[i].message;
      const int k = static_cast<int>(std::floor(message.reading.q[0] / 10.0));
      ASSERT_EQ(message.reading.dq, 2.0 * message.reading.q);
      ASSERT_EQ(message.reading.effort, 3.0 * message.reading.q);
      for (std::size_t j = 0; j < message.names.size(); ++j) {
        const auto joint = std::find(kJoints.begin(), kJoints.end(), message.names[j]) - kJoints.begin();
        ASSERT_EQ(message.reading.q[static_cast<Eigen::Index>(j)], 10.0 * k + static_cast<double>(joint));
      }
      const Nanoseconds made = kNanosecondsPerSecond + k * kMillisecond;
      if (message.stamp == 0) {
        const bool first_of_two = i + 1 < sent.size() && sent[i + 1].message.names == message.names &&
                                  sent[i + 1].message.reading.q == message.reading.q;
        if (!first_of_two) ++zero_stamped;
      } else {
        ASSERT_EQ(message.stamp, made);
      }
      const Nanoseconds latest = made + fromSeconds(configuration.delay + configuration.jitter) + kMillisecond;
      ASSERT_GE(sent[i].at, made + fromSeconds(std::max(configuration.delay - configuration.jitter, 0.0)));
      ASSERT_LE(sent[i].at, latest + 10 * kMillisecond) << "those before may hold it up";
      ASSERT_GE(k, last) << "the order stays";
      last = k;
    }
    EXPECT_EQ(zero_stamped, counted.zero_stamped);
  }
}

TEST(JointStateFaultsTest, FaultsAreAsFrequentAsTheyWereOrdered) {
  JointStateFaultsConfiguration configuration;
  configuration.drop = 0.1;
  configuration.duplicate = 0.2;
  configuration.permute = 0.3;
  JointStateFaults faults(configuration, kJoints);
  const int readings = 20000;
  run(faults, readings);
  const auto five_sigma = [&](double p, double n) { return 5.0 * std::sqrt(p * (1.0 - p) * n); };
  const double kept = static_cast<double>(readings - static_cast<int>(faults.counters().dropped));
  EXPECT_NEAR(static_cast<double>(faults.counters().dropped), 0.1 * readings, five_sigma(0.1, readings));
  EXPECT_NEAR(static_cast<double>(faults.counters().duplicated), 0.2 * kept, five_sigma(0.2, kept));
  EXPECT_NEAR(static_cast<double>(faults.counters().permuted), 0.3 * kept, five_sigma(0.3, kept));
}

TEST(JointStateFaultsTest, ASeedDecidesEverythingAndOneFaultDoesNotMoveAnother) {
  JointStateFaultsConfiguration drops;
  drops.drop = 0.3;
  const auto stampsOf = [](const JointStateFaultsConfiguration& configuration) {
    JointStateFaults faults(configuration, kJoints);
    std::vector<Nanoseconds> stamps;
    for (const Sent& one : run(faults, 200)) stamps.push_back(one.message.stamp);
    return stamps;
  };
  const std::vector<Nanoseconds> once = stampsOf(drops);
  EXPECT_EQ(stampsOf(drops), once);
  JointStateFaultsConfiguration more = drops;
  more.permute = 0.5;
  EXPECT_EQ(stampsOf(more), once) << "the same messages are lost";
  more.seed = 2;
  EXPECT_NE(stampsOf(more), once);
}

TEST(JointStateFaultsTest, TheGripperComesInAMessageOfItsOwn) {
  JointStateFaultsConfiguration configuration;
  configuration.gripper = {"finger_left", "finger_right"};
  configuration.split = 1;
  JointStateFaults faults(configuration, kJoints);
  const std::vector<Sent> sent = run(faults, 1);
  ASSERT_EQ(sent.size(), 3U);
  EXPECT_EQ(sent[0].message.names, (std::vector<std::string>{"a"}));
  EXPECT_EQ(sent[1].message.names, (std::vector<std::string>{"b", "c", "d"}));
  EXPECT_EQ(sent[2].message.names, configuration.gripper);
  EXPECT_EQ(sent[2].message.reading.q, Eigen::Vector2d::Zero());
  EXPECT_EQ(sent[2].message.stamp, sent[0].message.stamp);
}

TEST(JointStateFaultsTest, WhatCannotBeIsNamed) {
  const auto messageOf = [](const JointStateFaultsConfiguration& configuration) -> std::string {
    try {
      JointStateFaults(configuration, kJoints);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "taken";
  };
  JointStateFaultsConfiguration configuration;
  configuration.drop = 1.5;
  EXPECT_EQ(messageOf(configuration), "joint state faults: drop is 1.5, expected a probability from 0 to 1.");
  configuration = {};
  configuration.split = 4;
  EXPECT_EQ(messageOf(configuration),
            "joint state faults: split is 4, expected from 0 to 3, so that both messages have joints.");
  configuration = {};
  configuration.delay = -0.1;
  EXPECT_EQ(messageOf(configuration), "joint state faults: delay is -0.1, expected from 0 to 10 s.");
  const std::string expected = ", expected names of joints beside the arm, once each.";
  configuration = {};
  configuration.gripper = {"finger", "b"};
  EXPECT_EQ(messageOf(configuration), "joint state faults: gripper names b, a joint of the arm" + expected);
  configuration.gripper = {"finger", "finger"};
  EXPECT_EQ(messageOf(configuration), "joint state faults: gripper names finger twice" + expected);
  configuration.gripper = {""};
  EXPECT_EQ(messageOf(configuration), "joint state faults: gripper has a joint without a name" + expected);
}

}  // namespace
}  // namespace demo_logger
