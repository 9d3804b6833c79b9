// Properties that hold for every recording, over random ones with latency, jitter, reordering, drops and duplicates.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <random>
#include <tuple>

#include "builders.h"
#include "reference_synchroniser.h"
#include "scenario.h"

namespace demo_logger::testing_support {
namespace {

constexpr unsigned kScenarios = 150;
constexpr Nanoseconds kDuration = 3 * kNanosecondsPerSecond;
/// The reference divides in another order than the recorder.
constexpr double kRounding = 1e-12;

/// A stream of each alignment, with latencies of either sign.
std::vector<StreamConfiguration> allAlignments(ScenarioMaker& maker) {
  std::vector<StreamConfiguration> streams = {makeStream("held", StreamType::number, Alignment::hold),
                                              makeStream("line", StreamType::number, Alignment::linear),
                                              makeStream("near", StreamType::number, Alignment::nearest)};
  for (StreamConfiguration& stream : streams) {
    if (maker.chance(0.5)) stream.latency = maker.uniform(-0.05, 0.05);
  }
  return streams;
}

Scenario makeScenario(unsigned seed, Nanoseconds duration = kDuration) {
  Trouble trouble;
  if (seed % 3 == 0) trouble.receipt_step = 5 * kMillisecond;
  ScenarioMaker maker(seed, trouble);
  return maker.make(allAlignments(maker), duration);
}

void expectEqual(double found, double expected, const char* what) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(found)) << what << " is " << found << ", expected NaN";
  } else {
    EXPECT_NEAR(found, expected, kRounding) << what;
  }
}

void expectSameRows(const RecordingListener& one, const RecordingListener& other) {
  ASSERT_EQ(one.rows().size(), other.rows().size());
  EXPECT_EQ(one.columnNames(), other.columnNames());
  for (std::size_t i = 0; i < one.rows().size(); ++i) {
    ASSERT_EQ(one.rows()[i].stamp, other.rows()[i].stamp) << "row " << i;
    EXPECT_EQ(one.rows()[i].receipt, other.rows()[i].receipt) << "row " << i;
    EXPECT_TRUE(sameBits(one.rows()[i].values, other.rows()[i].values)) << "row " << i;
  }
}

TEST(SynchroniserPropertyTest, EveryRowHoldsWhatThePlainRulesSay) {
  std::size_t compared = 0;
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scenario scenario = makeScenario(seed);
    Synchroniser synchroniser(scenario.configuration);
    const RecordingListener found = runAtOnce(synchroniser, scenario.events, scenario.end);
    const ReferenceResult expected = runReference(scenario);

    ASSERT_EQ(found.rows().size(), expected.rows.size());
    for (std::size_t i = 0; i < expected.rows.size(); ++i) {
      SCOPED_TRACE("row " + std::to_string(i));
      const ReferenceRow& row = expected.rows[i];
      ASSERT_EQ(found.rows()[i].stamp, row.stamp);
      EXPECT_EQ(found.rows()[i].receipt, row.receipt);
      const std::vector<double>& values = found.rows()[i].values;  // q, dq, tau, receipt_delay, then the streams
      ASSERT_EQ(values.size(), 4 + row.streams.size());
      EXPECT_EQ(values[0], row.position);
      EXPECT_EQ(values[3], static_cast<double>(row.receipt - row.stamp) / 1e9);
      for (std::size_t column = 0; column < row.streams.size(); ++column) {
        expectEqual(values[4 + column], row.streams[column], column % 2 == 0 ? "value" : "age");
        ++compared;
      }
    }
    const auto counters = synchroniser.counters();
    EXPECT_EQ(counters.at("rows"), expected.rows.size());
    EXPECT_EQ(counters.at("late_rows"), expected.late);
    EXPECT_EQ(counters.at("duplicate_rows"), expected.duplicates);
    EXPECT_EQ(counters.at("overflow"), 0U);
    EXPECT_EQ(counters.at("pushed_late"), 0U);
  }
  EXPECT_GT(compared, 100'000U) << "the scenarios should have something to compare";
}

TEST(SynchroniserPropertyTest, AMessageIsLateIfItWouldHaveChangedARowThatWasDecided) {
  std::size_t late = 0;
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scenario scenario = makeScenario(seed, /*duration=*/kNanosecondsPerSecond / 2);
    Synchroniser synchroniser(scenario.configuration);
    runAtOnce(synchroniser, scenario.events, scenario.end);
    const ReferenceSynchroniser reference = makeReference(scenario);
    const std::vector<ReferenceRow> rows = runReference(scenario).rows;
    for (std::size_t i = 0; i < scenario.configuration.streams.size(); ++i) {
      EXPECT_EQ(synchroniser.streams()[i].late, reference.countLate(i, rows)) << scenario.configuration.streams[i].name;
      late += synchroniser.streams()[i].late;
    }
  }
  EXPECT_GT(late, 500U) << "the scenarios should have late messages";
}

TEST(SynchroniserPropertyTest, HoldNeverTakesACommandFromTheFuture) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    const RecordingListener listener = runAtOnce(makeScenario(seed));
    for (std::size_t i = 0; i < listener.rows().size(); ++i) {
      const double age = listener.at(i, "held_age");
      EXPECT_TRUE(std::isnan(age) || age >= 0.0) << "seed " << seed << ", row " << i << ", age " << age << " s";
      EXPECT_EQ(std::isnan(age), std::isnan(listener.at(i, "held_value"))) << "seed " << seed << ", row " << i;
    }
  }
}

TEST(SynchroniserPropertyTest, AnAgeLeadsBackToTheVeryMessageThatWasUsed) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    const Scenario scenario = makeScenario(seed);
    const RecordingListener listener = runAtOnce(scenario);
    const Nanoseconds latency = fromSeconds(scenario.configuration.streams[0].latency);
    for (std::size_t i = 0; i < listener.rows().size(); ++i) {
      const double age = listener.at(i, "held_age");
      if (std::isnan(age)) continue;
      const Nanoseconds stamp = listener.rows()[i].stamp - fromSeconds(age) + latency;
      const bool sent = std::any_of(scenario.events.begin(), scenario.events.end(), [&](const Event& event) {
        return event.stream == 0U && event.arrival().stamp == stamp &&
               std::get<StreamSample>(event.sample).values[0] == listener.at(i, "held_value");
      });
      EXPECT_TRUE(sent) << "seed " << seed << ", row " << i << ": no message has stamp " << stamp << " and that value";
    }
  }
}

/// The events in random order. Of one source, messages with the same stamp and receipt keep theirs: nothing else tells
/// them apart.
std::vector<Event> shuffled(const std::vector<Event>& events, unsigned seed) {
  using Key = std::tuple<std::optional<std::size_t>, Nanoseconds, Nanoseconds>;
  const auto keyOf = [](const Event& event) {
    return Key(event.stream, event.arrival().stamp, event.arrival().receipt);
  };
  std::map<Key, std::deque<Event>> alike;
  for (const Event& event : events) alike[keyOf(event)].push_back(event);
  std::vector<Event> order = events;
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  for (Event& event : order) {
    std::deque<Event>& candidates = alike[keyOf(event)];
    event = candidates.front();
    candidates.pop_front();
  }
  return order;
}

TEST(SynchroniserPropertyTest, RowsDoNotDependOnTheOrderOfThePushes) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scenario scenario = makeScenario(seed);
    Synchroniser synchroniser(scenario.configuration);
    expectSameRows(runAtOnce(scenario), runAtOnce(synchroniser, shuffled(scenario.events, seed), scenario.end));
  }
}

/// Pushes the messages as they are received, and raises the watermark now and then as far as is true.
RecordingListener runInSteps(const Scenario& scenario, unsigned seed) {
  std::mt19937 random(seed);
  Synchroniser synchroniser(scenario.configuration);
  RecordingListener listener;
  synchroniser.begin(0);
  for (std::size_t i = 0; i < scenario.events.size(); ++i) {
    push(synchroniser, scenario.events[i]);
    if (random() % 4 != 0) continue;
    const Nanoseconds here = scenario.events[i].arrival().receipt;
    const Nanoseconds next = i + 1 < scenario.events.size() ? scenario.events[i + 1].arrival().receipt : scenario.end;
    if (next == here) continue;
    synchroniser.advance(here + static_cast<Nanoseconds>(random() % static_cast<std::uint64_t>(next - here)), listener);
  }
  synchroniser.end(scenario.end, listener);
  EXPECT_EQ(synchroniser.counters().at("pushed_late"), 0U);
  return listener;
}

TEST(SynchroniserPropertyTest, RowsDoNotDependOnWhenTheWatermarkIsRaised) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scenario scenario = makeScenario(seed);
    expectSameRows(runAtOnce(scenario), runInSteps(scenario, seed));
  }
}

TEST(SynchroniserPropertyTest, EarlyReleaseChangesNoRow) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Trouble trouble;
    trouble.ordered = true;
    trouble.duplicates = 0.0;
    ScenarioMaker maker(seed, trouble);
    std::vector<StreamConfiguration> streams = allAlignments(maker);
    for (StreamConfiguration& stream : streams) stream.in_order = true;
    Scenario early = maker.make(std::move(streams), kDuration);
    Scenario waiting = early;
    for (StreamConfiguration& stream : waiting.configuration.streams) stream.in_order = false;
    expectSameRows(runAtOnce(waiting), runAtOnce(early));
    expectSameRows(runAtOnce(waiting), runInSteps(early, seed));
  }
}

TEST(SynchroniserPropertyTest, BrokenPromisesOfOrderAreDroppedTheSameWithAndWithoutEarlyRelease) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    ScenarioMaker maker(seed, Trouble{});
    std::vector<StreamConfiguration> streams = allAlignments(maker);
    for (StreamConfiguration& stream : streams) stream.in_order = true;
    Scenario early = maker.make(streams, kDuration);
    // Joint states out of order are late where rows are released early, so only streams may break their promise here.
    Nanoseconds newest = 0;
    std::vector<Event> kept;
    for (Event& event : early.events) {
      const Nanoseconds stamp = event.arrival().stamp;
      if (!event.stream && stamp <= newest) continue;
      if (!event.stream) newest = stamp;
      kept.push_back(std::move(event));
    }
    early.events = std::move(kept);
    // One further stream without the promise makes every row wait; it never sends, so its columns stay NaN.
    Scenario waiting = early;
    waiting.configuration.streams.push_back(makeStream("silent", StreamType::number));

    Synchroniser synchroniser(early.configuration);
    const RecordingListener released_early = runAtOnce(synchroniser, early.events, early.end);
    RecordingListener released_late = runAtOnce(waiting);
    ASSERT_FALSE(released_late.episodes.empty());
    for (Row& row : released_late.episodes[0].rows) row.values.resize(row.values.size() - 2);
    released_late.episodes[0].columns.resize(released_late.episodes[0].columns.size() - 2);
    expectSameRows(released_early, released_late);
    EXPECT_GT(synchroniser.streams()[0].dropped, 0U) << "the scenario should break promises";
  }
}

TEST(SynchroniserPropertyTest, RowsOfAnEpisodeAreThoseReceivedBetweenItsRequests) {
  for (unsigned seed = 0; seed < kScenarios; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scenario scenario = makeScenario(seed);
    const Nanoseconds begin = kScenarioBegin + kNanosecondsPerSecond;
    const Nanoseconds end = kScenarioBegin + 2 * kNanosecondsPerSecond;
    Synchroniser synchroniser(scenario.configuration);
    RecordingListener listener;
    synchroniser.begin(begin);
    for (const Event& event : scenario.events) push(synchroniser, event);
    synchroniser.end(end, listener);

    const ReferenceResult expected = makeReference(scenario).run(jointStatesOf(scenario, begin, end));
    ASSERT_EQ(listener.rows().size(), expected.rows.size());
    for (std::size_t i = 0; i < expected.rows.size(); ++i) EXPECT_EQ(listener.rows()[i].stamp, expected.rows[i].stamp);
  }
}

}  // namespace
}  // namespace demo_logger::testing_support
