#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "demo_logger/simulation/gaussian_noise.h"
#include "demo_logger/simulation/joint_sensors.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// What a bad driver or network does to joint states, for testing who records them. Probabilities are of each message,
/// independent of each other.
struct JointStateFaultsConfiguration {
  double delay = 0.0;                // [s] from the stamp to when it is sent
  double jitter = 0.0;               // [s] of the delay, evenly to either side; never below 0, and the order stays
  double drop = 0.0;                 // probability that it is not sent
  double duplicate = 0.0;            // that it is sent twice
  double zero_stamp = 0.0;           // that its stamp is 0
  double permute = 0.0;              // that its joints come in another order
  int split = 0;                     // the first so many joints in a message of their own; 0: all in one
  std::vector<std::string> gripper;  // joints that come with every reading in one more message, at rest at 0
  std::uint64_t seed = 1;
};

/// Throws ConfigurationError naming the field, its value and what was expected, for an arm of these joints.
void validate(const JointStateFaultsConfiguration& configuration, const std::vector<std::string>& joints);

/// A message to be sent.
struct JointStateMessage {
  Nanoseconds stamp = 0;
  std::vector<std::string> names;
  JointReading reading;
};

/// Turns readings into messages, and keeps each until it is due. As configured by default every reading is one message
/// at once. The same seed gives the same faults: each message costs the same random numbers whatever they decide.
class JointStateFaults {
 public:
  struct Counters {
    std::uint64_t messages = 0;  // made from readings, before drops and duplicates
    std::uint64_t dropped = 0;
    std::uint64_t duplicated = 0;
    std::uint64_t zero_stamped = 0;
    std::uint64_t permuted = 0;
  };

  /// Throws ConfigurationError as validate() does.
  JointStateFaults(const JointStateFaultsConfiguration& configuration, std::vector<std::string> joints);

  void offer(Nanoseconds stamp, const JointReading& reading);

  /// What is due at `now`, in the order it is to be sent.
  std::vector<JointStateMessage> take(Nanoseconds now);

  const Counters& counters() const { return counters_; }

 private:
  struct Waiting {
    Nanoseconds due;
    JointStateMessage message;
  };
  void queue(JointStateMessage message);
  void permute(JointStateMessage& message, bool apply);
  bool happens(double probability);

  JointStateFaultsConfiguration configuration_;
  std::vector<std::string> joints_;
  GaussianNoise random_;
  std::deque<Waiting> waiting_;
  Counters counters_;
};

}  // namespace demo_logger
