// How far is the command that a recorder writes into a row from the true one?
//
// A publisher issues commands, a 500 Hz arm publishes joint states, a bad network lies between them and the recorder
// (and, in the second table, between the publisher and the arm). Every recorder sees the same messages at the same
// instants. Prints two Markdown tables; the same seed gives the same table to the last digit.
#include <geometry_msgs/TwistStamped.h>
#include <message_filters/simple_filter.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <boost/bind/bind.hpp>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/recording/synchroniser.h"

namespace demo_logger {
namespace {

constexpr double kDuration = 60.0;           // [s]
constexpr double kJointStatePeriod = 0.002;  // [s]
constexpr double kCommandPeriod = 0.0101;    // [s] its phase against the joint states drifts, as in life
constexpr Nanoseconds kStart = 1'700'000'000 * kNanosecondsPerSecond;
const double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A path through the network: each message is delayed, shuffled by its own jitter, perhaps lost.
struct Network {
  double delay = 0.0;   // [s] every message
  double jitter = 0.0;  // [s] uniform on top; beyond the message period it reorders
  double drops = 0.0;   // share of messages lost
};

struct Scenario {
  std::string name;
  bool stamped = true;
  Network to_recorder;
  Network to_arm;          // second table only
  double clock_ahead = 0;  // [s] the command publisher's clock before the arm's
  double latency = 0;      // [s] declared for the command stream
};

struct Message {
  Nanoseconds stamp = 0;    // as written by its publisher's clock
  Nanoseconds issued = 0;   // on the arm's clock
  Nanoseconds receipt = 0;  // at the recorder
  double value = 0.0;
  int index = 0;  // of the command that the value belongs to
};

/// What one recorder claims for one row.
struct Claim {
  double value = kNaN;
  double command = kNaN;  // index of the command it used; NaN where it mixes two
};

struct Truth {
  std::vector<Nanoseconds> rows;      // stamps of the joint states
  std::vector<Message> joint_states;  // as received
  std::vector<Message> commands;      // as received at the recorder
  std::vector<Message> applied;       // the arm's own reports, as received at the recorder
  std::vector<Message> issued;        // all commands, never lost
  std::vector<int> true_command;      // per row: index of the command issued as of s, or in force at the arm
};

double handMotion(double time) {
  return 0.2 * std::sin(2.0 * M_PI * 0.5 * time) + 0.05 * std::sin(2.0 * M_PI * 1.7 * time);
}

std::optional<Nanoseconds> travel(const Network& network, Nanoseconds sent, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const double jitter = uniform(random) * network.jitter;
  const bool lost = uniform(random) < network.drops;
  if (lost) return std::nullopt;
  return sent + fromSeconds(network.delay + jitter);
}

Truth simulate(const Scenario& scenario, bool truth_at_arm, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Truth truth;
  struct AtArm {
    Nanoseconds receipt;
    int index;
  };
  std::vector<AtArm> at_arm;
  for (int index = 0; index * kCommandPeriod < kDuration; ++index) {
    Message message;
    message.index = index;
    message.issued = kStart + fromSeconds(index * kCommandPeriod) + 137'000;
    message.stamp = scenario.stamped ? message.issued + fromSeconds(scenario.clock_ahead) : 0;
    message.value = handMotion(index * kCommandPeriod);
    truth.issued.push_back(message);
    if (const auto receipt = travel(scenario.to_recorder, message.issued, random)) {
      truth.commands.push_back(message);
      truth.commands.back().receipt = *receipt;
    }
    if (const auto receipt = travel(scenario.to_arm, message.issued, random)) at_arm.push_back({*receipt, index});
  }
  std::stable_sort(at_arm.begin(), at_arm.end(), [](const AtArm& a, const AtArm& b) { return a.receipt < b.receipt; });

  std::size_t arrived = 0;
  std::size_t issued = 0;
  int in_force = -1;
  for (int row = 0; row * kJointStatePeriod < kDuration; ++row) {
    const Nanoseconds stamp = kStart + fromSeconds(row * kJointStatePeriod);
    while (arrived < at_arm.size() && at_arm[arrived].receipt <= stamp) {
      in_force = at_arm[arrived++].index;  // the arm obeys what reached it last, as real arms do
    }
    while (issued < truth.issued.size() && truth.issued[issued].issued <= stamp) ++issued;
    const int true_command = truth_at_arm ? in_force : static_cast<int>(issued) - 1;

    Message joint_state;
    joint_state.stamp = stamp;
    joint_state.index = row;
    if (const auto receipt = travel(scenario.to_recorder, stamp, random)) {
      joint_state.receipt = *receipt;
      truth.joint_states.push_back(joint_state);
    }
    if (in_force >= 0) {
      if (const auto receipt = travel(scenario.to_recorder, stamp, random)) {
        Message report = truth.issued[static_cast<std::size_t>(in_force)];
        report.stamp = stamp;
        report.receipt = *receipt;
        truth.applied.push_back(report);
      }
    }
    truth.rows.push_back(stamp);
    truth.true_command.push_back(true_command);
  }
  return truth;
}

using Claims = std::vector<std::optional<Claim>>;  // one per row of Truth; nothing where the recorder wrote no row

/// Calls `visit(is_joint_state, message)` in the order in which messages reach the recorder.
void inOrderOfReceipt(const std::vector<Message>& joint_states, const std::vector<Message>& commands,
                      const std::function<void(bool, const Message&)>& visit) {
  std::vector<std::pair<bool, const Message*>> all;
  for (const Message& message : joint_states) all.emplace_back(true, &message);
  for (const Message& message : commands) all.emplace_back(false, &message);
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.second->receipt < b.second->receipt; });
  for (const auto& [is_joint_state, message] : all) visit(is_joint_state, *message);
}

class ClaimCollector : public RowListener {
 public:
  explicit ClaimCollector(std::size_t rows) : claims(rows) {}
  void opened(const std::vector<Column>& columns, Nanoseconds) override {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].name == "u_vx") value_ = i;
      if (columns[i].name == "u_vy") command_ = i;
    }
  }
  void row(const Row& row) override {
    const auto index = static_cast<std::size_t>(std::llround(toSeconds(row.stamp - kStart) / kJointStatePeriod));
    const double command = row.values[command_];
    claims[index] = Claim{row.values[value_], command == std::floor(command) ? command : kNaN};
  }
  void clockJumped(Nanoseconds, double) override { std::abort(); }

  Claims claims;

 private:
  std::size_t value_ = 0;
  std::size_t command_ = 0;
};

Claims recordWithDemoLogger(const Truth& truth, const std::vector<Message>& commands, Alignment alignment,
                            double latency) {
  SynchroniserConfiguration configuration;
  StreamConfiguration stream;
  stream.name = "teleop_cmd";
  stream.topic = "teleop_cmd";
  stream.type = StreamType::twist;
  stream.alignment = alignment;
  stream.latency = latency;
  configuration.streams = {stream};
  Synchroniser synchroniser(configuration);
  ClaimCollector collector(truth.rows.size());
  synchroniser.begin(0);
  Nanoseconds last = 0;
  inOrderOfReceipt(truth.joint_states, commands, [&](bool is_joint_state, const Message& message) {
    Arrival arrival;
    arrival.stamp = message.stamp;
    arrival.receipt = arrival.steady = message.receipt;
    if (is_joint_state) {
      JointStateSample sample;
      sample.arrival = arrival;
      sample.names = {"joint"};
      sample.position = {0.0};
      synchroniser.push(std::move(sample));
    } else {
      StreamSample sample;
      sample.arrival = arrival;
      sample.type = StreamType::twist;
      sample.values = {message.value, static_cast<double>(message.index), 0.0, 0.0, 0.0, 0.0};
      synchroniser.push(0, std::move(sample));
    }
    last = message.receipt;
    synchroniser.advance(message.receipt - 1, collector);
  });
  synchroniser.end(last, collector);
  return collector.claims;
}

/// message_filters' policy as its users set it up: queue of 100, no bounds. Unstamped messages cannot go in; they are
/// stamped on receipt first, as people do.
Claims recordWithApproximateTime(const Truth& truth, const std::vector<Message>& commands) {
  struct Input : message_filters::SimpleFilter<sensor_msgs::JointState> {
    void give(const sensor_msgs::JointStateConstPtr& message) { signalMessage(message); }
  } joint_state_input;
  struct CommandInput : message_filters::SimpleFilter<geometry_msgs::TwistStamped> {
    void give(const geometry_msgs::TwistStampedConstPtr& message) { signalMessage(message); }
  } command_input;
  using Policy = message_filters::sync_policies::ApproximateTime<sensor_msgs::JointState, geometry_msgs::TwistStamped>;
  message_filters::Synchronizer<Policy> synchronizer(Policy(100), joint_state_input, command_input);
  Claims claims(truth.rows.size());
  const auto emit = [&](const sensor_msgs::JointStateConstPtr& joint_state,
                        const geometry_msgs::TwistStampedConstPtr& command) {
    claims[joint_state->header.seq] = Claim{command->twist.linear.x, command->twist.linear.y};
  };
  synchronizer.registerCallback(boost::bind<void>(emit, boost::placeholders::_1, boost::placeholders::_2));
  inOrderOfReceipt(truth.joint_states, commands, [&](bool is_joint_state, const Message& message) {
    const auto stamp = static_cast<std::uint64_t>(message.stamp != 0 ? message.stamp : message.receipt);
    if (is_joint_state) {
      auto joint_state = boost::make_shared<sensor_msgs::JointState>();
      joint_state->header.stamp.fromNSec(stamp);
      joint_state->header.seq = static_cast<std::uint32_t>(message.index);
      joint_state_input.give(joint_state);
    } else {
      auto command = boost::make_shared<geometry_msgs::TwistStamped>();
      command->header.stamp.fromNSec(stamp);
      command->twist.linear.x = message.value;
      command->twist.linear.y = message.index;
      command_input.give(command);
    }
  });
  return claims;
}

/// The usual logger: on each joint state, write whatever command came last; zero before the first.
Claims recordLatestValue(const Truth& truth, const std::vector<Message>& commands) {
  Claims claims(truth.rows.size());
  Claim latest{0.0, kNaN};
  inOrderOfReceipt(truth.joint_states, commands, [&](bool is_joint_state, const Message& message) {
    if (is_joint_state) {
      claims[static_cast<std::size_t>(message.index)] = latest;
    } else {
      latest = Claim{message.value, static_cast<double>(message.index)};
    }
  });
  return claims;
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return kNaN;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::floor(share * static_cast<double>(values.size() - 1)))];
}

std::string number(double value, int digits) {
  if (std::isnan(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// One line of the table: errors in time (issue stamp of the command written against that of the true one) and in the
/// command's own unit, over the rows that the recorder wrote with a value.
void printScore(const std::string& scenario, const std::string& recorder, const Truth& truth, const Claims& claims) {
  std::vector<double> milliseconds;
  std::vector<double> units;
  std::size_t possible = 0;
  for (std::size_t row = 0; row < truth.rows.size(); ++row) {
    const int true_command = truth.true_command[row];
    const double since_start = toSeconds(truth.rows[row] - kStart);
    if (true_command < 0 || since_start < 1.0 || since_start > kDuration - 1.0) continue;  // nobody knows a command yet
    ++possible;
    if (!claims[row] || std::isnan(claims[row]->value)) continue;
    const Message& in_force = truth.issued[static_cast<std::size_t>(true_command)];
    units.push_back(std::abs(claims[row]->value - in_force.value));
    if (!std::isnan(claims[row]->command)) {
      const Message& written = truth.issued[static_cast<std::size_t>(claims[row]->command)];
      milliseconds.push_back(std::abs(toSeconds(written.issued - in_force.issued)) * 1e3);
    }
  }
  const double coverage = 100.0 * static_cast<double>(units.size()) / static_cast<double>(possible);
  const bool mixes = milliseconds.size() * 2 < units.size();
  const auto milliseconds_at = [&](double share) {
    return mixes ? std::string("-") : number(quantile(milliseconds, share), 1);
  };
  std::printf("| %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", scenario.c_str(), recorder.c_str(),
              milliseconds_at(0.5).c_str(), milliseconds_at(0.99).c_str(), milliseconds_at(1.0).c_str(),
              number(quantile(units, 0.5) * 1e3, 2).c_str(), number(quantile(units, 0.99) * 1e3, 2).c_str(),
              number(quantile(units, 1.0) * 1e3, 2).c_str(), number(coverage, 1).c_str());
}

void printHeader() {
  std::printf(
      "| faults | recorder | p50 ms | p99 ms | max ms | p50 mm/s | p99 mm/s | max mm/s | rows with a command %% |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|\n");
}

}  // namespace
}  // namespace demo_logger

int main() {
  using namespace demo_logger;
  ros::Time::init();  // ApproximateTime asks for the time, though nothing depends on it
  const Network quiet{0.001, 0.0, 0.0};
  const Network delayed{0.020, 0.0, 0.0};
  const Network jittery{0.005, 0.030, 0.0};
  const Network bad{0.005, 0.030, 0.05};
  const std::uint64_t seed = 20240501;

  std::printf(
      "A row is right when it holds the command that was in force at its stamp s. Per row: the time between the issue "
      "of\n"
      "the command written and that of the true one (ms), and the difference of their values (mm/s; the command swings "
      "by\n"
      "0.25 m/s). Commands come every 10.1 ms, joint states every 2 ms, for 60 s; every recorder is given the same "
      "messages\n"
      "at the same instants. `linear` mixes two commands, so it has no ms; it tells where the hand was, not what was "
      "in\n"
      "force. ApproximateTime is message_filters' policy with a queue of 100, scored on the rows that it emits (last "
      "column);\n"
      "unstamped commands cannot go into it and are stamped on receipt first. `latest value` writes with each joint "
      "state\n"
      "the command that came last. Joint states lost on the way are missing from every recorder.\n\n");
  std::printf("### Faults between publisher and recorder; truth: the command issued as of s\n\n");
  printHeader();
  const std::vector<Scenario> first = {
      {"1 ms delay, stamped", true, quiet, {}, 0.0, 0.0},
      {"20 ms delay, stamped", true, delayed, {}, 0.0, 0.0},
      {"5 ms + 30 ms jitter, reordered, stamped", true, jittery, {}, 0.0, 0.0},
      {"the same and 5 % drops, stamped", true, bad, {}, 0.0, 0.0},
      {"1 ms delay, unstamped", false, quiet, {}, 0.0, 0.0},
      {"5 ms + 30 ms jitter, 5 % drops, unstamped", false, bad, {}, 0.0, 0.0},
      {"the same, 20 ms latency declared, unstamped", false, bad, {}, 0.0, 0.020},
      {"clock 40 ms ahead, 1 ms delay, stamped", true, quiet, {}, 0.040, 0.0},
      {"the same, 40 ms latency declared, stamped", true, quiet, {}, 0.040, 0.040},
  };
  for (const Scenario& scenario : first) {
    const Truth truth = simulate(scenario, false, seed);
    printScore(scenario.name, "demo_logger hold", truth,
               recordWithDemoLogger(truth, truth.commands, Alignment::hold, scenario.latency));
    printScore(scenario.name, "demo_logger linear", truth,
               recordWithDemoLogger(truth, truth.commands, Alignment::linear, scenario.latency));
    printScore(scenario.name, "ApproximateTime", truth, recordWithApproximateTime(truth, truth.commands));
    printScore(scenario.name, "latest value", truth, recordLatestValue(truth, truth.commands));
  }

  std::printf("\n### Faults on the way to the arm too; truth: the command in force at the arm\n\n");
  printHeader();
  const std::vector<Scenario> second = {
      {"both ways 1 ms delay, stamped", true, quiet, quiet, 0.0, 0.0},
      {"to the arm 20 ms delay, stamped", true, quiet, delayed, 0.0, 0.0},
      {"both ways 5 ms + 30 ms jitter, stamped", true, jittery, jittery, 0.0, 0.0},
      {"both ways the same and 5 % drops, stamped", true, bad, bad, 0.0, 0.0},
      {"both ways the same and 5 % drops, unstamped", false, bad, bad, 0.0, 0.0},
  };
  for (const Scenario& scenario : second) {
    const Truth truth = simulate(scenario, true, seed);
    printScore(scenario.name, "demo_logger hold, applied_command", truth,
               recordWithDemoLogger(truth, truth.applied, Alignment::hold, 0.0));
    printScore(scenario.name, "demo_logger linear, applied_command", truth,
               recordWithDemoLogger(truth, truth.applied, Alignment::linear, 0.0));
    printScore(scenario.name, "demo_logger hold, teleop_cmd", truth,
               recordWithDemoLogger(truth, truth.commands, Alignment::hold, 0.0));
    printScore(scenario.name, "ApproximateTime", truth, recordWithApproximateTime(truth, truth.commands));
    printScore(scenario.name, "latest value", truth, recordLatestValue(truth, truth.commands));
  }
  return 0;
}
