#include "demo_logger/recording/synchroniser.h"

#include <algorithm>
#include <utility>

#include "inbox.h"
#include "sequencer.h"

namespace demo_logger {
namespace {

/// In the year 2112. Keeps every sum and difference of instants within 64 bits.
constexpr Nanoseconds kLatestInstant = 4'500'000'000'000'000'000;
/// A watermark that everything has passed, whatever rows wait for.
constexpr Nanoseconds kEndOfReceipts = 2 * kLatestInstant;
constexpr std::size_t kMostValues = 1000;
constexpr std::size_t kLongestText = 255;

bool isInstant(Nanoseconds instant) { return instant >= 0 && instant <= kLatestInstant; }

void limit(std::string& text) {
  if (text.size() > kLongestText) text = text.substr(0, kLongestText);
}

/// Texts are cut and clocks kept within bounds; an impossible stamp is reported.
const char* whyRejected(Arrival& arrival) {
  limit(arrival.publisher);
  limit(arrival.frame_id);
  arrival.receipt = std::clamp<Nanoseconds>(arrival.receipt, 0, kLatestInstant);
  arrival.steady = std::clamp<Nanoseconds>(arrival.steady, 0, kLatestInstant);
  return isInstant(arrival.stamp) ? nullptr : "an impossible stamp";
}

Message toMessage(JointStateSample sample) {
  const char* rejected = whyRejected(sample.arrival);
  if (std::max({sample.names.size(), sample.position.size(), sample.velocity.size(), sample.effort.size()}) >
      kMostValues) {
    rejected = "more than 1000 joints";
  }
  if (rejected != nullptr) sample = JointStateSample{std::move(sample.arrival), {}, {}, {}, {}};
  const Nanoseconds received = sample.arrival.receipt;
  return Message{kJointStates, received, std::move(sample), rejected};
}

Message toMessage(std::size_t stream, StreamSample sample) {
  const char* rejected = whyRejected(sample.arrival);
  if (std::max({sample.components.size(), sample.units.size(), sample.values.size()}) > kMostValues) {
    rejected = "more than 1000 values";
  }
  if (rejected != nullptr) sample = StreamSample{std::move(sample.arrival), {}, sample.type, {}, {}, {}};
  const Nanoseconds received = sample.arrival.receipt;
  return Message{stream, received, std::move(sample), rejected};
}

}  // namespace

class Synchroniser::Implementation {
 public:
  explicit Implementation(const SynchroniserConfiguration& configuration)
      : sequencer_(configuration), last_of_(configuration.streams.size()) {}

  void push(JointStateSample sample) {
    last_joint_state_ = sample.arrival.receipt;
    put(toMessage(std::move(sample)));
  }

  void push(std::size_t stream, StreamSample sample) {
    if (stream >= last_of_.size()) {
      ledger_.count(Counter::malformed_stream_messages);
      return;
    }
    last_of_[stream] = sample.arrival.receipt;
    put(toMessage(stream, std::move(sample)));
  }

  /// Processes what was received until `until`. While the clock offset is needed and not known, messages stay in the
  /// inbox; `last_chance`: it is taken from what is there.
  void advance(Nanoseconds until, bool last_chance, RowListener& listener) {
    until = std::clamp(until, -kLatestInstant, kEndOfReceipts);
    if (inbox_.isSetBack(until)) {
      finishReceiptClock(listener);
      inbox_.restartAt(until);
    } else if (const std::size_t very_late = inbox_.raise(until)) {
      reportLate(until, very_late);
    }
    while (knowsClockOffset(last_chance)) {
      if (inbox_.next() == nullptr) {
        sequencer_.passTime(inbox_.watermark(), listener);
        return;
      }
      sequencer_.process(inbox_.take(), listener);
    }
  }

  void end(Nanoseconds request, RowListener& listener) {
    if (!sequencer_.isBegun()) return;
    advance(request, /*last_chance=*/true, listener);
    sequencer_.end(request, listener);
  }

  void begin(Nanoseconds request) {
    if (!sequencer_.isBegun()) ledger_.clear();
    sequencer_.begin(request);
  }

  std::map<std::string, std::uint64_t> counters() const {
    std::map<std::string, std::uint64_t> counters = sequencer_.ledger().counters();
    for (const auto& [name, count] : ledger_.counters()) counters[name] += count;
    return counters;
  }

  std::vector<Fault> faults() const {
    std::vector<Fault> faults = sequencer_.faults();
    faults.insert(faults.end(), ledger_.faults().begin(), ledger_.faults().end());
    return faults;
  }

  const Sequencer& sequencer() const { return sequencer_; }
  std::optional<Nanoseconds> lastJointState() const { return last_joint_state_; }
  std::optional<Nanoseconds> lastOf(std::size_t stream) const {
    return stream < last_of_.size() ? last_of_[stream] : std::nullopt;
  }
  std::size_t size() const { return inbox_.size() + sequencer_.size(); }

 private:
  void put(Message message) {
    const Nanoseconds receipt = message.received;
    const Inbox::Pushed pushed = inbox_.push(std::move(message));
    if (pushed.late) reportLate(receipt, 1);
    if (pushed.overflowed) reportOverflow(receipt);
  }

  void reportLate(Nanoseconds receipt, std::size_t messages) {
    ledger_.count(Counter::pushed_late, messages);
    ledger_.report(FaultKind::pushed_late, kJointStatesSubject, receipt, [] {
      return std::string(
          "a message reached the recorder when its time of receipt had been dealt with; it counts as received then. "
          "Is the machine overloaded?");
    });
  }

  void reportOverflow(Nanoseconds receipt) {
    ledger_.count(Counter::overflow);
    ledger_.report(FaultKind::overflow, kJointStatesSubject, receipt, [] {
      return "more than " + std::to_string(Inbox::kCapacity) +
             " messages wait to be synchronised; the oldest are lost. Is the machine overloaded?";
    });
  }

  /// What was received before the clock of the receipts was set back is dealt with, as far as it can be.
  void finishReceiptClock(RowListener& listener) {
    while (inbox_.next(/*all=*/true) != nullptr) {
      if (knowsClockOffset(/*last_chance=*/true)) {
        sequencer_.process(inbox_.take(), listener);
      } else {
        reportOverflow(inbox_.take().received);
      }
    }
    sequencer_.restartReceiptClock(listener);
  }

  /// Measures the clock offset by a look ahead into the inbox, where it is needed and not known.
  bool knowsClockOffset(bool last_chance) {
    if (!sequencer_.needsClockOffset()) return true;
    ClockOffset ahead = sequencer_.offset();
    inbox_.peek([this, &ahead](const Message& message) {
      const auto* sample = std::get_if<JointStateSample>(&message.sample);
      if (message.received > inbox_.watermark()) return false;
      if (sample != nullptr && sequencer_.jointStates().looksLikeRow(*sample)) {
        const Arrival& arrival = sample->arrival;
        ahead.add(message.received, arrival.stamp != 0 ? arrival.receipt - arrival.stamp : 0);
      }
      return !ahead.windowEnd() || message.received <= *ahead.windowEnd();
    });
    if (!last_chance && (!ahead.windowEnd() || inbox_.watermark() < *ahead.windowEnd())) return false;
    sequencer_.setOffset(std::move(ahead), inbox_.watermark());
    return !sequencer_.needsClockOffset();
  }

  Inbox inbox_;
  Ledger ledger_;  // of the inbox: what happens while pushing, before a message's turn comes
  Sequencer sequencer_;
  std::optional<Nanoseconds> last_joint_state_;
  std::vector<std::optional<Nanoseconds>> last_of_;
};

Synchroniser::Synchroniser(const SynchroniserConfiguration& configuration) {
  validate(configuration);
  implementation_ = std::make_unique<Implementation>(configuration);
}

Synchroniser::~Synchroniser() = default;
Synchroniser::Synchroniser(Synchroniser&&) noexcept = default;
Synchroniser& Synchroniser::operator=(Synchroniser&&) noexcept = default;

void Synchroniser::push(JointStateSample sample) { implementation_->push(std::move(sample)); }

void Synchroniser::push(std::size_t stream, StreamSample sample) { implementation_->push(stream, std::move(sample)); }

void Synchroniser::begin(Nanoseconds request) { implementation_->begin(request); }

void Synchroniser::end(Nanoseconds request, RowListener& listener) { implementation_->end(request, listener); }

void Synchroniser::advance(Nanoseconds watermark, RowListener& listener) {
  implementation_->advance(watermark, /*last_chance=*/false, listener);
}

const std::vector<std::string>& Synchroniser::joints() const {
  return implementation_->sequencer().jointStates().joints();
}

std::optional<double> Synchroniser::clockOffset() const {
  const std::optional<Nanoseconds> offset = implementation_->sequencer().offset().value();
  if (!offset) return std::nullopt;
  return toSeconds(*offset);
}

std::optional<Nanoseconds> Synchroniser::lastJointState() const { return implementation_->lastJointState(); }

std::optional<Nanoseconds> Synchroniser::lastOf(std::size_t stream) const { return implementation_->lastOf(stream); }

std::vector<StreamMetadata> Synchroniser::streams() const { return implementation_->sequencer().streams(); }

std::map<std::string, std::uint64_t> Synchroniser::counters() const { return implementation_->counters(); }

std::vector<Fault> Synchroniser::faults() const { return implementation_->faults(); }

const std::map<std::string, std::string>& Synchroniser::originalNames() const {
  return implementation_->sequencer().originalNames();
}

std::size_t Synchroniser::size() const { return implementation_->size(); }

}  // namespace demo_logger
