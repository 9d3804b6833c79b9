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
/// Reading throws ConfigurationError naming the field that is missing or of another type. Stamps that are read are
/// moved by `shift`, to a clock that shows another time.
class Snapshot {
 public:
  Snapshot() : json_(nlohmann::ordered_json::object()) {}
  Snapshot(nlohmann::ordered_json json, Nanoseconds shift) : reading_(true), shift_(shift), json_(std::move(json)) {}

  bool reading() const { return reading_; }
  const nlohmann::ordered_json& json() const { return json_; }

  /// Numbers, texts and flags.
  template <typename Value>
  void value(const std::string& key, Value& value) {
    if (reading_) {
      value = get<Value>(key);
    } else {
      json_[key] = value;
    }
  }
  void value(const std::string& key, Eigen::VectorXd& vector);
  /// A point in time, which is moved; 0 means none and stays.
  void stamp(const std::string& key, Nanoseconds& stamp);
  void command(const std::string& key, ArmCommand& command);
  void path(const std::string& key, std::vector<PathPoint>& path);

  /// An object inside: `exchange` is called with a Snapshot of its own.
  template <typename Exchange>
  void part(const std::string& key, Exchange exchange) {
    Snapshot inside = reading_ ? Snapshot(at(key), shift_) : Snapshot();
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

 private:
  const nlohmann::ordered_json& at(const std::string& key) const;
  [[noreturn]] static void refuse(const std::string& key, const std::string& why);

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
  nlohmann::ordered_json json_;
};

}  // namespace demo_logger
