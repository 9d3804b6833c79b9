// Everything at once: joints of two nodes merged, a joystick that comes late, commands without stamps, corrected
// clocks, outliers, a clock that jumps. Whatever it is, it must not depend on when and in which order messages are
// pushed.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "builders.h"
#include "scenario.h"

namespace demo_logger::testing_support {
namespace {

constexpr unsigned kWorlds = 100;

/// Begins anew from within clockJumped(), as a recorder with autostart does.
class TirelessListener : public RecordingListener {
 public:
  void clockJumped(Nanoseconds stamp, double seconds) override {
    RecordingListener::clockJumped(stamp, seconds);
    synchroniser->begin(0);
  }
  Synchroniser* synchroniser = nullptr;
};

class World {
 public:
  explicit World(unsigned seed) : random_(seed) {
    scenario.configuration.joints = {"shoulder", "elbow", "finger"};
    scenario.configuration.merge_joint_states = true;
    scenario.configuration.max_wait = 0.03;
    scenario.configuration.wait_for_streams = 0.4;
    scenario.configuration.correct_clock_offset = seed % 2 == 0;
    scenario.configuration.streams = {makeStream("teleop_cmd", StreamType::twist),
                                      makeStream("hand", StreamType::pose, Alignment::linear),
                                      makeStream("stick", std::nullopt), makeStream("never", std::nullopt)};
    scenario.configuration.streams[1].latency = 0.02;
    const double offset_ms = uniform(-3000.0, 3000.0);
    const double jump_ms = chance(0.7) ? uniform(1500.0, 4000.0) : 1e9;
    const double jump_by_ms = (chance(0.5) ? 1.0 : -1.0) * uniform(1500.0, 9000.0);
    for (double ms = 1.0; ms < 5000.0; ms += uniform(0.5, 3.0)) {
      robot_ms_ = ms + offset_ms + (ms > jump_ms ? jump_by_ms : 0.0);
      now_ms_ = ms + uniform(0.0, 15.0);
      sendAny(ms);
    }
    std::stable_sort(scenario.events.begin(), scenario.events.end(), [](const Event& one, const Event& other) {
      return std::tuple(one.arrival().receipt, one.arrival().stamp) <
             std::tuple(other.arrival().receipt, other.arrival().stamp);
    });
    scenario.end = kScenarioBegin + 6 * kNanosecondsPerSecond;
  }

  Scenario scenario;

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  static Nanoseconds instant(double ms) { return kScenarioBegin + static_cast<Nanoseconds>(ms * kMillisecond); }

  template <typename Sample>
  void send(std::optional<std::size_t> stream, const char* publisher, Sample sample) {
    sample.arrival.publisher = publisher;
    scenario.events.push_back({stream, std::move(sample)});
  }

  void sendAny(double ms) {
    const Nanoseconds stamp = instant(robot_ms_);
    const Nanoseconds receipt = instant(now_ms_);
    const double value = uniform(-1.0, 1.0);
    switch (std::uniform_int_distribution<int>(0, 6)(random_)) {
      case 0:
      case 1: {
        const bool outlier = chance(0.01);
        send(std::nullopt, "/arm",
             makeJointState(outlier ? stamp + 50 * kNanosecondsPerSecond : stamp, receipt, {"elbow", "shoulder"},
                            {value, ms}));
        break;
      }
      case 2:
        send(std::nullopt, "/gripper", makeJointState(stamp, receipt, {"finger", "thumb"}, {value, value}));
        break;
      case 3:
        send(0, "/teleop", makeTwist(0, receipt, value));
        break;
      case 4:
        send(1, "/tracker", makeStreamSample(StreamType::pose, stamp, receipt, {value, 0, 0, 0, 0, value, 1.0}));
        break;
      case 5:
        if (ms > 300.0) send(2, "/joy", makeJoy(stamp, receipt, {value, -value}));
        break;
      default:
        if (chance(0.1)) send(0, "/teleop", makeNumber(0, receipt, value));  // does not fit
        break;
    }
  }

  std::mt19937 random_;
  double robot_ms_ = 0.0;
  double now_ms_ = 0.0;
};

/// Everything that can be seen from outside.
struct Outcome {
  TirelessListener listener;
  std::map<std::string, std::uint64_t> counters;
  std::vector<Fault> faults;
  std::vector<StreamMetadata> streams;
};

void finish(Synchroniser& synchroniser, const Scenario& scenario, Outcome& outcome) {
  synchroniser.end(scenario.end, outcome.listener);
  outcome.counters = synchroniser.counters();
  outcome.faults = synchroniser.faults();
  outcome.streams = synchroniser.streams();
}

Outcome runAtOnceIn(const Scenario& scenario, const std::vector<Event>& events) {
  Synchroniser synchroniser(scenario.configuration);
  Outcome outcome;
  outcome.listener.synchroniser = &synchroniser;
  synchroniser.begin(0);
  for (const Event& event : events) push(synchroniser, event);
  finish(synchroniser, scenario, outcome);
  return outcome;
}

/// Pushes every message a random time after its receipt, the watermark as far behind as that asks for.
Outcome runLive(const Scenario& scenario, unsigned seed) {
  constexpr Nanoseconds kSlowest = 30 * kMillisecond;
  std::mt19937 random(seed);
  std::vector<std::pair<Nanoseconds, const Event*>> pushes;
  for (const Event& event : scenario.events) {
    pushes.emplace_back(event.arrival().receipt + static_cast<Nanoseconds>(random() % kSlowest), &event);
  }
  std::sort(pushes.begin(), pushes.end());
  Synchroniser synchroniser(scenario.configuration);
  Outcome outcome;
  outcome.listener.synchroniser = &synchroniser;
  synchroniser.begin(0);
  for (const auto& [now, event] : pushes) {
    push(synchroniser, *event);
    if (random() % 3 == 0) synchroniser.advance(now - kSlowest, outcome.listener);
  }
  finish(synchroniser, scenario, outcome);
  return outcome;
}

void expectSame(const Outcome& one, const Outcome& other) {
  ASSERT_EQ(one.listener.episodes.size(), other.listener.episodes.size());
  for (std::size_t e = 0; e < one.listener.episodes.size(); ++e) {
    const auto& episode = one.listener.episodes[e];
    const auto& same = other.listener.episodes[e];
    ASSERT_EQ(episode.columns.size(), same.columns.size());
    ASSERT_EQ(episode.rows.size(), same.rows.size());
    for (std::size_t i = 0; i < episode.rows.size(); ++i) {
      ASSERT_EQ(episode.rows[i].stamp, same.rows[i].stamp);
      ASSERT_TRUE(sameBits(episode.rows[i].values, same.rows[i].values)) << "episode " << e << ", row " << i;
    }
  }
  ASSERT_EQ(one.listener.jumps.size(), other.listener.jumps.size());
  EXPECT_EQ(one.counters, other.counters);
  ASSERT_EQ(one.faults.size(), other.faults.size());
  for (std::size_t i = 0; i < one.faults.size(); ++i) {
    EXPECT_EQ(one.faults[i].what, other.faults[i].what);
    EXPECT_EQ(one.faults[i].count, other.faults[i].count);
  }
  for (std::size_t i = 0; i < one.streams.size(); ++i) {
    EXPECT_EQ(one.streams[i].received, other.streams[i].received);
    EXPECT_EQ(one.streams[i].used, other.streams[i].used);
    EXPECT_EQ(one.streams[i].late, other.streams[i].late);
    EXPECT_EQ(one.streams[i].dropped, other.streams[i].dropped);
    EXPECT_EQ(one.streams[i].largest_gap, other.streams[i].largest_gap);
    EXPECT_EQ(one.streams[i].receipt_delay.median, other.streams[i].receipt_delay.median);
  }
}

TEST(InvarianceTest, NothingDependsOnTheOrderOfThePushes) {
  std::size_t rows = 0;
  std::size_t jumps = 0;
  for (unsigned seed = 0; seed < kWorlds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const World world(seed);
    std::vector<Event> shuffled = world.scenario.events;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(seed));
    const Outcome outcome = runAtOnceIn(world.scenario, world.scenario.events);
    expectSame(outcome, runAtOnceIn(world.scenario, shuffled));
    for (const auto& episode : outcome.listener.episodes) rows += episode.rows.size();
    jumps += outcome.listener.jumps.size();
  }
  EXPECT_GT(rows, 50'000U) << "the worlds should have something to compare";
  EXPECT_GT(jumps, kWorlds / 2);
}

TEST(InvarianceTest, NothingDependsOnWhenMessagesArePushedAheadOfTheWatermark) {
  for (unsigned seed = 0; seed < kWorlds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const World world(seed);
    expectSame(runAtOnceIn(world.scenario, world.scenario.events), runLive(world.scenario, seed));
  }
}

TEST(InvarianceTest, EveryJointStateOfTheArmIsARowOrCounted) {
  std::size_t checked = 0;
  for (unsigned seed = 0; seed < kWorlds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const World world(seed);
    const Outcome outcome = runAtOnceIn(world.scenario, world.scenario.events);
    if (!outcome.listener.jumps.empty()) continue;  // the counters are those of the last episode
    const auto sent = std::count_if(world.scenario.events.begin(), world.scenario.events.end(),
                                    [](const Event& event) { return event.arrival().publisher == "/arm"; });
    EXPECT_EQ(outcome.counters.at("rows") + outcome.counters.at("late_rows") + outcome.counters.at("duplicate_rows") +
                  outcome.counters.at("clock_outliers"),
              static_cast<std::size_t>(sent));
    ++checked;
  }
  EXPECT_GT(checked, kWorlds / 10);
}

}  // namespace
}  // namespace demo_logger::testing_support
