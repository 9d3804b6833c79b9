// Whatever is sent, memory stays bounded, and what is lost is counted.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "timeline.h"

namespace demo_logger::testing_support {
namespace {

constexpr int kMessages = 1'000'000;
/// Of the inbox, of each stream, and of the rows that wait.
constexpr std::size_t kCapacity = 65536;

TEST(BoundedMemoryTest, AStreamWithoutJointStatesKeepsTheNewestMessages) {
  Timeline timeline(numberStreams({Alignment::hold}));
  timeline.begin();
  std::size_t largest = 0;
  for (int i = 0; i < kMessages; ++i) {
    timeline.number(0, i, i);
    timeline.advance(i);
    largest = std::max(largest, timeline.synchroniser.size());
  }
  EXPECT_LE(largest, kCapacity + 2);
  timeline.elbow(kMessages, 0.0);
  timeline.end(2.0 * kMessages);
  EXPECT_EQ(timeline.listener.at(0, "s0_value"), kMessages - 1.0);
  EXPECT_EQ(timeline.counter("overflow"), kMessages - kCapacity);
  EXPECT_EQ(timeline.synchroniser.streams()[0].dropped, kMessages - kCapacity);
  EXPECT_EQ(
      timeline.faultWith("ahead"),
      "stream s0 (/s0) sent more than 65536 messages ahead of the joint states; the oldest are lost. Do both keep "
      "the same clock?");
}

TEST(BoundedMemoryTest, AStreamOfTheFutureIsBounded) {
  Timeline timeline(numberStreams({Alignment::linear}));
  timeline.begin();
  std::mt19937 random(1);
  std::size_t largest = 0;
  for (int i = 0; i < kMessages; ++i) {
    timeline.number(0, 1e9 + static_cast<double>(random() % 1'000'000), 0.0, i);
    if (i % 10 == 0) timeline.elbow(i, 0.0, i);
    timeline.advance(i);
    largest = std::max(largest, timeline.synchroniser.size());
  }
  EXPECT_LE(largest, kCapacity + 1000);
  timeline.end(2.0 * kMessages);
  EXPECT_EQ(timeline.listener.rows().size(), kMessages / 10U) << "no row is lost by it";
}

TEST(BoundedMemoryTest, AnInboxThatNobodyEmptiesIsBounded) {
  Timeline timeline(SynchroniserConfiguration{});
  timeline.begin();
  for (int i = 0; i < kMessages; ++i) timeline.elbow(i, i);
  EXPECT_EQ(timeline.synchroniser.size(), kCapacity);
  EXPECT_EQ(timeline.counter("overflow"), kMessages - kCapacity);
  timeline.end(2.0 * kMessages);
  EXPECT_EQ(timeline.listener.rows().size(), kCapacity);
  EXPECT_EQ(timeline.counter("overflow"), kMessages - kCapacity);
  EXPECT_EQ(timeline.listener.rows().back().values[0], kMessages - 1.0) << "the newest are kept";
  EXPECT_EQ(timeline.faultWith("synchronised"),
            "more than 65536 messages wait to be synchronised; the oldest are lost. Is the machine overloaded?");
}

TEST(BoundedMemoryTest, RowsThatWaitForeverAreBoundedAndNoneIsLost) {
  SynchroniserConfiguration configuration;
  configuration.max_wait = 1e9;
  Timeline timeline(configuration);
  timeline.begin();
  std::size_t largest = 0;
  for (int i = 0; i < kMessages / 5; ++i) {
    timeline.elbow(i, i);
    timeline.advance(i + 1);
    largest = std::max(largest, timeline.synchroniser.size());
  }
  timeline.end(2.0 * kMessages);
  EXPECT_LE(largest, kCapacity + 2);
  EXPECT_EQ(timeline.listener.rows().size(), kMessages / 5U);
  EXPECT_EQ(timeline.counter("overflow"), kMessages / 5 - kCapacity);
  EXPECT_EQ(timeline.faultWith("rows wait"),
            "more than 65536 rows wait; the oldest is finished before its wait is over. Are max_wait or "
            "wait_for_streams too long?");
}

TEST(BoundedMemoryTest, ALongEpisodeHoldsNoMoreThanItsWait) {
  Timeline timeline(numberStreams({Alignment::hold, Alignment::linear}));
  timeline.begin();
  std::size_t largest = 0;
  for (int i = 0; i < kMessages / 5; ++i) {
    timeline.elbow(i, 0.0);
    timeline.number(0, i, 0.0);
    timeline.number(1, i, 0.0);
    timeline.advance(i);
    if (i % 1000 == 0) timeline.listener.episodes.clear();
    if (i % 1000 == 0) timeline.listener.episodes.emplace_back();
    largest = std::max(largest, timeline.synchroniser.size());
  }
  EXPECT_LT(largest, 2600U) << "of 1 kHz: 100 ms of rows, and 1.1 s of each stream";
  EXPECT_EQ(timeline.counter("overflow"), 0U);
}

TEST(BoundedMemoryTest, AnythingMayBePushed) {
  SynchroniserConfiguration configuration = numberStreams({Alignment::hold, Alignment::linear, Alignment::nearest});
  configuration.streams.push_back(makeStream("any", std::nullopt));
  for (const bool correct : {false, true}) {
    configuration.correct_clock_offset = correct;
    Timeline timeline(configuration);
    std::mt19937_64 random(7);
    const auto anyInstant = [&random]() -> Nanoseconds {
      switch (random() % 4) {
        case 0:
          return 0;
        case 1:
          return static_cast<Nanoseconds>(random());
        case 2:
          return random() % 2 == 0 ? std::numeric_limits<Nanoseconds>::min() : std::numeric_limits<Nanoseconds>::max();
        default:
          return kToday + static_cast<Nanoseconds>(random() % 10'000'000'000U);
      }
    };
    for (int i = 0; i < 100'000; ++i) {
      if (random() % 2 == 0) {
        JointStateSample sample = makeJointState(anyInstant(), anyInstant(), {}, {});
        sample.arrival.steady = anyInstant();
        sample.position.resize(random() % 3);
        if (random() % 3 == 0) sample.names = {"elbow", "wrist"};
        timeline.synchroniser.push(sample);
      } else {
        StreamSample sample = makeStreamSample(static_cast<StreamType>(random() % 6), anyInstant(), anyInstant(), {});
        sample.values.resize(random() % 8, std::numeric_limits<double>::quiet_NaN());
        if (random() % 2 == 0) sample.components.resize(random() % 8, "axis");
        if (random() % 2 == 0) sample.units.resize(random() % 8, "m");
        timeline.synchroniser.push(random() % 5, sample);
      }
      if (random() % 10 == 0) timeline.synchroniser.advance(anyInstant(), timeline.listener);
      if (random() % 100 == 0) timeline.synchroniser.begin(anyInstant());
      if (random() % 200 == 0) timeline.synchroniser.end(anyInstant(), timeline.listener);
    }
    timeline.synchroniser.end(std::numeric_limits<Nanoseconds>::max(), timeline.listener);
    for (const auto& episode : timeline.listener.episodes) {
      for (std::size_t i = 0; i < episode.rows.size(); ++i) {
        ASSERT_EQ(episode.rows[i].values.size(), episode.columns.size());
        ASSERT_TRUE(i == 0 || episode.rows[i].stamp > episode.rows[i - 1].stamp);
      }
    }
  }
}

}  // namespace
}  // namespace demo_logger::testing_support
