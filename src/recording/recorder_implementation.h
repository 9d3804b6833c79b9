#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/episode_label.h"
#include "demo_logger/recording/recorder.h"
#include "disk_faults.h"
#include "episode_archive.h"
#include "open_episode.h"

namespace demo_logger {

/// recorder.cpp: how episodes begin, get rows and end. recorder_requests.cpp: what people ask for and get told.
class Recorder::Implementation : public RowListener {
 public:
  Implementation(RecorderConfiguration configuration, std::vector<std::unique_ptr<DerivedColumns>> derived);
  ~Implementation() override;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void push(JointStateSample sample);
  void push(std::size_t stream, StreamSample sample) { synchroniser_.push(stream, std::move(sample)); }
  void advance(Nanoseconds watermark);

  void opened(const std::vector<Column>& columns, Nanoseconds first_stamp) override;
  void row(const Row& row) override;
  void clockJumped(Nanoseconds stamp, double seconds) override;

  Reply start(Nanoseconds now, const std::string& channel, const std::string& task, const std::string& operator_name,
              const std::string& notes);
  Reply stop(Nanoseconds now, const std::string& outcome, const std::string& notes);
  Reply discard(Nanoseconds now);
  Reply label(const std::string& id, const EpisodeLabel& label);
  Reply close(Nanoseconds now);
  void setTeleopMap(const TeleopMapMetadata& map);
  void countLost(const std::string& counter, std::uint64_t total) { lost_[counter] = total; }

  RecorderStatus status() const;
  const Synchroniser& synchroniser() const { return synchroniser_; }
  const std::vector<std::filesystem::path>& finished() const { return archive_.finished(); }
  const std::vector<Recovered>& recovered() const { return recovered_; }

 private:
  bool carriesArm(const JointStateSample& sample) const;
  bool isPause(Nanoseconds previous, Nanoseconds receipt) const;
  bool mayBeginByItself(Nanoseconds receipt) const;
  void requireRoom() const;

  void begin(Nanoseconds request, const Metadata& metadata);
  void beginByItself(Nanoseconds request);
  void finishRows(Nanoseconds request);
  void endByItself(const char* status);
  bool endOnRequest(Nanoseconds now);

  Reply end(Nanoseconds now);
  void labelOpen(const EpisodeLabel& label);
  std::string whyNoRow(const std::string& id) const;
  Metadata everything(const char* status) const;

  RecorderConfiguration configuration_;
  const std::vector<std::unique_ptr<DerivedColumns>> derived_;
  Synchroniser synchroniser_;
  EpisodeArchive archive_;
  DiskFaults faults_;  // of no episode
  std::vector<Recovered> recovered_;

  std::optional<OpenEpisode> episode_;
  Nanoseconds begun_ = 0;  // the request behind the open episode
  Nanoseconds saved_ = 0;  // when its metadata were, by the watermark
  std::map<std::string, std::uint64_t> lost_;
  std::map<std::string, std::uint64_t> lost_before_;  // the open episode

  bool starts_by_itself_;  // with the next joint state
  Metadata said_;          // at the last start: an episode that begins by itself belongs to the same work
  std::optional<Nanoseconds> last_receipt_;
  std::optional<Nanoseconds> failed_at_;  // to begin by itself
  bool ending_ = false;                   // on request, so that none begins by itself
  bool ended_with_rows_ = false;          // the last episode that ended by itself
};

}  // namespace demo_logger
