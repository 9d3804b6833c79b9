#include "src/tool/bag_import.h"

#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/pipelines/recorded_robot.h"
#include "demo_logger/pipelines/tool_pose.h"
#include "demo_logger/trajectory/error.h"
#include "src/ros/version.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kAdvanceEvery = 20'000'000;  // of the bag's time, the pace of the live recorder
constexpr std::uint64_t kProgressEvery = 1000;     // messages

RecorderConfiguration makeConfiguration(const BagReader& bag, const ImportPlan& plan, const ImportOptions& options) {
  RecorderConfiguration configuration;
  configuration.output_directory = options.output;
  configuration.autostart = true;
  configuration.split_gap = options.split_gap;
  configuration.writer.may_wait = true;
  configuration.joint_states_topic = plan.joint_states;
  configuration.synchroniser.streams = plan.streams;
  configuration.synchroniser.max_wait = options.max_wait;
  Metadata& metadata = configuration.metadata;
  metadata.channel = options.channel;
  metadata.software = kSoftware;
  metadata.provenance.parent = bag.path().filename().string();
  metadata.provenance.steps = {kImportStep + stepOf(options.effort)};
  metadata.effort = corrected(metadata.effort, options.effort);
  metadata.parameters = {{"joint_states", plan.joint_states},
                         {"max_wait", options.max_wait},
                         {"max_gap", configuration.synchroniser.max_gap},
                         {"split_gap", options.split_gap}};
  if (options.robot) {
    recordRobot(*options.robot, configuration);
  }
  return configuration;
}

std::vector<std::unique_ptr<DerivedColumns>> makeDerivedColumns(const ImportOptions& options) {
  std::vector<std::unique_ptr<DerivedColumns>> derived;
  if (options.robot) {
    derived.push_back(std::make_unique<ToolPose>(*options.robot));
  }
  return derived;
}

/// The bag's topics, and where their messages go.
class Feed {
 public:
  Feed(const ImportPlan& plan, Recorder& recorder) : joint_states_(plan.joint_states), recorder_(recorder) {
    for (std::size_t i = 0; i < plan.streams.size(); ++i) {
      streams_[plan.streams[i].topic].push_back(i);
      names_.push_back(plan.streams[i].name);
    }
  }

  std::set<std::string> topics() const {
    std::set<std::string> topics{joint_states_};
    for (const auto& [topic, streams] : streams_) {
      topics.insert(topic);
    }
    return topics;
  }

  void push(const BagMessage& message) {
    last_ = message.arrival.receipt;
    if (last_ > advanced_ + kAdvanceEvery) {
      recorder_.advance(last_ - 1);  // more of this instant may follow
      advanced_ = last_;
    }
    const auto streams = streams_.find(message.topic);
    if (streams != streams_.end()) {
      for (const std::size_t stream : streams->second) {
        pushCounting(names_[stream], [&] { recorder_.push(stream, toStreamSample(message.raw, message.arrival)); });
      }
    }
    if (message.topic == joint_states_) {
      pushCounting("joint_states", [&] { recorder_.push(toJointStateSample(message.raw, message.arrival)); });
    }
  }

  Nanoseconds last() const { return last_; }

 private:
  template <class Push>
  void pushCounting(const std::string& name, Push push) {
    try {
      push();
    } catch (const FileError&) {  // the disk, not the message
      throw;
    } catch (const Error&) {
      const std::string counter = "unreadable_" + name;
      recorder_.countLost(counter, ++unreadable_[counter]);
    }
  }

  std::string joint_states_;
  Recorder& recorder_;
  std::map<std::string, std::vector<std::size_t>> streams_;
  std::vector<std::string> names_;
  std::map<std::string, std::uint64_t> unreadable_;
  Nanoseconds advanced_ = 0;
  Nanoseconds last_ = 0;
};

void play(const BagReader& bag, const ImportOptions& options, Feed& feed) {
  const std::set<std::string> topics = feed.topics();
  std::uint64_t all = 0;
  for (const BagTopic& topic : bag.topics()) {
    all += topics.count(topic.name) != 0 ? topic.count : 0;
  }
  std::uint64_t done = 0;
  bag.read(topics, [&](const BagMessage& message) {
    feed.push(message);
    if (++done % kProgressEvery == 0) {
      options.progress(done, all);
    }
  });
}

/// Whatever was written of a bag that cannot be read to its end.
void removeAll(Recorder& recorder, Nanoseconds now, const ImportOptions& options) {
  recorder.close(now);
  std::error_code ignored;
  for (const std::filesystem::path& file : recorder.finished()) {
    std::filesystem::remove(file, ignored);
    std::filesystem::remove(sidecarPath(file), ignored);
  }
  std::filesystem::remove(options.output, ignored);  // only if it is empty
}

}  // namespace

std::vector<std::filesystem::path> importBag(const BagReader& bag, const ImportPlan& plan,
                                             const ImportOptions& options) {
  Recorder recorder(makeConfiguration(bag, plan, options), makeDerivedColumns(options));
  Feed feed(plan, recorder);
  try {
    play(bag, options, feed);
    recorder.close(feed.last());
    if (recorder.finished().empty()) {
      throw FileError(bag.path().string() + ": none of the joint states on " + plan.joint_states +
                      " could make a row; `rostopic echo -b` shows what they hold");
    }
  } catch (...) {
    removeAll(recorder, feed.last(), options);
    throw;
  }
  return recorder.finished();
}

}  // namespace demo_logger
