#include "src/nodes/recording_diagnostics.h"

#include <cmath>
#include <set>

#include "demo_logger/trajectory/print.h"
#include "src/ros/message_conversion.h"

namespace demo_logger {
namespace {

using diagnostic_msgs::DiagnosticStatus;

constexpr double kLongestSilence = 2.0;        // [s] of the joint states
constexpr double kDistantClock = 1.0;          // [s]
constexpr double kFewMinutesLeft = 10.0;       // [min] on the disk
constexpr double kNormalOffsetLower = -0.020;  // [s] receipt - stamp, beyond which the clocks or the transport are
constexpr double kNormalOffsetUpper = 0.100;   // worth a word

/// Counters that mean that something is missing from the recording.
const std::set<std::string>& losingCounters() {
  static const std::set<std::string> names = {
      "late_rows",         "duplicate_rows", "malformed_joint_states", "zero_stamps", "malformed_stream_messages",
      "non_finite_values", "overflow",       "non_unit_quaternions",   "gaps",        "unbridged_gaps",
      "clock_outliers"};
  return names;
}

const char* nameOf(RecorderState state) {
  switch (state) {
    case RecorderState::idle:
      return "idle";
    case RecorderState::recording:
      return "recording";
    case RecorderState::saving:
      return "saving";
  }
  return "";
}

}  // namespace

RecordingDiagnostics::RecordingDiagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                           const LiveRecorder& recorder, bool correct_clock_offset)
    : recorder_(recorder),
      correct_clock_offset_(correct_clock_offset),
      begin_(ros::SteadyTime::now()),
      heard_(begin_),
      reported_(begin_),
      updater_(node, private_node) {
  updater_.setHardwareID("none");
  updater_.add("joint states", this, &RecordingDiagnostics::reportJointStates);
  updater_.add("recording", [this](Report& report) { reportRecording(report); });
  updater_.add("clock", [this](Report& report) { reportClock(report); });
  updater_.add("losses", [this](Report& report) { reportLosses(report); });
  const std::vector<TopicStatus> topics = recorder_.topics();
  for (std::size_t source = 1; source < topics.size(); ++source) {
    updater_.add("stream " + topics[source].name, [this, source](Report& report) { reportStream(source, report); });
  }
}

void RecordingDiagnostics::publish() { updater_.force_update(); }

void RecordingDiagnostics::reportJointStates(Report& report) {
  const TopicStatus topic = recorder_.topics().front();
  const ros::SteadyTime now = ros::SteadyTime::now();
  joint_states_before_ = joint_states_;
  joint_states_ = topic.received;
  if (joint_states_ != joint_states_before_) {
    heard_ = now;
  }
  const double period = (now - reported_).toSec();
  reported_ = now;
  const double rate = period > 0.0 ? static_cast<double>(joint_states_ - joint_states_before_) / period : 0.0;
  report.add("topic", topic.topic);
  report.add("received", topic.received);
  report.add("rate [Hz]", rate);

  const std::string problem = recorder_.problem();
  const double silence = (now - heard_).toSec();
  if (!problem.empty()) {
    report.summary(DiagnosticStatus::ERROR, problem);
  } else if (silence > kLongestSilence) {
    const std::string since = topic.last ? "ROS time " + print(toSeconds(*topic.last), 1) : "the node began";
    report.summary(DiagnosticStatus::ERROR,
                   "no JointState on " + topic.topic + " since " + since + ", " + print(silence, 1) + " s ago");
  } else if (joint_states_ == 0) {
    report.summary(DiagnosticStatus::WARN, "waiting for the first JointState on " + topic.topic);
  } else {
    report.summary(DiagnosticStatus::OK, print(rate, 1) + " Hz on " + topic.topic);
  }
}

void RecordingDiagnostics::reportRecording(Report& report) const {
  const RecorderStatus status = recorder_.status();
  report.add("state", nameOf(status.state));
  report.add("id", status.id);
  report.add("file", status.file.string());
  report.add("rows", status.rows);
  report.add("minutes left", status.minutes_left);
  for (const Fault& fault : status.faults) {
    report.add("fault", fault.what + " (" + std::to_string(fault.count) + ")");
  }
  report.summary(DiagnosticStatus::OK, std::string(nameOf(status.state)) + " " + status.id);
  for (const Fault& fault : status.faults) {
    const bool error = fault.severity == Severity::error;
    report.mergeSummary(error ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN, fault.what);
  }
  if (status.state == RecorderState::recording && status.minutes_left < kFewMinutesLeft) {
    report.mergeSummary(DiagnosticStatus::WARN, print(status.minutes_left, 1) + " minutes until the disk is full");
  }
}

void RecordingDiagnostics::reportClock(Report& report) const {
  const std::optional<double> offset = recorder_.clockOffset();
  if (!offset) {
    report.summary(DiagnosticStatus::OK, "not known yet: needs a second of joint states");
    return;
  }
  report.add("receipt minus stamp [s]", *offset);
  bool unstamped = false;
  for (const StreamMetadata& stream : recorder_.streams()) {
    unstamped = unstamped || !stream.stamped;
  }
  const std::string sentence =
      "joint-state stamps are " + print(1000.0 * *offset, 1) + " ms from this clock (transport or skew)";
  if (std::abs(*offset) > kDistantClock && unstamped && !correct_clock_offset_) {
    report.summary(DiagnosticStatus::ERROR,
                   sentence +
                       "; streams without stamps cannot be placed: synchronise the clocks, or set "
                       "correct_clock_offset");
  } else if (*offset < kNormalOffsetLower || *offset > kNormalOffsetUpper) {
    report.summary(DiagnosticStatus::WARN, sentence);
  } else {
    report.summary(DiagnosticStatus::OK, sentence);
  }
}

void RecordingDiagnostics::reportLosses(Report& report) const {
  std::string found;
  for (const auto& [name, count] : recorder_.counters()) {
    report.add(name, count);
    if (count > 0 && losingCounters().count(name) != 0) {
      found += (found.empty() ? "" : ", ") + std::to_string(count) + " " + name;
    }
  }
  for (const TopicStatus& topic : recorder_.topics()) {
    if (topic.lost > 0) {
      found += (found.empty() ? "" : ", ") + std::to_string(topic.lost) + " lost on " + topic.topic;
    }
  }
  report.summary(found.empty() ? DiagnosticStatus::OK : DiagnosticStatus::WARN, found.empty() ? "none" : found);
}

void RecordingDiagnostics::reportStream(std::size_t source, Report& report) const {
  const TopicStatus topic = recorder_.topics()[source];
  report.add("topic", topic.topic);
  report.add("type", topic.type);
  report.add("received", topic.received);
  if (topic.unreadable > 0) {
    report.add("unreadable", topic.unreadable);
    report.summary(DiagnosticStatus::ERROR, topic.topic + ": " + topic.problem);
  } else if (!topic.last) {
    report.summary(DiagnosticStatus::OK, "nothing on " + topic.topic + " yet");
  } else {
    const double age = toSeconds(toNanoseconds(ros::Time::now()) - *topic.last);
    report.summary(DiagnosticStatus::OK, topic.topic + ": last message " + print(age, 1) + " s ago");
  }
}

}  // namespace demo_logger
