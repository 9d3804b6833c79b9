#include "snapshot.h"

#include <algorithm>
#include <cmath>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr Nanoseconds kLatest = 4'000'000'000'000'000'000;  // in the year 2096; sums of two do not overflow
constexpr double kLargest = 1e9;                            // in whatever unit

/// A value of a file, for a message.
std::string shown(const nlohmann::ordered_json& value) {
  constexpr std::size_t kMost = 40;
  std::string text = value.dump();
  if (text.size() > kMost) text = text.substr(0, kMost) + "...";
  return text;
}

}  // namespace

const nlohmann::ordered_json& Snapshot::at(const std::string& key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) refuse(key, "is missing");
  return *found;
}

void Snapshot::refuse(const std::string& key, const std::string& why) {
  throw ConfigurationError("state of a simulated arm: \"" + key + "\" " + why +
                           ". Was it saved by this version, with this configuration?");
}

std::uint64_t Snapshot::readCount(const std::string& key, std::uint64_t most) const {
  const nlohmann::ordered_json& found = at(key);
  const bool negative = found.is_number_integer() && !found.is_number_unsigned() && found.get<std::int64_t>() < 0;
  if (found.is_number_integer() && !negative && found.get<std::uint64_t>() <= most) return found.get<std::uint64_t>();
  refuse(key, "is " + shown(found) + ", expected a whole number from 0 to " + std::to_string(most));
}

Nanoseconds Snapshot::readNanoseconds(const std::string& key, Nanoseconds least) const {
  const nlohmann::ordered_json& found = at(key);
  const bool too_large = found.is_number_unsigned() && found.get<std::uint64_t>() > std::uint64_t{kLatest};
  if (found.is_number_integer() && !too_large) {
    const auto nanoseconds = found.get<Nanoseconds>();
    if (nanoseconds >= least && nanoseconds <= kLatest) return nanoseconds;
  }
  refuse(key, "is " + shown(found) + ", expected a whole number from " + std::to_string(least) + " to " +
                  std::to_string(kLatest) + " ns");
}

void Snapshot::values(const std::string& key, Eigen::VectorXd& vector, const std::vector<Eigen::Index>& sizes) {
  std::vector<double> numbers(vector.begin(), vector.end());
  value(key, numbers);
  if (!reading_) return;
  const auto size = static_cast<Eigen::Index>(numbers.size());
  if (std::find(sizes.begin(), sizes.end(), size) == sizes.end()) {
    refuse(key, "has " + std::to_string(size) + " numbers, expected " + std::to_string(sizes.front()));
  }
  for (const double number : numbers) {
    if (std::abs(number) <= kLargest) continue;
    refuse(key, "holds " + print(number) + ", expected at most " + print(kLargest) + " either way, as arms do");
  }
  vector = Eigen::Map<const Eigen::VectorXd>(numbers.data(), size);
}

void Snapshot::duration(const std::string& key, Nanoseconds& duration) {
  if (reading_) {
    duration = readNanoseconds(key, -kLatest);
  } else {
    json_[key] = duration;
  }
}

void Snapshot::stamp(const std::string& key, Nanoseconds& stamp) {
  if (reading_) {
    stamp = readNanoseconds(key, 0);
    if (stamp != 0) stamp += shift_;
  } else {
    json_[key] = stamp;
  }
}

void Snapshot::command(const std::string& key, ArmCommand& command) {
  part(key, [&](Snapshot& inside) {
    std::string mode = toString(command.mode);
    inside.value("mode", mode);
    command.mode = toControlMode(mode);
    inside.value("names", command.names);
    const bool twist = command.mode == ControlMode::cartesian_velocity;
    const bool path = command.mode == ControlMode::trajectory;
    inside.values("values", command.values, {twist ? 6 : path ? 0 : joints_});
    inside.valueOrNone("rates", command.rates);
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
    inside.count("size", size, kMost);
    path.resize(size);
    for (std::size_t i = 0; i < size; ++i) {
      inside.part(std::to_string(i), [&](Snapshot& point) {
        point.value("time", path[i].time);
        point.value("q", path[i].q);
        point.valueOrNone("dq", path[i].dq);
        point.valueOrNone("ddq", path[i].ddq);
      });
    }
  });
}

}  // namespace demo_logger
