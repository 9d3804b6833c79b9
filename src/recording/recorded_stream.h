#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "alignment.h"
#include "delay_statistics.h"
#include "demo_logger/recording/sample.h"
#include "demo_logger/recording/stream_configuration.h"
#include "demo_logger/trajectory/column.h"
#include "demo_logger/trajectory/metadata.h"
#include "joint_states.h"
#include "ledger.h"
#include "publisher_table.h"
#include "row_queue.h"
#include "stream_buffer.h"
#include "stream_layout.h"

namespace demo_logger {

/// One configured stream: what its messages are, where on the time line they belong, and what they give to the rows.
class RecordedStream {
 public:
  RecordedStream(const StreamConfiguration& configuration, std::size_t index, Nanoseconds max_gap, Ledger& ledger);

  /// Takes a message in. `decided` are the rows that it can no longer change; while `columns_fixed`, messages with
  /// other components than the first are malformed, else the stream begins anew with them.
  void receive(StreamSample& sample, const char* rejected, const Reception& reception, const DecidedRows& decided,
               bool columns_fixed);

  /// Whether its columns are known: by its type or its first message.
  bool knowsColumns() const { return layout_.has_value(); }
  /// Its columns, the age last; needs knowsColumns().
  std::vector<Column> columns() const;
  std::size_t width() const { return layout_ ? layout_->width() + 1 : 0; }

  /// Appends its values and its age at `instant`; nothing while the columns are not known.
  void write(Nanoseconds instant, Nanoseconds receipt, std::uint64_t episode, std::vector<double>& values);
  /// Whether the row at `instant` holds the same now as at the end of its wait.
  bool decides(Nanoseconds instant) const;

  void leaveOut() { left_out_ = true; }
  bool isLeftOut() const { return left_out_; }

  void beginEpisode();
  void prune(Nanoseconds horizon) { buffer_.prune(horizon); }
  /// Forgets the messages from before the message `first`, and unless `keep_unstamped` all of a stream placed by
  /// receipt: their clock is void.
  void restartClock(std::uint64_t first, bool keep_unstamped);

  bool isPlacedByReceipt() const { return publishers_.anyUnstamped(); }
  const StreamConfiguration& configuration() const { return configuration_; }
  StreamMetadata metadata(std::uint64_t episode) const;
  std::size_t size() const { return buffer_.size(); }

 private:
  std::string whatDoesNotFit(const StreamSample& sample, const char* rejected) const;
  bool fit(StreamSample& sample, bool columns_fixed, Nanoseconds receipt);
  std::optional<Nanoseconds> place(const Arrival& arrival, const Reception& reception);
  bool keepsOrder(Nanoseconds effective, Nanoseconds receipt);
  void checkValues(StreamSample& sample, Nanoseconds receipt);
  void watchFrame(const Arrival& arrival);
  void insert(Nanoseconds effective, StreamMessage message, const DecidedRows& decided, Nanoseconds receipt);
  std::string title() const;  // "stream NAME (TOPIC)"

  StreamConfiguration configuration_;
  std::size_t index_;
  Ledger& ledger_;
  Nanoseconds latency_;
  std::optional<StreamLayout> layout_;
  AlignmentRule rule_;
  StreamBuffer buffer_;
  PublisherTable publishers_;
  std::optional<std::string> frame_;
  std::string message_type_;           // of the last message
  std::optional<Nanoseconds> newest_;  // effective stamp
  bool left_out_ = false;

  std::uint64_t received_ = 0;
  std::uint64_t used_ = 0;
  std::uint64_t late_ = 0;
  std::uint64_t dropped_ = 0;
  DelayStatistics receipt_delay_;
};

}  // namespace demo_logger
