#include "episode_archive.h"

#include <utility>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

const ClosedEpisode& EpisodeArchive::add(std::unique_ptr<EpisodeWriter> writer, const Metadata& metadata) {
  wait();
  note(closeEpisode(std::move(writer), metadata));
  return last_;
}

void EpisodeArchive::addLater(std::unique_ptr<EpisodeWriter> writer, Metadata metadata) {
  closer_.close(std::move(writer), std::move(metadata));
}

void EpisodeArchive::collect() {
  for (ClosedEpisode& closed : closer_.collect()) {
    note(std::move(closed));
  }
}

void EpisodeArchive::wait() {
  closer_.wait();
  collect();
}

ClosedEpisode EpisodeArchive::discardLast() {
  wait();
  if (finished_.empty()) {
    throw FileError("There is no episode to discard: this recorder has none.");
  }
  ClosedEpisode discarded;
  discarded.id = finished_.back().stem().string();
  discarded.file = discardEpisode(directory_, discarded.id);
  if (last_.id == discarded.id) {
    discarded.rows = last_.rows;
    last_.file = discarded.file;
  }
  finished_.pop_back();
  return discarded;
}

std::string EpisodeArchive::label(const std::string& id, const EpisodeLabel& label) {
  wait();
  if (id.empty() && finished_.empty()) {
    throw FileError("There is no episode to label: this recorder has none yet. Give the id of one in " +
                    directory_.string() + ".");
  }
  std::string labelled = id.empty() ? finished_.back().stem().string() : id;
  labelEpisode(directory_, labelled, label);
  return labelled;
}

void EpisodeArchive::note(ClosedEpisode closed) {
  last_ = std::move(closed);
  if (!last_.error.empty()) {
    faults_.push_back(Fault{last_.last_stamp, last_.error, 1, Severity::error});
  } else if (!last_.file.empty()) {
    finished_.push_back(last_.file);
  }
}

}  // namespace demo_logger
