#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/simulation/arm_command.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// Everything that an object remembers, field by field, on its way into JSON or back. One function of the object,
/// exchange(Snapshot&), serves both ways, so that they cannot disagree. Numbers come back bit by bit.
/// Reading throws ConfigurationError naming the field that is missing, of another type or size, or beyond what the
/// arm could have saved: a file may have been edited, or cut. Stamps that are read are moved by `shift`, to a clock
/// that shows another time.
class Snapshot {
 public:
  /// Ticks, refusals and the like: what a double counts exactly.
  static constexpr std::uint64_t kMostCounted = std::uint64_t{1} << 53U;

  Snapshot() : json_(nlohmann::ordered_json::object()) {}
  /// Of an arm with so many joints.
  Snapshot(nlohmann::ordered_json json, Nanoseconds shift, Eigen::Index joints)
      : reading_(true), shift_(shift), joints_(joints), json_(std::move(json)) {}

  bool reading() const { return reading_; }
  const nlohmann::ordered_json& json() const { return json_; }

  /// Numbers, texts and flags, and lists of them. For whole numbers see count().
  template <typename Value>
  void value(const std::string& key, Value& value) {
    if (reading_) {
      value = get<Value>(key);
    } else {
      json_[key] = value;
    }
  }
  /// A whole number from 0 to `most`.
  template <typename Value>
  void count(const std::string& key, Value& value, std::uint64_t most) {
    if (reading_) {
      value = static_cast<Value>(readCount(key, most));
    } else {
      json_[key] = value;
    }
  }
  /// One number for each joint.
  void value(const std::string& key, Eigen::VectorXd& vector) { values(key, vector, {joints_}); }
  /// Or none at all.
  void valueOrNone(const std::string& key, Eigen::VectorXd& vector) { values(key, vector, {joints_, 0}); }
  /// As many as one of `sizes`.
  void values(const std::string& key, Eigen::VectorXd& vector, const std::vector<Eigen::Index>& sizes);
  /// A time between two stamps, which stays as it is.
  void duration(const std::string& key, Nanoseconds& duration);
  /// A point in time, which is moved; 0 means none and stays.
  void stamp(const std::string& key, Nanoseconds& stamp);
  void command(const std::string& key, ArmCommand& command);
  void path(const std::string& key, std::vector<PathPoint>& path);

  /// An object inside: `exchange` is called with a Snapshot of its own.
  template <typename Exchange>
  void part(const std::string& key, Exchange exchange) {
    Snapshot inside = reading_ ? Snapshot(at(key), shift_, joints_) : Snapshot();
    exchange(inside);
    if (!reading_) json_[key] = inside.json_;
  }
  /// One that may be absent. When reading, it is made anew.
  template <typename Value, typename Exchange>
  void optional(const std::string& key, std::optional<Value>& value, Exchange exchange) {
    bool present = value.has_value();
    if (reading_) present = !at(key).is_null();
    if (!present) {
      value.reset();
      if (!reading_) json_[key] = nullptr;
      return;
    }
    if (reading_) value = Value{};
    part(key, [&](Snapshot& inside) { exchange(inside, *value); });
  }

  /// `why` the value that was read for `key` cannot be one: "\"ticks\" is -1, expected …".
  [[noreturn]] static void refuse(const std::string& key, const std::string& why);
  Eigen::Index joints() const { return joints_; }

 private:
  const nlohmann::ordered_json& at(const std::string& key) const;
  std::uint64_t readCount(const std::string& key, std::uint64_t most) const;
  Nanoseconds readNanoseconds(const std::string& key, Nanoseconds least) const;

  template <typename Value>
  Value get(const std::string& key) const {
    try {
      return at(key).get<Value>();
    } catch (const nlohmann::json::exception&) {
      refuse(key, "is of another type than expected");
    }
  }

  bool reading_ = false;
  Nanoseconds shift_ = 0;
  Eigen::Index joints_ = 0;
  nlohmann::ordered_json json_;
};

}  // namespace demo_logger
