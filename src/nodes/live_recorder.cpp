#include "src/nodes/live_recorder.h"

#include <ros/transport_hints.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "src/ros/message_conversion.h"
#include "src/ros/stream_converter.h"

namespace demo_logger {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::uint32_t kSubscriberQueue = 20000;  // messages; a stop of 2 s at 8 kHz with room to spare
constexpr std::chrono::milliseconds kReceivingPace{10};
constexpr std::chrono::milliseconds kRecordingPace{20};
// A message gets its receipt stamp in the network thread shortly before it stands in the callback queue.
constexpr Nanoseconds kReceiptMargin = 5'000'000;
constexpr std::chrono::seconds kLongestWaitForJointState{2};
constexpr std::chrono::milliseconds kLongestWaitForReceipt{200};
constexpr Nanoseconds kLongestQueueing = 10 * kNanosecondsPerSecond;

Nanoseconds steadyNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(SteadyClock::now().time_since_epoch()).count();
}

/// When on the steady clock a message with this receipt (ROS time) was received, seen from now.
Nanoseconds steadyReceipt(const ros::Time& receipt) {
  const Nanoseconds queued = toNanoseconds(ros::Time::now()) - toNanoseconds(receipt);
  const bool clock_was_set = queued < 0 || queued > kLongestQueueing;
  return clock_was_set ? steadyNow() : steadyNow() - queued;
}

template <class Event>
Arrival arrivalOf(const Event& event) {
  Arrival arrival;
  arrival.receipt = toNanoseconds(event.getReceiptTime());
  arrival.publisher = event.getPublisherName();
  return arrival;
}

RawMessage rawOf(const topic_tools::ShapeShifter& message, std::vector<std::uint8_t>& bytes) {
  bytes.resize(message.size());
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(stream);
  return {message.getDataType(), message.getMD5Sum(), bytes.data(), static_cast<std::uint32_t>(bytes.size())};
}

}  // namespace

LiveRecorder::LiveRecorder(const ros::NodeHandle& node, const RecorderConfiguration& configuration,
                           std::vector<std::unique_ptr<DerivedColumns>> derived, JointStateListener listener)
    : node_(node),
      simulated_time_(ros::Time::isSimTime()),
      listener_(std::move(listener)),
      reception_(1 + configuration.synchroniser.streams.size()),
      recorder_(configuration, std::move(derived)) {
  node_.setCallbackQueue(&queue_);
  subscribe(configuration);
  receiving_ = std::thread([this] { receive(); });
  recording_ = std::thread([this] { record(); });
}

LiveRecorder::~LiveRecorder() {
  ending_ = true;
  receiving_.join();
  recording_.join();
}

void LiveRecorder::subscribe(const RecorderConfiguration& configuration) {
  const std::vector<StreamConfiguration>& streams = configuration.synchroniser.streams;
  topics_.resize(1 + streams.size());
  for (std::size_t source = 1; source < topics_.size(); ++source) {
    listen<topic_tools::ShapeShifter, Received::Stream>(source, streams[source - 1].name, streams[source - 1].topic);
  }
  // Last, so that a command that is already in force is not behind the first joint state.
  listen<sensor_msgs::JointState, Received::JointStates>(0, "joint_states", "joint_states");
}

template <class Message, class Event>
void LiveRecorder::listen(std::size_t source, const std::string& name, const std::string& topic) {
  topics_[source].name = name;
  topics_[source].topic = node_.resolveName(topic);
  const boost::function<void(const Event&)> keep = [this, source](const Event& event) {
    reception_.push({source, event, steadyReceipt(event.getReceiptTime())});
  };
  subscribers_.push_back(node_.subscribe<Message, const Event&>(
      topics_[source].topic, kSubscriberQueue, keep, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void LiveRecorder::receive() {
  while (!ending_) {
    const Nanoseconds before = toNanoseconds(ros::Time::now());
    queue_.callAvailable();
    if (before > kReceiptMargin) {
      watermark_ = before - kReceiptMargin;
    }
    std::this_thread::sleep_for(kReceivingPace);
  }
}

void LiveRecorder::record() {
  while (!ending_) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      recordPending();
    }
    recorded_.notify_all();
    std::this_thread::sleep_for(kRecordingPace);
  }
}

/// With the mutex held. Before ROS time has begun (simulated time without a clock yet), everything waits in the queue.
void LiveRecorder::recordPending() {
  const Nanoseconds watermark = watermark_;  // before the queue is emptied: it is a promise about the queue
  if (watermark == 0) {                      // or the receiving thread has yet to begin
    if (simulated_time_) {
      problem_ = "use_sim_time is set but /clock has not been heard yet: nothing can be placed in time";
    }
    return;
  }
  try {
    reception_.take(pending_);
    for (Received& received : pending_) {
      forward(received, watermark);
    }
    pending_.clear();
    countLosses();
    recorder_.advance(watermark);
    problem_.clear();
  } catch (const std::exception& error) {  // a file that cannot be created, say; what can be recorded later will be
    problem_ = error.what();
  }
}

void LiveRecorder::forward(Received& received, Nanoseconds watermark) {
  TopicStatus& topic = topics_[received.source];
  ++topic.received;
  const auto place = [&](Arrival arrival) {
    if (arrival.receipt == 0) {  // received before simulated time began
      arrival.receipt = watermark;
    }
    arrival.steady = received.steady;
    if (simulated_time_) {
      simulated_receipts_.place(arrival);
    }
    topic.last = arrival.receipt;
    return arrival;
  };
  try {
    if (auto* event = std::get_if<Received::JointStates>(&received.message)) {
      topic.type = "sensor_msgs/JointState";
      // The message is ours alone unless another subscriber of this process shares it; then the event gives a copy.
      JointStateSample sample = toJointStateSample(std::move(*event->getMessage()), place(arrivalOf(*event)));
      if (listener_) listener_(sample);
      recorder_.push(std::move(sample));
      return;
    }
    const auto& event = std::get<Received::Stream>(received.message);
    const RawMessage raw = rawOf(*event.getConstMessage(), bytes_);
    topic.type = raw.datatype;
    recorder_.push(received.source - 1, toStreamSample(raw, place(arrivalOf(event))));
  } catch (const Error& error) {
    ++topic.unreadable;
    topic.problem = error.what();
  }
}

void LiveRecorder::countLosses() {
  const std::vector<std::uint64_t> lost = reception_.lost();
  for (std::size_t source = 0; source < topics_.size(); ++source) {
    TopicStatus& topic = topics_[source];
    topic.lost = lost[source];
    if (topic.lost > 0) {
      recorder_.countLost("lost_" + topic.name, topic.lost);
    }
    if (topic.unreadable > 0) {
      recorder_.countLost("unreadable_" + topic.name, topic.unreadable);
    }
  }
}

/// Until all that was received by `now` is in the queue. Bounded by the wall clock: simulated time may stand still.
void LiveRecorder::waitUntilReceived(Nanoseconds now) const {
  const auto deadline = SteadyClock::now() + kLongestWaitForReceipt;
  while (watermark_ < now && SteadyClock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

Reply LiveRecorder::start(const std::string& channel, const std::string& task, const std::string& operator_name,
                          const std::string& notes) {
  const Nanoseconds now = toNanoseconds(ros::Time::now());
  std::unique_lock<std::mutex> lock(mutex_);
  if (now == 0) {
    Reply reply;
    reply.message = "use_sim_time is set but /clock has not been heard yet; is the simulation or rosbag play running?";
    return reply;
  }
  Reply reply = recorder_.start(now, channel, task, operator_name, notes);
  if (!reply.success) {
    return reply;
  }
  const bool arrived = recorded_.wait_for(lock, kLongestWaitForJointState, [&] {
    const auto last = recorder_.synchroniser().lastJointState();
    return last && *last > now && !recorder_.synchroniser().joints().empty();
  });
  if (arrived) {
    const std::string id = recorder_.status().id;
    reply.id = id.empty() ? reply.id : id;
    return reply;
  }
  recorder_.stop(toNanoseconds(ros::Time::now()), "", "");
  Reply refusal;
  refusal.message = "no JointState on " + topics_[0].topic + " within " +
                    std::to_string(kLongestWaitForJointState.count()) +
                    " s; is the robot's driver running, and is the topic remapped (joint_states:=…)?";
  return refusal;
}

Reply LiveRecorder::stop(const std::string& outcome, const std::string& notes) {
  const Nanoseconds now = toNanoseconds(ros::Time::now());
  waitUntilReceived(now);
  const std::lock_guard<std::mutex> lock(mutex_);
  recordPending();
  return recorder_.stop(now, outcome, notes);
}

Reply LiveRecorder::close() {
  const Nanoseconds now = toNanoseconds(ros::Time::now());
  waitUntilReceived(now);
  const std::lock_guard<std::mutex> lock(mutex_);
  recordPending();
  return recorder_.close(now);
}

Reply LiveRecorder::discard() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.discard(toNanoseconds(ros::Time::now()));
}

Reply LiveRecorder::label(const std::string& id, const std::string& outcome, const std::string& task,
                          const std::string& operator_name, const std::string& notes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.label(id, outcome, task, operator_name, notes);
}

void LiveRecorder::setTeleopMap(const TeleopMapMetadata& map) {
  const std::lock_guard<std::mutex> lock(mutex_);
  recorder_.setTeleopMap(map);
}

RecorderStatus LiveRecorder::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.status();
}

std::vector<TopicStatus> LiveRecorder::topics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return topics_;
}

std::vector<StreamMetadata> LiveRecorder::streams() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.synchroniser().streams();
}

std::map<std::string, std::uint64_t> LiveRecorder::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.synchroniser().counters();
}

std::optional<double> LiveRecorder::clockOffset() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.synchroniser().clockOffset();
}

std::vector<Recovered> LiveRecorder::recovered() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_.recovered();
}

std::string LiveRecorder::problem() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return problem_;
}

}  // namespace demo_logger
