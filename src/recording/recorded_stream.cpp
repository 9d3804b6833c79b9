#include "recorded_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/not_a_number.h"
#include "demo_logger/trajectory/print.h"
#include "demo_logger/trajectory/quotation.h"

namespace demo_logger {
namespace {

/// Typed by hand with three digits, a quaternion is off by less.
constexpr double kUnitTolerance = 1e-3;

const char* nameOf(Alignment alignment) {
  switch (alignment) {
    case Alignment::hold:
      return "hold";
    case Alignment::linear:
      return "linear";
    case Alignment::nearest:
      return "nearest";
  }
  return "unknown";
}

/// Commands are what a policy learns to give; measurements beside them are not.
Role roleOf(StreamType type, Alignment alignment) {
  const bool commands = type == StreamType::twist || type == StreamType::pose || type == StreamType::joint_command;
  return commands && alignment == Alignment::hold ? Role::control : Role::auxiliary;
}

Interpolation interpolationOf(const StreamLayout& layout, std::size_t component, Alignment alignment) {
  if (alignment == Alignment::hold || layout.type == StreamType::joy) return Interpolation::hold;
  const auto orientation = layout.orientation();
  return orientation && component >= *orientation ? Interpolation::slerp : Interpolation::linear;
}

}  // namespace

RecordedStream::RecordedStream(const StreamConfiguration& configuration, std::size_t index, Nanoseconds max_gap,
                               Ledger& ledger)
    : configuration_(configuration),
      index_(index),
      ledger_(ledger),
      latency_(fromSeconds(configuration.latency)),
      layout_(configuration.type ? layoutOf(*configuration.type) : std::nullopt) {
  rule_.alignment = configuration.alignment;
  rule_.max_gap = max_gap;
  if (layout_) {
    rule_.width = layout_->width();
    rule_.orientation = layout_->orientation();
  }
}

std::string RecordedStream::title() const {
  return "stream " + configuration_.name + " (" + configuration_.topic + ")";
}

void RecordedStream::receive(StreamSample& sample, const char* rejected, const Reception& reception,
                             const DecidedRows& decided, bool columns_fixed) {
  ++received_;
  const Nanoseconds receipt = sample.arrival.receipt;
  if (rejected != nullptr || !fit(sample, columns_fixed, receipt)) {
    ++dropped_;
    ledger_.count(Counter::malformed_stream_messages);
    ledger_.report(FaultKind::malformed_message, index_, receipt, [&] { return whatDoesNotFit(sample, rejected); });
    return;
  }
  const std::optional<Nanoseconds> effective = place(sample.arrival, reception);
  if (!effective || !keepsOrder(*effective, receipt)) {
    ++dropped_;
    return;
  }
  checkValues(sample, receipt);
  watchFrame(sample.arrival);
  if (message_type_ != sample.message_type) message_type_ = std::move(sample.message_type);
  insert(*effective,
         StreamMessage{std::move(sample.values), reception.sequence, reception.episode, 0, publishers_.last()}, decided,
         receipt);
}

std::string RecordedStream::whatDoesNotFit(const StreamSample& sample, const char* rejected) const {
  if (rejected != nullptr) return title() + " sent a message with " + rejected + "; it was dropped";
  const std::string found =
      std::string(demo_logger::nameOf(sample.type)) + " with " + std::to_string(sample.values.size()) + " values";
  if (configuration_.type && sample.type != *configuration_.type) {
    return title() + " sent a " + found + ", expected a " + demo_logger::nameOf(*configuration_.type) +
           "; it was dropped";
  }
  if (layout_ && sample.type == layout_->type && sample.values.size() == layout_->width()) {
    return title() + " sent a " + found + " of other names or units than before; it was dropped";
  }
  const std::string expected = layout_ ? std::string(demo_logger::nameOf(layout_->type)) + " with " +
                                             std::to_string(layout_->width()) + " values"
                                       : std::string("as many values as names, each name once");
  return title() + " sent a " + found + ", expected " + expected + "; it was dropped";
}

bool RecordedStream::fit(StreamSample& sample, bool columns_fixed, Nanoseconds receipt) {
  if (configuration_.type && sample.type != *configuration_.type) return false;
  if (layout_) {
    if (const auto order = orderIn(*layout_, sample)) {
      if (order->empty()) return true;
      std::vector<double> ordered(sample.values.size());
      for (std::size_t i = 0; i < order->size(); ++i) ordered[(*order)[i]] = sample.values[i];
      sample.values = std::move(ordered);
      return true;
    }
    if (columns_fixed) return false;
  }
  std::optional<StreamLayout> shown = layoutOf(sample);
  if (!shown) return false;
  if (layout_) {
    ledger_.report(FaultKind::names_changed, index_, receipt,
                   [&] { return title() + " changed its components between episodes; it begins anew with them"; });
    buffer_.clear();
  }
  layout_ = std::move(shown);
  rule_.width = layout_->width();
  rule_.orientation = layout_->orientation();
  return true;
}

std::optional<Nanoseconds> RecordedStream::place(const Arrival& arrival, const Reception& reception) {
  switch (publishers_.place(arrival)) {
    case Placement::by_stamp:
      receipt_delay_.add(arrival.receipt - arrival.stamp);
      return arrival.stamp - latency_;
    case Placement::by_receipt:
      return arrival.receipt + reception.unstamped_shift - latency_;
    case Placement::nowhere:
      break;
  }
  ledger_.count(Counter::zero_stamps);
  ledger_.report(FaultKind::zero_stamp, index_, arrival.receipt, [&] {
    return title() + " had a message" + ofPublisher(arrival.publisher) +
           " with stamp 0 from a publisher that stamped its messages before; it was dropped";
  });
  return std::nullopt;
}

bool RecordedStream::keepsOrder(Nanoseconds effective, Nanoseconds receipt) {
  if (configuration_.in_order && newest_ && effective <= *newest_) {
    ledger_.report(FaultKind::out_of_order, index_, receipt, [&] {
      return title() + " is declared in_order, but a message came " + print(toSeconds(*newest_ - effective), 6) +
             " s behind the one before it; it was dropped. Without in_order it would be put into order";
    });
    return false;
  }
  newest_ = newest_ ? std::max(*newest_, effective) : effective;
  return true;
}

void RecordedStream::checkValues(StreamSample& sample, Nanoseconds receipt) {
  bool all_finite = true;
  for (double& value : sample.values) {
    if (std::isfinite(value)) continue;
    value = kNaN;
    all_finite = false;
    ledger_.count(Counter::non_finite_values);
  }
  if (!all_finite) {
    ledger_.report(FaultKind::non_finite_value, index_, receipt,
                   [&] { return title() + " sent a value that is not finite; it is recorded as NaN"; });
  }
  const auto orientation = layout_->orientation();
  if (!orientation) return;
  double square = 0.0;
  for (std::size_t i = *orientation; i < *orientation + 4; ++i) square += sample.values[i] * sample.values[i];
  const double norm = std::sqrt(square);
  if (!(std::abs(norm - 1.0) > kUnitTolerance)) return;  // of NaN, enough was said
  ledger_.count(Counter::non_unit_quaternions);
  ledger_.report(FaultKind::non_unit_quaternion, index_, receipt, [&] {
    return title() + " sent an orientation whose quaternion has length " + print(norm) +
           ", expected 1; it is recorded as it came";
  });
}

void RecordedStream::watchFrame(const Arrival& arrival) {
  if (frame_ && *frame_ == arrival.frame_id) return;
  if (frame_) {
    ledger_.report(FaultKind::frame_changed, index_, arrival.receipt, [&] {
      return title() + " changed its frame_id from '" + shortened(*frame_) + "' to '" + shortened(arrival.frame_id) +
             "'";
    });
  }
  frame_ = arrival.frame_id;
}

void RecordedStream::insert(Nanoseconds effective, StreamMessage message, const DecidedRows& decided,
                            Nanoseconds receipt) {
  if (!left_out_) {
    const Reach reach = reachOf(effective, buffer_, rule_);
    if (decided.anyWithin(reach.begin, reach.end)) ++late_;
  }
  if (buffer_.insert(effective, std::move(message))) return;
  ++dropped_;
  ledger_.count(Counter::overflow);
  ledger_.report(FaultKind::overflow, index_, receipt, [&] {
    return title() + " sent more than " + std::to_string(StreamBuffer::kCapacity) +
           " messages ahead of the joint states; the oldest are lost. Do both keep the same clock?";
  });
}

std::vector<Column> RecordedStream::columns() const {
  const std::string prefix = configuration_.name == "teleop_cmd" ? "u" : configuration_.name;
  std::vector<Column> columns;
  for (std::size_t i = 0; i < layout_->width(); ++i) {
    const StreamLayout::Component& component = layout_->components[i];
    columns.push_back({prefix + "_" + component.suffix, component.unit, roleOf(layout_->type, rule_.alignment),
                       interpolationOf(*layout_, i, rule_.alignment), configuration_.topic + "/" + component.source});
  }
  columns.push_back({prefix + "_age", "s", Role::auxiliary, Interpolation::none, configuration_.topic + "/age"});
  return columns;
}

void RecordedStream::write(Nanoseconds instant, Nanoseconds receipt, std::uint64_t episode,
                           std::vector<double>& values) {
  if (!layout_) return;
  const std::size_t begin = values.size();
  values.resize(begin + width());
  const Chosen chosen = chooseFrom(buffer_, rule_, instant, &values[begin]);
  values.back() = chosen.age;
  for (StreamMessage* message : {chosen.message, chosen.later}) {
    if (message == nullptr || message->used_in == episode) continue;
    message->used_in = episode;
    ++used_;
  }
  if (!chosen.unbridged) return;
  ledger_.count(Counter::unbridged_gaps);
  ledger_.report(FaultKind::unbridged, index_, receipt, [&] {
    return title() + " could not be interpolated: no later message came in time, or more than max_gap (" +
           print(toSeconds(rule_.max_gap)) + " s) after the earlier one; such values are NaN";
  });
}

bool RecordedStream::decides(Nanoseconds instant) const {
  // A message at the instant itself decides too: one with the same stamp would be out of order.
  return configuration_.in_order && newest_ && *newest_ >= instant;
}

void RecordedStream::beginEpisode() {
  received_ = used_ = late_ = dropped_ = 0;
  receipt_delay_ = {};
  left_out_ = false;
  publishers_.forgetHeard();
  for (const auto& [effective, message] : buffer_.messages()) publishers_.hear(message.publisher);
}

void RecordedStream::restartClock(std::uint64_t first, bool keep_unstamped) {
  const bool void_too = !keep_unstamped && isPlacedByReceipt();
  StreamBuffer::Messages kept = buffer_.extractSince(first);
  buffer_.clear();
  newest_.reset();
  publishers_.forgetHeard();
  if (void_too) return;
  for (auto& [effective, message] : kept) {
    newest_ = effective;
    publishers_.hear(message.publisher);
    buffer_.insert(effective, std::move(message));
  }
}

StreamMetadata RecordedStream::metadata(std::uint64_t episode) const {
  StreamMetadata metadata;
  metadata.name = configuration_.name;
  metadata.topic = configuration_.topic;
  metadata.type = message_type_;
  if (metadata.type.empty() && layout_) metadata.type = demo_logger::nameOf(layout_->type);
  if (metadata.type.empty() && configuration_.type) metadata.type = demo_logger::nameOf(*configuration_.type);
  metadata.frame_id = frame_.value_or("");
  metadata.publishers = publishers_.heard();
  metadata.stamped = !publishers_.anyUnstamped();
  metadata.align = nameOf(configuration_.alignment);
  metadata.latency = configuration_.latency;
  metadata.received = received_;
  metadata.used = used_;
  metadata.late = late_;
  metadata.dropped = dropped_;
  metadata.largest_gap = toSeconds(buffer_.largestGapIn(episode));
  metadata.receipt_delay = receipt_delay_.summary();
  return metadata;
}

}  // namespace demo_logger
