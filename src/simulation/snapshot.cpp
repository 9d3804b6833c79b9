#include "snapshot.h"

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

const nlohmann::ordered_json& Snapshot::at(const std::string& key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) refuse(key, "is missing");
  return *found;
}

void Snapshot::refuse(const std::string& key, const std::string& why) {
  throw ConfigurationError("state of a simulated arm: \"" + key + "\" " + why +
                           ". Was it saved by this version, with this configuration?");
}

void Snapshot::value(const std::string& key, Eigen::VectorXd& vector) {
  std::vector<double> numbers(vector.begin(), vector.end());
  value(key, numbers);
  if (reading_) vector = Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

void Snapshot::stamp(const std::string& key, Nanoseconds& stamp) {
  value(key, stamp);
  if (reading_ && stamp != 0) stamp += shift_;
}

void Snapshot::command(const std::string& key, ArmCommand& command) {
  part(key, [&](Snapshot& inside) {
    std::string mode = toString(command.mode);
    inside.value("mode", mode);
    command.mode = toControlMode(mode);
    inside.value("names", command.names);
    inside.value("values", command.values);
    inside.value("rates", command.rates);
    inside.path("path", command.path);
    inside.value("frame", command.frame);
    inside.stamp("stamp", command.stamp);
    inside.value("source", command.source);
  });
}

void Snapshot::path(const std::string& key, std::vector<PathPoint>& path) {
  std::size_t size = path.size();
  part(key, [&](Snapshot& inside) {
    constexpr std::size_t kMost = 20000;
    inside.value("size", size);
    if (size > kMost) refuse("size", "of a path is more than any path has");
    path.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      inside.part(std::to_string(i), [&](Snapshot& point) {
        point.value("time", path[i].time);
        point.value("q", path[i].q);
        point.value("dq", path[i].dq);
        point.value("ddq", path[i].ddq);
      });
    }
  });
}

}  // namespace demo_logger
