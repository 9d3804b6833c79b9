#include "episode_closer.h"

#include <utility>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

namespace {

constexpr std::size_t kMostJobs = 8;

}  // namespace

ClosedEpisode closeEpisode(std::unique_ptr<EpisodeWriter> writer, const Metadata& metadata) {
  ClosedEpisode closed;
  closed.id = writer->id();
  closed.duration = writer->duration();
  closed.last_stamp = writer->lastStamp();
  try {
    closed.file = writer->finish(metadata);
    if (!closed.file.empty()) {
      closed.id = closed.file.stem().string();
    }
  } catch (const FileError& error) {
    closed.error = error.what();
  }
  closed.not_written = writer->rowsNotWritten();
  closed.rows = writer->rows() - closed.not_written;
  return closed;
}

EpisodeCloser::~EpisodeCloser() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void EpisodeCloser::close(std::unique_ptr<EpisodeWriter> writer, Metadata metadata) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return jobs_.size() < kMostJobs; });
    jobs_.push_back(Job{std::move(writer), std::move(metadata)});
  }
  changed_.notify_all();
}

bool EpisodeCloser::busy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !jobs_.empty();
}

void EpisodeCloser::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.empty(); });
}

std::vector<ClosedEpisode> EpisodeCloser::collect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(closed_, {});
}

void EpisodeCloser::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
    if (jobs_.empty()) {
      return;
    }
    Job& job = jobs_.front();  // a deque keeps it in its place while others are added behind it
    lock.unlock();
    ClosedEpisode closed = closeEpisode(std::move(job.writer), job.metadata);
    lock.lock();
    jobs_.pop_front();
    closed_.push_back(std::move(closed));
    changed_.notify_all();
  }
}

}  // namespace demo_logger
