#pragma once

// Random recordings with known truth: joint states and streams with latency, jitter, reordering, drops and duplicates.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <random>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "builders.h"
#include "reference_synchroniser.h"

namespace demo_logger::testing_support {

/// What is pushed, and into which stream; nothing for the joint states.
struct Event {
  std::optional<std::size_t> stream;
  std::variant<JointStateSample, StreamSample> sample;

  const Arrival& arrival() const {
    return std::visit([](const auto& message) -> const Arrival& { return message.arrival; }, sample);
  }
};

/// How badly the wires behave.
struct Trouble {
  Nanoseconds largest_delay = 60 * kMillisecond;  // from stamp to receipt; with it comes reordering
  double drops = 0.05;                            // share of messages
  double duplicates = 0.05;                       // share of messages that come twice, with another value
  bool ordered = false;                           // receipts and stamps keep their order
  Nanoseconds receipt_step = 1;                   // receipts are multiples of it, as under simulated time
};

struct Scenario {
  SynchroniserConfiguration configuration;
  std::vector<Event> events;  // in the order of their receipts
  Nanoseconds end = 0;        // after the last receipt
};

constexpr Nanoseconds kScenarioBegin = 1'700'000'000 * kNanosecondsPerSecond;

class ScenarioMaker {
 public:
  ScenarioMaker(unsigned seed, Trouble trouble) : random_(seed), trouble_(trouble) {}

  Scenario make(std::vector<StreamConfiguration> streams, Nanoseconds duration) {
    Scenario scenario;
    scenario.configuration.streams = std::move(streams);
    scenario.configuration.max_wait = uniform(0.0, 0.08);
    scenario.configuration.max_gap = uniform(0.01, 0.1);
    send(scenario, std::nullopt, duration, /*period=*/uniform(2.0, 20.0));
    for (std::size_t i = 0; i < scenario.configuration.streams.size(); ++i) {
      send(scenario, i, duration, /*period=*/uniform(2.0, 60.0));
    }
    std::stable_sort(scenario.events.begin(), scenario.events.end(), [](const Event& one, const Event& other) {
      return std::tuple(one.arrival().receipt, one.arrival().stamp) <
             std::tuple(other.arrival().receipt, other.arrival().stamp);
    });
    for (const Event& event : scenario.events) scenario.end = std::max(scenario.end, event.arrival().receipt + 1);
    return scenario;
  }

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  std::mt19937& random() { return random_; }

 private:
  void send(Scenario& scenario, std::optional<std::size_t> stream, Nanoseconds duration, double period_ms) {
    Nanoseconds stamp = kScenarioBegin;
    Nanoseconds last_receipt = 0;
    while (true) {
      stamp += 1 + static_cast<Nanoseconds>(uniform(0.2, 1.8) * period_ms * kMillisecond);
      if (stamp > kScenarioBegin + duration) return;
      if (chance(trouble_.drops)) continue;
      const int copies = chance(trouble_.duplicates) ? 2 : 1;
      for (int copy = 0; copy < copies; ++copy) {
        // A few receipts lie before their stamp, as clocks that differ make them.
        Nanoseconds receipt = stamp + static_cast<Nanoseconds>(uniform(-0.05, 1.0) * trouble_.largest_delay);
        if (trouble_.ordered) receipt = last_receipt = std::max(receipt, last_receipt + 1);
        receipt -= receipt % trouble_.receipt_step;
        scenario.events.push_back(makeEvent(stream, stamp, receipt));
      }
    }
  }

  Event makeEvent(std::optional<std::size_t> stream, Nanoseconds stamp, Nanoseconds receipt) {
    const double value = uniform(-1.0, 1.0);
    if (stream) return {stream, makeNumber(stamp, receipt, value)};
    return {stream, makeJointState(stamp, receipt, {"elbow"}, {value})};
  }

  std::mt19937 random_;
  Trouble trouble_;
};

inline void push(Synchroniser& synchroniser, const Event& event) {
  if (event.stream) {
    synchroniser.push(*event.stream, std::get<StreamSample>(event.sample));
  } else {
    synchroniser.push(std::get<JointStateSample>(event.sample));
  }
}

/// Pushes everything in the order given, and asks for the rows once.
inline RecordingListener runAtOnce(Synchroniser& synchroniser, const std::vector<Event>& events, Nanoseconds end) {
  RecordingListener listener;
  synchroniser.begin(0);
  for (const Event& event : events) push(synchroniser, event);
  synchroniser.end(end, listener);
  return listener;
}

inline RecordingListener runAtOnce(const Scenario& scenario) {
  Synchroniser synchroniser(scenario.configuration);
  return runAtOnce(synchroniser, scenario.events, scenario.end);
}

/// The reference for the streams of the scenario.
inline ReferenceSynchroniser makeReference(const Scenario& scenario) {
  ReferenceSynchroniser reference;
  Nanoseconds largest_latency = 0;
  for (const StreamConfiguration& stream : scenario.configuration.streams) {
    reference.alignments.push_back(stream.alignment);
    largest_latency = std::max(largest_latency, fromSeconds(stream.latency));
  }
  reference.wait = fromSeconds(scenario.configuration.max_wait) + largest_latency;
  reference.max_gap = fromSeconds(scenario.configuration.max_gap);
  reference.streams.resize(scenario.configuration.streams.size());
  for (const Event& event : scenario.events) {
    if (!event.stream) continue;
    const Arrival& arrival = event.arrival();
    const Nanoseconds latency = fromSeconds(scenario.configuration.streams[*event.stream].latency);
    reference.streams[*event.stream].push_back(
        {arrival.stamp - latency, arrival.receipt, std::get<StreamSample>(event.sample).values[0]});
  }
  return reference;
}

/// The joint states of the scenario that were received in (begin, end].
inline std::vector<ReferenceMessage> jointStatesOf(const Scenario& scenario, Nanoseconds begin, Nanoseconds end) {
  std::vector<ReferenceMessage> joint_states;
  for (const Event& event : scenario.events) {
    const Arrival& arrival = event.arrival();
    if (event.stream || arrival.receipt <= begin || arrival.receipt > end) continue;
    joint_states.push_back({arrival.stamp, arrival.receipt, std::get<JointStateSample>(event.sample).position[0]});
  }
  return joint_states;
}

/// What the reference makes of the scenario.
inline ReferenceResult runReference(const Scenario& scenario) {
  return makeReference(scenario).run(jointStatesOf(scenario, 0, scenario.end));
}

}  // namespace demo_logger::testing_support
