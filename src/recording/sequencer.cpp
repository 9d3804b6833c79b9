#include "sequencer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "demo_logger/trajectory/print.h"
#include "row_columns.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kEarliestOffset = -20'000'000;
constexpr Nanoseconds kLatestOffset = 100'000'000;
constexpr Nanoseconds kDistantClock = kNanosecondsPerSecond;
constexpr std::uint64_t kNoMessage = std::numeric_limits<std::uint64_t>::max();
/// No joint state further behind the newest is accepted, so nothing older is asked for.
constexpr Nanoseconds kMemory = ClockWatch::kJump;
constexpr Nanoseconds kPruneEvery = kNanosecondsPerSecond / 10;
constexpr Nanoseconds kBeginningOfTime = std::numeric_limits<Nanoseconds>::min();
constexpr Nanoseconds kEndOfTime = std::numeric_limits<Nanoseconds>::max();

Nanoseconds later(Nanoseconds instant, Nanoseconds wait) {
  return instant > kEndOfTime - wait ? kEndOfTime : instant + wait;
}

Nanoseconds rowWait(const SynchroniserConfiguration& configuration) {
  Nanoseconds largest_latency = 0;
  for (const StreamConfiguration& stream : configuration.streams) {
    largest_latency = std::max(largest_latency, fromSeconds(stream.latency));
  }
  return fromSeconds(configuration.max_wait) + largest_latency;
}

}  // namespace

Sequencer::Sequencer(const SynchroniserConfiguration& configuration)
    : configuration_(configuration),
      wait_(rowWait(configuration)),
      wait_for_streams_(fromSeconds(configuration.wait_for_streams)),
      all_in_order_(!configuration.streams.empty()),
      joint_states_(configuration_, ledger_),
      pacing_(fromSeconds(configuration.max_gap)),
      pruned_to_(kBeginningOfTime) {
  for (std::size_t i = 0; i < configuration.streams.size(); ++i) {
    streams_.emplace_back(configuration.streams[i], i, fromSeconds(configuration.max_gap), ledger_);
    all_in_order_ = all_in_order_ && configuration.streams[i].in_order;
  }
}

void Sequencer::process(Message message, RowListener& listener) {
  passTime(message.received - 1, listener);
  Reception reception{message.received, ++sequence_, episode_, 0};
  if (configuration_.correct_clock_offset) reception.unstamped_shift = -offset_.value().value_or(0);
  if (message.source == kJointStates) {
    processJointState(message, reception, listener);
  } else {
    processStream(message, reception);
  }
  decideEarly();
  release(listener);
}

void Sequencer::passTime(Nanoseconds now, RowListener& listener) {
  now_ = now;
  startIfReached(now);
  if (!offset_.value() && offset_.windowEnd() && now >= *offset_.windowEnd()) freezeOffset(now);
  while (PendingRow* row = rows_.nextToDecide()) {
    if (row->deadline > now) break;
    decide(*row);
  }
  release(listener);
}

void Sequencer::restartReceiptClock(RowListener& listener) {
  decideAll();
  release(listener);
  ++clock_setting_;
  // Nothing will be received any more at the instants that were waited for.
  now_ = kBeginningOfTime;
  if (open_at_) open_at_ = now_;
  if (configuration_.correct_clock_offset || !offset_.value()) offset_ = ClockOffset();
  for (RecordedStream& stream : streams_) {
    if (stream.isPlacedByReceipt()) stream.restartClock(kNoMessage, /*keep_unstamped=*/false);
  }
}

void Sequencer::begin(Nanoseconds request) {
  if (request_) return;
  request_ = Request{request, clock_setting_};
  started_ = false;
  resetEpisode();
}

void Sequencer::startIfReached(Nanoseconds now) {
  if (!request_ || started_) return;
  if (request_->clock_setting == clock_setting_ && now < request_->receipt) return;
  // What was received between begin() and its request belongs to the time before.
  resetEpisode();
  started_ = true;
}

void Sequencer::resetEpisode() {
  ++episode_;
  ledger_.clear();
  rows_.clear();
  joint_states_.beginEpisode();
  for (RecordedStream& stream : streams_) stream.beginEpisode();
  opened_ = false;
  open_at_.reset();
  pacing_.clear();
}

void Sequencer::end(Nanoseconds request, RowListener& listener) {
  if (!request_) return;
  freezeOffset(request);
  rows_.removeIf(
      [this, request](const PendingRow& row) { return row.clock_setting == clock_setting_ && row.received > request; });
  decideAll();
  release(listener, /*open_now=*/true);
  close();
}

void Sequencer::close() {
  request_.reset();
  started_ = false;
  opened_ = false;
  open_at_.reset();
  rows_.clear();
}

void Sequencer::setOffset(ClockOffset offset, Nanoseconds now) {
  offset_ = std::move(offset);
  freezeOffset(now);
}

void Sequencer::freezeOffset(Nanoseconds now) {
  if (offset_.value()) return;
  offset_.freeze();
  offset_frozen_at_ = now;
}

void Sequencer::processStream(Message& message, const Reception& reception) {
  const bool columns_fixed = opened_ || rows_.size() > 0;
  streams_[message.source].receive(std::get<StreamSample>(message.sample), message.rejected, reception,
                                   rows_.decidedRows(), columns_fixed);
}

void Sequencer::processJointState(Message& message, const Reception& reception, RowListener& listener) {
  auto row = joint_states_.read(std::get<JointStateSample>(message.sample), message.rejected, reception);
  if (!row) return;
  switch (clock_watch_.judge({row->stamp, row->steady})) {
    case ClockWatch::Verdict::on_the_line:
      dropSuspect();
      accept(std::move(*row), listener);
      break;
    case ClockWatch::Verdict::suspect:
      dropSuspect();
      suspect_ = std::move(*row);
      break;
    case ClockWatch::Verdict::repeats_suspect:
      ledger_.count(Counter::duplicate_rows);
      break;
    case ClockWatch::Verdict::jumped:
      followJump(std::move(*row), listener);
      break;
  }
}

void Sequencer::dropSuspect() {
  if (!suspect_) return;
  ledger_.count(Counter::clock_outliers);
  ledger_.report(FaultKind::clock_outlier, kJointStatesSubject, suspect_->receipt, [] {
    return std::string(
        "a joint state's stamp was more than 1 s off, and the next one was not: it was dropped. Do two "
        "clocks stamp the joint states?");
  });
  suspect_.reset();
}

void Sequencer::followJump(JointRow row, RowListener& listener) {
  JointRow first = std::move(*suspect_);
  suspect_.reset();
  if (started_) {
    freezeOffset(now_);
    decideAll();
    release(listener, /*open_now=*/true);
    close();
    listener.clockJumped(first.stamp, toSeconds(clock_watch_.jump()));
  }
  offset_ = ClockOffset();
  const bool keep_unstamped = !configuration_.correct_clock_offset;
  for (RecordedStream& stream : streams_) stream.restartClock(first.sequence, keep_unstamped);
  joint_states_.restartClock(first.sequence);
  pruned_to_ = kBeginningOfTime;
  accept(std::move(first), listener);
  accept(std::move(row), listener);
}

void Sequencer::accept(JointRow row, RowListener& listener) {
  offset_.add(row.received, row.stamped ? row.receipt - row.stamp : 0);
  startIfReached(row.received - 1);
  if (started_) admit(std::move(row), listener);
  prune();
}

void Sequencer::admit(JointRow row, RowListener& listener) {
  const bool first = !open_at_;
  if (first) joint_states_.fixMerged(row);
  if (!joint_states_.suffices(row)) return;
  if (first) open_at_ = later(row.received, wait_for_streams_);

  const Nanoseconds stamp = row.stamp;
  const Nanoseconds receipt = row.receipt;
  PendingRow pending;
  pending.row = Row{stamp, receipt, std::move(row.values)};
  pending.received = row.received;
  pending.clock_setting = clock_setting_;
  pending.deadline = later(row.received, wait_);
  switch (rows_.admit(std::move(pending))) {
    case RowQueue::Admission::admitted:
      break;
    case RowQueue::Admission::duplicate:
      ledger_.count(Counter::duplicate_rows);
      return;
    case RowQueue::Admission::late:
      ledger_.count(Counter::late_rows);
      ledger_.report(FaultKind::late_row, kJointStatesSubject, receipt, [this, stamp] {
        return "a joint state came when later ones had become rows, " +
               print(toSeconds(pacing_.last().value_or(stamp) - stamp), 3) +
               " s behind them; it was dropped. A longer max_wait leaves more time to put them into order";
      });
      return;
  }
  if (rows_.size() <= kMostPendingRows) return;
  ledger_.count(Counter::overflow);
  ledger_.report(FaultKind::overflow, kJointStatesSubject, receipt, [] {
    return "more than " + std::to_string(kMostPendingRows) +
           " rows wait; the oldest is finished before its wait is over. Are max_wait or wait_for_streams too long?";
  });
  decide(*rows_.first());
  release(listener, /*open_now=*/true);
}

void Sequencer::decide(PendingRow& row) {
  if (row.decided) return;
  std::vector<double>& values = row.row.values;
  joint_states_.writeMerged(row.row.stamp, row.row.receipt, values);
  if (opened_) {
    values.reserve(width_);
    for (RecordedStream& stream : streams_) {
      if (!stream.isLeftOut()) stream.write(row.row.stamp, row.row.receipt, episode_, values);
    }
  } else {
    row.streams.resize(streams_.size());
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      streams_[i].write(row.row.stamp, row.row.receipt, episode_, row.streams[i]);
    }
  }
  rows_.decided(row);
}

void Sequencer::decideAll() {
  while (PendingRow* row = rows_.nextToDecide()) decide(*row);
}

void Sequencer::decideEarly() {
  if (!all_in_order_ || !joint_states_.merged().empty()) return;
  const auto settled = [](Nanoseconds stamp) {
    return [stamp](const RecordedStream& stream) { return stream.isLeftOut() || stream.decides(stamp); };
  };
  // Rows become final in the order of their stamps; what is decided already only waits for its columns.
  while (PendingRow* row = rows_.nextToDecide()) {
    if (!std::all_of(streams_.begin(), streams_.end(), settled(row->row.stamp))) break;
    decide(*row);
  }
}

void Sequencer::release(RowListener& listener, bool open_now) {
  for (PendingRow* first = rows_.first(); first != nullptr && first->decided; first = rows_.first()) {
    if (!opened_) {
      if (!open_now && !mayOpen()) return;
      open(listener);
    }
    PendingRow row = rows_.release();
    if (!row.streams.empty()) appendStreams(row);
    const Nanoseconds stamp = row.row.stamp;
    const std::optional<Nanoseconds> usual = pacing_.usualInterval();
    if (const std::optional<Nanoseconds> gap = pacing_.add(stamp)) {
      ledger_.count(Counter::gaps);
      ledger_.report(FaultKind::gap, kJointStatesSubject, row.row.receipt, [gap, usual] {
        return "a gap of " + print(toSeconds(*gap), 3) + " s in the joint states" +
               (usual ? ", which come every " + print(toSeconds(*usual)) + " s" : "") +
               "; were messages lost, or did the robot pause?";
      });
    }
    ledger_.count(Counter::rows);
    listener.row(row.row);
  }
}

bool Sequencer::mayOpen() const {
  return now_ >= *open_at_ ||
         std::all_of(streams_.begin(), streams_.end(), [](const auto& stream) { return stream.knowsColumns(); });
}

void Sequencer::open(RowListener& listener) {
  std::vector<Column> columns = jointColumns(configuration_, joint_states_.joints(), joint_states_.merged());
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    RecordedStream& stream = streams_[i];
    if (stream.knowsColumns()) {
      for (Column& column : stream.columns()) columns.push_back(std::move(column));
      continue;
    }
    stream.leaveOut();
    ledger_.report(FaultKind::left_out, i, rows_.first()->row.receipt, [this, &stream] {
      return "stream " + stream.configuration().name + " (" + stream.configuration().topic +
             ") is left out of this episode: no message showed its columns within wait_for_streams (" +
             print(configuration_.wait_for_streams) + " s) after the first joint state. Does it publish?";
    });
  }
  original_names_ = makePortable(columns);
  width_ = columns.size();
  opened_ = true;
  listener.opened(columns, rows_.first()->row.stamp);
}

void Sequencer::appendStreams(PendingRow& row) const {
  std::vector<double>& values = row.row.values;
  values.reserve(width_);
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (streams_[i].isLeftOut()) continue;
    const std::vector<double>& known = row.streams[i];
    values.insert(values.end(), known.begin(), known.end());
    // The stream sent its first message when this row was decided already.
    if (known.empty()) values.insert(values.end(), streams_[i].width(), std::numeric_limits<double>::quiet_NaN());
  }
}

void Sequencer::prune() {
  Nanoseconds horizon = *clock_watch_.newest() - kMemory;
  if (rows_.nextToDecide() != nullptr) horizon = std::min(horizon, rows_.first()->row.stamp);
  if (horizon < pruned_to_ + kPruneEvery) return;
  pruned_to_ = horizon;
  for (RecordedStream& stream : streams_) stream.prune(horizon);
  joint_states_.prune(horizon);
  rows_.forget(horizon);
}

std::vector<StreamMetadata> Sequencer::streams() const {
  std::vector<StreamMetadata> streams;
  for (const RecordedStream& stream : streams_) streams.push_back(stream.metadata(episode_));
  return streams;
}

std::vector<Fault> Sequencer::faults() const {
  std::vector<Fault> faults;
  const std::optional<Nanoseconds> offset = offset_.value();
  if (offset && (*offset < kEarliestOffset || *offset > kLatestOffset)) {
    faults.push_back(
        {offset_frozen_at_,
         "joint-state stamps are " + print(1000.0 * toSeconds(*offset), 1) + " ms from this clock (transport or skew)",
         1, Severity::warning});
  }
  if (offset && std::abs(*offset) > kDistantClock && !configuration_.correct_clock_offset) {
    for (const RecordedStream& stream : streams_) {
      if (!stream.isPlacedByReceipt()) continue;
      faults.push_back({offset_frozen_at_,
                        "stream " + stream.configuration().name + " (" + stream.configuration().topic +
                            ") has no stamps and is placed by this machine's clock, but the joint states' clock is " +
                            print(toSeconds(*offset), 3) +
                            " s away: its columns are useless. Synchronise the clocks, or set correct_clock_offset",
                        1, Severity::error});
    }
  }
  faults.insert(faults.end(), ledger_.faults().begin(), ledger_.faults().end());
  return faults;
}

std::size_t Sequencer::size() const {
  std::size_t size = rows_.size() + joint_states_.size() + (suspect_ ? 1 : 0);
  for (const RecordedStream& stream : streams_) size += stream.size();
  return size;
}

}  // namespace demo_logger
