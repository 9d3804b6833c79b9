#pragma once

#include <yaml-cpp/yaml.h>

#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

namespace demo_logger {

/// One mapping of a YAML file that knows where it stands: what is wrong in it is refused by FileError with the file,
/// the line, the full key, its value and what was expected.
class StrictYaml {
 public:
  /// The mapping at the top of the file. Throws FileError if it cannot be read, or is none.
  static StrictYaml read(const std::string& path);

  /// Refuses keys that are not among those.
  void allow(const std::vector<std::string>& keys) const;
  const std::vector<std::string>& keys() const { return keys_; }  // as they stand in the file

  bool has(const std::string& key) const;
  StrictYaml mapping(const std::string& key) const;
  std::string word(const std::string& key, const std::vector<std::string>& allowed) const;
  std::string text(const std::string& key) const;

  struct Range {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    std::string expected = "a finite number";
  };
  double number(const std::string& key, const Range& range) const;
  std::vector<double> numbers(const std::string& key, std::size_t count, const Range& range) const;

 private:
  /// Refuses keys that are repeated, or no words.
  StrictYaml(std::string file, std::string prefix, const YAML::Node& node);
  /// Refuses a key that is not there.
  YAML::Node required(const std::string& key) const;
  [[noreturn]] void refuse(const YAML::Node& node, const std::string& key, const std::string& expected) const;
  double toNumber(const YAML::Node& node, const std::string& key, const Range& range) const;

  std::string file_;
  std::string prefix_;  // "joints.elbow." of the full key
  int line_ = 0;
  std::vector<std::string> keys_;
  std::unordered_map<std::string, YAML::Node> values_;  // found at once, where YAML::Node looks at all keys
};

}  // namespace demo_logger
