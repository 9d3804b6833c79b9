#pragma once

#include <XmlRpcValue.h>
#include <ros/node_handle.h>

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

/// What a number may be, ends included. `unit` only makes the message readable.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::string unit;
};

/// A namespace of parameters, read once at the door of a node. Every reader takes the default for an absent name and
/// throws ConfigurationError for a wrong type or a value outside its range, in one sentence with the full name:
///   /simulated_arm/publish_rate is 0 Hz, expected a number from 1 to 1000 Hz.
/// A whole number is also a number; nothing else is converted. After the last read, rejectUnknown() names what is left.
class Parameters {
 public:
  /// `name` is the full name of the namespace ("/recorder"), `values` a struct, or nothing at all.
  Parameters(std::string name, const XmlRpc::XmlRpcValue& values);

  bool has(const std::string& key) const;
  std::string fullName(const std::string& key) const;

  bool flag(const std::string& key, bool fallback);
  int integer(const std::string& key, int fallback, const Range& range = {});
  double number(const std::string& key, double fallback, const Range& range = {});
  std::string text(const std::string& key, const std::string& fallback);
  /// One of `choices`, as `fallback` is.
  std::string choice(const std::string& key, const std::string& fallback, const std::vector<std::string>& choices);
  std::vector<double> numbers(const std::string& key, const std::vector<double>& fallback, const Range& range = {});
  std::vector<int> integers(const std::string& key, const std::vector<int>& fallback, const Range& range = {});
  std::vector<std::string> texts(const std::string& key, const std::vector<std::string>& fallback);
  /// Rows of equal length.
  std::vector<std::vector<double>> matrix(const std::string& key, const std::vector<std::vector<double>>& fallback);

  /// A struct below this one; without it, an empty one, so that its defaults apply.
  Parameters group(const std::string& key);
  /// A list of structs, each to be read and closed with rejectUnknown() like this one. Empty without it.
  std::vector<Parameters> groups(const std::string& key);

  /// As given, for a parameter whose type varies; nothing without it.
  std::optional<XmlRpc::XmlRpcValue> raw(const std::string& key);

  /// Every name given so far to a reader is known. Throws ConfigurationError naming the first other one and those that
  /// would have been understood.
  void rejectUnknown() const;

 private:
  std::string name_;
  XmlRpc::XmlRpcValue values_;
  std::set<std::string> known_;
};

/// What the user wrote, for messages: "a list of 2", "the text \"yes\"", 0.5.
std::string describeGiven(const XmlRpc::XmlRpcValue& given);

/// The parameters below `node`'s namespace, for ros::NodeHandle("~") the private ones.
Parameters readParameters(const ros::NodeHandle& node);

/// The URDF on the parameter server, found as ROS nodes do: `robot_description` here or in a namespace above. Throws
/// ConfigurationError if there is none or it is not a text.
std::string readRobotDescription(const ros::NodeHandle& node);

}  // namespace demo_logger
