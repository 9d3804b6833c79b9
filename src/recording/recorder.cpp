#include "demo_logger/recording/recorder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"
#include "recorder_implementation.h"

namespace demo_logger {

namespace {

constexpr char kComplete[] = "complete";
constexpr char kClockJumped[] = "interrupted: clock jumped";
constexpr char kNotFinished[] = "interrupted: not finished";

RecorderConfiguration validated(RecorderConfiguration configuration) {
  requireChannel(configuration.metadata.channel);
  requireOutcome(configuration.metadata.outcome);
  const double split_gap = configuration.split_gap;
  if (!(split_gap == 0.0 || (std::isfinite(split_gap) && split_gap > configuration.synchroniser.max_wait))) {
    throw ConfigurationError("split_gap is " + print(split_gap) +
                             " s, expected 0 (never) or more than max_wait, which is " +
                             print(configuration.synchroniser.max_wait) + " s.");
  }
  return configuration;
}

/// Either way: a reset of simulated time sets receipts back.
bool isSecondAway(Nanoseconds instant, Nanoseconds other) {
  return instant >= other + kNanosecondsPerSecond || other >= instant + kNanosecondsPerSecond;
}

}  // namespace

Recorder::Implementation::Implementation(RecorderConfiguration configuration,
                                         std::vector<std::unique_ptr<DerivedColumns>> derived)
    : configuration_(validated(std::move(configuration))),
      derived_(std::move(derived)),
      synchroniser_(configuration_.synchroniser),
      archive_(configuration_.output_directory),
      starts_by_itself_(configuration_.autostart),
      said_(configuration_.metadata) {
  // Takes a number and gives it back, so that a directory that cannot be recorded into is found out now.
  const EpisodeReservation trial(configuration_.output_directory);
  if (configuration_.autostart) {
    requireRoom();
  }
  try {
    recovered_ = recover(configuration_.output_directory);
  } catch (const FileError& error) {
    // What an earlier recording left behind must not prevent the next one.
    faults_.report(DiskFaultKind::recovery, 0, error.what(), /*lasting=*/false);
  }
}

Recorder::Implementation::~Implementation() { endByItself(kNotFinished); }

void Recorder::Implementation::push(JointStateSample sample) {
  if (carriesArm(sample)) {
    const Nanoseconds receipt = sample.arrival.receipt;
    const std::optional<Nanoseconds> previous = std::exchange(last_receipt_, receipt);
    if (episode_ && previous && isPause(*previous, receipt)) {
      // Messages of the streams that came within the gap may still belong to the last rows.
      finishRows(*previous + fromSeconds(configuration_.split_gap));
      endByItself(kComplete);
      beginByItself(receipt - 1);
    } else if (!episode_ && mayBeginByItself(receipt)) {
      beginByItself(receipt - 1);
    }
  }
  synchroniser_.push(std::move(sample));
}

void Recorder::Implementation::advance(Nanoseconds watermark) {
  synchroniser_.advance(watermark, *this);
  if (episode_ && isSecondAway(watermark, saved_)) {
    saved_ = watermark;
    episode_->save(everything(kNotFinished));
  }
  archive_.collect();
}

void Recorder::Implementation::opened(const std::vector<Column>& columns, Nanoseconds /*first_stamp*/) {
  if (episode_) {
    episode_->open(columns, synchroniser_.originalNames());
  }
}

void Recorder::Implementation::row(const Row& row) {
  if (episode_) {
    episode_->write(row);
  }
}

void Recorder::Implementation::clockJumped(Nanoseconds /*stamp*/, double /*seconds*/) {
  if (!episode_) {
    return;
  }
  endByItself(kClockJumped);
  if (configuration_.autostart && !ending_) {
    beginByItself(0);  // with the joint state that showed the jump
  }
}

/// Whether the message can make a row, as far as can be told before the synchroniser looks at it.
bool Recorder::Implementation::carriesArm(const JointStateSample& sample) const {
  const std::vector<std::string>& joints = synchroniser_.joints();
  return joints.empty() || sample.names.empty() ||
         std::find(sample.names.begin(), sample.names.end(), joints.front()) != sample.names.end();
}

bool Recorder::Implementation::isPause(Nanoseconds previous, Nanoseconds receipt) const {
  return configuration_.split_gap > 0.0 && previous > begun_ &&
         receipt - previous > fromSeconds(configuration_.split_gap);
}

bool Recorder::Implementation::mayBeginByItself(Nanoseconds receipt) const {
  return starts_by_itself_ && (!failed_at_ || isSecondAway(receipt, *failed_at_));
}

void Recorder::Implementation::requireRoom() const {
  const std::uintmax_t bytes_free = freeSpace(configuration_.output_directory);
  if (bytes_free < configuration_.minimum_free_space) {
    throw FileError("disk full: " + configuration_.output_directory.string() + " has " + std::to_string(bytes_free) +
                    " bytes free, an episode begins with at least " +
                    std::to_string(configuration_.minimum_free_space) +
                    ". Make room or choose another output directory.");
  }
}

void Recorder::Implementation::begin(Nanoseconds request, const Metadata& metadata) {
  requireRoom();
  episode_.emplace(EpisodeReservation(configuration_.output_directory), metadata, configuration_.writer, derived_);
  said_ = metadata;
  begun_ = request;
  lost_before_ = lost_;
  starts_by_itself_ = false;
  synchroniser_.begin(request);
}

/// Nobody waits for an answer: what goes wrong becomes a fault, and is tried again a second later.
void Recorder::Implementation::beginByItself(Nanoseconds request) {
  try {
    begin(request, Metadata(said_));
  } catch (const FileError& error) {
    faults_.report(DiskFaultKind::begin, last_receipt_.value_or(0), error.what(), /*lasting=*/false);
    starts_by_itself_ = true;
    failed_at_ = last_receipt_;
  }
}

void Recorder::Implementation::finishRows(Nanoseconds request) {
  ending_ = true;
  synchroniser_.end(request, *this);
  ending_ = false;
}

/// Saves the episode without waiting.
void Recorder::Implementation::endByItself(const char* status) {
  if (!episode_) {
    return;
  }
  ended_with_rows_ = episode_->writer() != nullptr;
  if (ended_with_rows_) {
    archive_.addLater(episode_->takeWriter(), everything(status));
  }
  episode_.reset();
}

/// Gives the episode the rows that are still due, and waits until it is saved. False if it never had a row.
bool Recorder::Implementation::endOnRequest(Nanoseconds now) {
  finishRows(now);
  if (!episode_) {  // the clock jumped within the last messages, and the episode is being saved already
    archive_.wait();
    return ended_with_rows_;
  }
  const bool had_rows = episode_->writer() != nullptr;
  if (had_rows) {
    const Metadata metadata = everything(kComplete);
    archive_.add(episode_->takeWriter(), metadata);
  }
  episode_.reset();
  return had_rows;
}

/// What was said about the open episode, and what was counted in it.
Metadata Recorder::Implementation::everything(const char* status) const {
  Metadata metadata = episode_->metadata;
  metadata.status = status;
  metadata.robot.joints = synchroniser_.joints();
  metadata.streams = synchroniser_.streams();
  metadata.counters = synchroniser_.counters();
  metadata.faults = synchroniser_.faults();
  const std::vector<Fault> of_derived_columns = episode_->faults();
  metadata.faults.insert(metadata.faults.end(), of_derived_columns.begin(), of_derived_columns.end());
  for (const auto& [counter, total] : lost_) {
    const auto before = lost_before_.find(counter);
    metadata.counters[counter] = total - (before == lost_before_.end() ? 0 : std::min(before->second, total));
  }
  if (const std::optional<double> offset = synchroniser_.clockOffset()) {
    metadata.parameters["clock_offset"] = *offset;
  }
  return metadata;
}

}  // namespace demo_logger
