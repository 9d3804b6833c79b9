#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/sample.h"
#include "demo_logger/recording/stream_configuration.h"
#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"

namespace demo_logger {

/// One synchronised row. `values` follows the columns given to RowListener::opened, without the time.
struct Row {
  Nanoseconds stamp = 0;    // effective stamp of its joint state
  Nanoseconds receipt = 0;  // of its joint state, ROS time
  std::vector<double> values;
};

/// Told what the synchroniser finds, in order: opened, row, row, …
class RowListener {
 public:
  virtual ~RowListener() = default;
  /// The columns of the episode, which no longer change. `first` is the first row that will follow.
  virtual void opened(const std::vector<Column>& columns, Nanoseconds first_stamp) = 0;
  virtual void row(const Row& row) = 0;
  /// The joint states' clock jumped by `seconds`, to `stamp`. Every row before the jump has been given; the episode has
  /// ended. Here, and only here, the listener may call Synchroniser::begin; begin(0) makes the joint state that showed
  /// the jump the first row.
  virtual void clockJumped(Nanoseconds stamp, double seconds) = 0;
};

/// Turns joint states and streams into rows: one row per JointState that carries the arm's joints, each stream's value
/// in it chosen by the stream's Alignment. Live recording and bag import both feed this class.
///
/// What a row holds depends on stamps and receipt stamps alone, never on the order of the calls to push: everything
/// received up to the watermark is put into order by receipt before it is looked at (equal receipts: streams as
/// configured, then joint states; of one source by stamp, then as pushed). A row received at r is released when the
/// watermark has passed r + max_wait + the largest positive latency, and holds what was received until then.
///
/// A clock of the joint states that jumps (more than 1 s, believed after two joint states that agree) ends the episode.
/// The messages received before the jump are forgotten then, since their stamps are of a clock that is gone: `hold` is
/// NaN until a stream sends again. A watermark that falls by more than 1 s says that the clock of the receipts was set
/// back: rows in wait are finished with what was received before.
/// Not thread-safe; allocates; never throws after construction.
class Synchroniser {
 public:
  /// Throws ConfigurationError (see validate).
  explicit Synchroniser(const SynchroniserConfiguration& configuration);
  ~Synchroniser();
  Synchroniser(Synchroniser&&) noexcept;
  Synchroniser& operator=(Synchroniser&&) noexcept;

  void push(JointStateSample sample);
  /// `stream` is the index in SynchroniserConfiguration::streams.
  void push(std::size_t stream, StreamSample sample);

  /// Starts an episode: its rows are the joint states received after `request` [ROS time], as far as no watermark has
  /// passed them yet. Ignored while one is open.
  void begin(Nanoseconds request);
  /// Ends the episode: rows received after `request` are not in it, those before are finished with what has been
  /// pushed by now, and given to the listener. Ignored when none is open.
  void end(Nanoseconds request, RowListener& listener);

  /// The caller promises that nothing received at or before `watermark` [ROS time] will be pushed any more (what is,
  /// counts as received at the watermark). Gives the listener every row that this makes final.
  void advance(Nanoseconds watermark, RowListener& listener);

  /// The arm's joints in column order; empty until a joint state that can make a row has been received.
  const std::vector<std::string>& joints() const;

  /// Median of receipt − stamp over the first second of joint states [s]; nothing before that second has passed.
  std::optional<double> clockOffset() const;

  /// Receipt (ROS time) of the last message pushed, whether it can be used or not; nothing before the first.
  std::optional<Nanoseconds> lastJointState() const;
  std::optional<Nanoseconds> lastOf(std::size_t stream) const;

  /// Since the episode began (or since the construction, before the first): per stream, and the counters
  ///   rows, late_rows, duplicate_rows, partial_joint_states, foreign_joint_states, malformed_joint_states,
  ///   malformed_stream_messages, zero_stamps, non_finite_values, non_unit_quaternions, gaps, unbridged_gaps,
  ///   clock_outliers, overflow (more than memory is bounded to), pushed_late (behind the watermark).
  std::vector<StreamMetadata> streams() const;
  std::map<std::string, std::uint64_t> counters() const;
  /// What was not as it should be, each kind once with its count: joint states with names changed, frame_id changed,
  /// two publishers of one joint, gaps, streams left out, clock offset, unstamped stream on a distant clock, ….
  std::vector<Fault> faults() const;

  /// The columns of the last opened episode whose names were made portable: column name -> name before.
  const std::map<std::string, std::string>& originalNames() const;
  /// Messages and rows now in memory. Bounded, whatever is sent.
  std::size_t size() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace demo_logger
