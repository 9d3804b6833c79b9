#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "demo_logger/recording/recorder.h"
#include "src/nodes/reception_queue.h"
#include "src/nodes/simulated_receipts.h"

namespace demo_logger {

/// What is heard of one topic.
struct TopicStatus {
  std::string name;                 // of the stream, "joint_states" for the joint states
  std::string topic;                // resolved
  std::string type;                 // of the last message, empty before the first
  std::optional<Nanoseconds> last;  // receipt of the last message, ROS time
  std::uint64_t received = 0;
  std::uint64_t lost = 0;        // in front of the recorder, because it could not keep up
  std::uint64_t unreadable = 0;  // of a type or form that cannot be recorded
  std::string problem;           // why the last unreadable one was
};

/// A Recorder fed by live topics, with threads of its own:
///   receiving: runs the callbacks, which only put a pointer into the queue, and afterwards tells up to when (ROS time)
///              everything received is in the queue: the watermark;
///   recording: converts what is in the queue, feeds the recorder, moves it on to the watermark.
/// Both wake at a fixed pace, not for every message: a thousand messages a second cost a hundred wake-ups.
class LiveRecorder {
 public:
  using JointStateListener = std::function<void(const JointStateSample&)>;

  /// Subscribes to `joint_states` and the topics of the streams, relative to `node`. `listener`, if there is one, hears
  /// each joint state at once, in the recording thread, while an episode is open or not. Throws what Recorder throws.
  LiveRecorder(const ros::NodeHandle& node, const RecorderConfiguration& configuration,
               std::vector<std::unique_ptr<DerivedColumns>> derived, JointStateListener listener = {});
  ~LiveRecorder();
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  /// Answers when a joint state has arrived, or says after two seconds that none has.
  Reply start(const std::string& channel, const std::string& task, const std::string& operator_name,
              const std::string& notes);
  /// Everything received by now is in the file.
  Reply stop(const std::string& outcome, const std::string& notes);
  Reply discard();
  /// Saves the open episode as complete, if there is one; none begins any more.
  Reply close();
  Reply label(const std::string& id, const std::string& outcome, const std::string& task,
              const std::string& operator_name, const std::string& notes);
  void setTeleopMap(const TeleopMapMetadata& map);

  RecorderStatus status() const;
  /// The joint states first, then the streams.
  std::vector<TopicStatus> topics() const;
  std::vector<StreamMetadata> streams() const;
  std::map<std::string, std::uint64_t> counters() const;
  std::optional<double> clockOffset() const;
  /// What a killed recorder had left, finished at the beginning.
  std::vector<Recovered> recovered() const;
  /// Why nothing can be recorded at present, empty if all is well.
  std::string problem() const;

 private:
  void subscribe(const RecorderConfiguration& configuration);
  template <class Message, class Event>
  void listen(std::size_t source, const std::string& name, const std::string& topic);
  void receive();
  void record();
  void recordPending();
  void forward(Received& received, Nanoseconds watermark);
  void countLosses();
  void waitUntilReceived(Nanoseconds now) const;

  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  const bool simulated_time_;
  const JointStateListener listener_;
  ReceptionQueue reception_;
  std::atomic<Nanoseconds> watermark_{0};
  std::atomic<bool> ending_{false};

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable recorded_;
  Recorder recorder_;
  std::vector<TopicStatus> topics_;
  std::vector<Received> pending_;
  std::vector<std::uint8_t> bytes_;
  SimulatedReceipts simulated_receipts_;
  std::string problem_;

  std::vector<ros::Subscriber> subscribers_;
  std::thread receiving_;
  std::thread recording_;
};

}  // namespace demo_logger
