#include <limits>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "recorder_implementation.h"

namespace demo_logger {

namespace {

Reply failure(const std::string& message) { return {false, message, {}, {}, 0}; }

Reply success(const std::string& message, const std::string& id = {}, const std::filesystem::path& file = {},
              std::uint64_t rows = 0) {
  return {true, message, id, file, rows};
}

void setIfGiven(std::string& text, const std::string& given) {
  if (!given.empty()) {
    text = given;
  }
}

void add(const std::vector<Fault>& more, std::vector<Fault>& faults) {
  faults.insert(faults.end(), more.begin(), more.end());
}

}  // namespace

Reply Recorder::Implementation::start(Nanoseconds now, const std::string& channel, const std::string& task,
                                      const std::string& operator_name, const std::string& notes) {
  if (episode_) {
    return failure(episode_->id() + " is being recorded; stop or discard it before the next start.");
  }
  Metadata metadata = configuration_.metadata;
  setIfGiven(metadata.channel, channel);
  setIfGiven(metadata.task, task);
  setIfGiven(metadata.operator_name, operator_name);
  setIfGiven(metadata.notes, notes);
  try {
    requireChannel(metadata.channel);
    begin(now, metadata);
  } catch (const Error& error) {
    return failure(error.what());
  }
  return success("Recording " + episode_->id() + ".", episode_->id(), episode_->file());
}

Reply Recorder::Implementation::stop(Nanoseconds now, const std::string& outcome, const std::string& notes) {
  if (!episode_) {
    return failure("Nothing is being recorded; start an episode first.");
  }
  try {
    requireOutcome(outcome.empty() ? "unknown" : outcome);
  } catch (const ConfigurationError& error) {
    return failure(error.what());
  }
  std::string& all_notes = episode_->metadata.notes;
  setIfGiven(episode_->metadata.outcome, outcome);
  all_notes += (all_notes.empty() || notes.empty() ? "" : "\n") + notes;
  return end(now);
}

Reply Recorder::Implementation::end(Nanoseconds now) {
  const std::string id = episode_->id();
  if (!endOnRequest(now)) {
    return failure(whyNoRow(id));
  }
  const ClosedEpisode& saved = archive_.last();
  if (!saved.error.empty()) {
    return failure(saved.error);
  }
  const std::string missing =
      saved.not_written == 0 ? "" : ", " + std::to_string(saved.not_written) + " more found no room on the disk";
  return success("Saved " + saved.id + " with " + std::to_string(saved.rows) + " rows" + missing + ".", saved.id,
                 saved.file, saved.rows);
}

std::string Recorder::Implementation::whyNoRow(const std::string& id) const {
  const std::string start = id + " has no row and left no file: ";
  const std::string& topic = configuration_.joint_states_topic;
  if (!synchroniser_.lastJointState()) {
    return start + "no joint state has arrived on " + topic + ". Is the robot publishing, and on this topic?";
  }
  return start + "no joint state with the arm's joints has arrived on " + topic +
         " since the start. Is the robot publishing, and are these its joints?";
}

Reply Recorder::Implementation::discard(Nanoseconds now) {
  if (episode_) {
    const std::string id = episode_->id();
    if (!endOnRequest(now)) {
      return success("Discarded " + id + ", which had no row yet and left no file.", id);
    }
    if (!archive_.last().error.empty()) {
      return failure(archive_.last().error);
    }
  }
  try {
    const ClosedEpisode discarded = archive_.discardLast();
    return success("Discarded " + discarded.id + "; its data are kept in " + discarded.file.string() + ".",
                   discarded.id, discarded.file, discarded.rows);
  } catch (const FileError& error) {
    return failure(error.what());
  }
}

Reply Recorder::Implementation::label(const std::string& id, const EpisodeLabel& label) {
  if (label.outcome.empty() && label.task.empty() && label.operator_name.empty() && label.notes.empty()) {
    return failure("Nothing was changed: outcome, task, operator_name and notes are all empty.");
  }
  try {
    if (episode_ && (id.empty() || id == episode_->id())) {
      labelOpen(label);
      return success("Labelled " + episode_->id() + ".", episode_->id(), episode_->file());
    }
    const std::string labelled = archive_.label(id, label);
    return success("Labelled " + labelled + ".", labelled, configuration_.output_directory / (labelled + ".csv"));
  } catch (const Error& error) {
    return failure(error.what());
  }
}

void Recorder::Implementation::labelOpen(const EpisodeLabel& label) {
  if (!label.outcome.empty()) {
    requireOutcome(label.outcome);
  }
  Metadata& metadata = episode_->metadata;
  setIfGiven(metadata.outcome, label.outcome);
  setIfGiven(metadata.task, label.task);
  setIfGiven(metadata.operator_name, label.operator_name);
  setIfGiven(metadata.notes, label.notes);
}

Reply Recorder::Implementation::close(Nanoseconds now) {
  starts_by_itself_ = false;
  Reply reply = episode_ ? end(now) : success("No episode was open.");
  archive_.wait();
  return reply;
}

void Recorder::Implementation::setTeleopMap(const TeleopMapMetadata& map) {
  configuration_.metadata.teleop_map = map;
  said_.teleop_map = map;
  if (episode_ && !episode_->metadata.teleop_map) {
    episode_->metadata.teleop_map = map;
  }
}

RecorderStatus Recorder::Implementation::status() const {
  RecorderStatus status;
  status.state = episode_              ? RecorderState::recording
                 : archive_.isSaving() ? RecorderState::saving
                                       : RecorderState::idle;
  status.minutes_left = std::numeric_limits<double>::infinity();
  status.faults = faults_.all();
  add(archive_.faults(), status.faults);
  add(synchroniser_.faults(), status.faults);
  if (episode_) {
    status.id = episode_->id();
    status.file = episode_->file();
    add(episode_->faults(), status.faults);
    if (const EpisodeWriter* writer = episode_->writer(); writer != nullptr) {
      add(writer->faults(), status.faults);
      status.rows = writer->rows();
      status.duration = writer->duration();
      if (writer->bytesFree() && writer->bytes() > 0 && status.duration > 0.0) {
        const double bytes_per_minute = static_cast<double>(writer->bytes()) / status.duration * 60.0;
        status.minutes_left = static_cast<double>(*writer->bytesFree()) / bytes_per_minute;
      }
    }
  } else {
    const ClosedEpisode& last = archive_.last();
    status.id = last.id;
    status.file = last.file;
    status.rows = last.rows;
    status.duration = last.duration;
  }
  if (status.rows > 1 && status.duration > 0.0) {
    status.rate = static_cast<double>(status.rows - 1) / status.duration;
  }
  return status;
}

// ---- the door

Recorder::Recorder(RecorderConfiguration configuration, std::vector<std::unique_ptr<DerivedColumns>> derived)
    : implementation_(std::make_unique<Implementation>(std::move(configuration), std::move(derived))) {}

Recorder::~Recorder() = default;

void Recorder::push(JointStateSample sample) { implementation_->push(std::move(sample)); }
void Recorder::push(std::size_t stream, StreamSample sample) { implementation_->push(stream, std::move(sample)); }
void Recorder::advance(Nanoseconds watermark) { implementation_->advance(watermark); }

Reply Recorder::start(Nanoseconds now, const std::string& channel, const std::string& task,
                      const std::string& operator_name, const std::string& notes) {
  return implementation_->start(now, channel, task, operator_name, notes);
}
Reply Recorder::stop(Nanoseconds now, const std::string& outcome, const std::string& notes) {
  return implementation_->stop(now, outcome, notes);
}
Reply Recorder::discard(Nanoseconds now) { return implementation_->discard(now); }
Reply Recorder::label(const std::string& id, const std::string& outcome, const std::string& task,
                      const std::string& operator_name, const std::string& notes) {
  return implementation_->label(id, {outcome, task, operator_name, notes});
}
Reply Recorder::close(Nanoseconds now) { return implementation_->close(now); }
void Recorder::setTeleopMap(const TeleopMapMetadata& map) { implementation_->setTeleopMap(map); }
void Recorder::countLost(const std::string& counter, std::uint64_t total) {
  implementation_->countLost(counter, total);
}
RecorderStatus Recorder::status() const { return implementation_->status(); }
const Synchroniser& Recorder::synchroniser() const { return implementation_->synchroniser(); }
const std::vector<std::filesystem::path>& Recorder::finished() const { return implementation_->finished(); }
const std::vector<Recovered>& Recorder::recovered() const { return implementation_->recovered(); }

}  // namespace demo_logger
