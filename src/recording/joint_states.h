#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "alignment.h"
#include "demo_logger/recording/sample.h"
#include "demo_logger/recording/stream_configuration.h"
#include "joint_layout.h"
#include "ledger.h"
#include "publisher_table.h"
#include "stream_buffer.h"

namespace demo_logger {

/// When and under which circumstances a message is looked at.
struct Reception {
  Nanoseconds received = 0;         // as it counts
  std::uint64_t sequence = 0;       // its place in the order of all messages
  std::uint64_t episode = 0;        // in which it was received
  Nanoseconds unstamped_shift = 0;  // from the receipt of an unstamped message to its stamp
};

/// A joint state that can make a row.
struct JointRow {
  Nanoseconds stamp = 0;
  Nanoseconds receipt = 0;   // as it came
  Nanoseconds received = 0;  // as it counts
  Nanoseconds steady = 0;
  std::uint64_t sequence = 0;
  bool stamped = true;
  std::vector<double> values;  // q…, dq…, tau…, receipt_delay
  std::vector<bool> carried;   // which joints it has; empty: all
};

/// Reads joint states: finds the arm's joints by name, and says which messages make rows. When merging, the joints of
/// all messages are also kept as streams, for the joints that the row's message does not carry.
class JointStates {
 public:
  JointStates(const SynchroniserConfiguration& configuration, Ledger& ledger);

  std::optional<JointRow> read(JointStateSample& sample, const char* rejected, const Reception& reception);
  /// Whether read() would probably make a row of it, for a look ahead.
  bool looksLikeRow(const JointStateSample& sample) const;

  /// The arm's joints in column order, once a message that can make a row was read.
  const std::vector<std::string>& joints() const { return ready_ ? layout_.joints() : kNone; }

  /// Fixes for an episode which joints are merged: those that its first row lacks.
  void fixMerged(const JointRow& first);
  const std::vector<std::size_t>& merged() const { return merged_; }
  /// Whether `row` has all joints that are not merged; counted and reported if not.
  bool suffices(const JointRow& row);
  /// Fills in the merged joints of the row at `instant`, and appends their ages.
  void writeMerged(Nanoseconds instant, Nanoseconds receipt, std::vector<double>& values);

  void beginEpisode();
  void prune(Nanoseconds horizon);
  /// Forgets the merged joints' messages from before the message `first`: their clock is void.
  void restartClock(std::uint64_t first);
  std::size_t size() const;

 private:
  struct JointPublishers {
    std::optional<std::size_t> last;
    std::optional<std::size_t> earlier;  // the one before
  };

  /// Where the message has the arm's joints; nullptr (counted, reported) if it has none that can be used.
  const JointMapping* mapJoints(JointStateSample& sample, const char* rejected, Nanoseconds receipt);
  std::optional<Nanoseconds> place(const JointStateSample& sample, const Reception& reception);
  void reportUnstamped(const Arrival& arrival);
  void watchPublishers(const JointMapping& mapping, Nanoseconds receipt);
  void watchNames(const JointMapping& mapping, const Arrival& arrival);
  std::vector<double> valuesOf(const JointStateSample& sample, const JointMapping& mapping);
  void keepParts(const JointMapping& mapping, const std::vector<double>& values, Nanoseconds stamp,
                 const Reception& reception);
  void reportPartial(const std::vector<std::string>& lacking, const std::string& publisher, Nanoseconds receipt);

  static const std::vector<std::string> kNone;

  Ledger& ledger_;
  JointLayout layout_;
  bool merging_;
  AlignmentRule merging_rule_;
  bool ready_ = false;
  PublisherTable publishers_;
  std::vector<JointPublishers> publishers_of_joint_;
  std::uint64_t last_mapping_ = 0;
  std::vector<std::string> last_names_;  // sorted, of the last message that could make a row
  std::optional<std::string> last_frame_;
  std::vector<StreamBuffer> parts_;  // per joint, when merging: position, velocity, effort
  std::vector<std::size_t> merged_;
};

}  // namespace demo_logger
