#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/stamp.h"

namespace demo_logger {

/// Text to JSON. Throws FileError "file:line: …" where it is not JSON or nested beyond reason.
nlohmann::json parseJson(std::string_view text, const std::string& file);

/// One object of a JSON file, and where it stands. Each read() leaves its target alone where the key is absent or null,
/// and throws FileError with file, full key, what was found and what was expected where the type is wrong.
class JsonFields {
 public:
  /// Throws where `value` is no object.
  JsonFields(const nlohmann::json& value, std::string file, std::string path = "");

  void read(const char* key, bool& target) const;
  void read(const char* key, double& target) const;  // null is NaN
  void read(const char* key, std::int64_t& target) const;
  void read(const char* key, std::uint64_t& target) const;
  void read(const char* key, std::string& target) const;
  void read(const char* key, std::vector<std::string>& target) const;
  void read(const char* key, std::vector<double>& target) const;
  void read(const char* key, std::vector<std::vector<double>>& target) const;

  /// Null if the key is absent.
  const nlohmann::json* find(const char* key) const;
  /// The full key, as in `robot.joints`.
  std::string nameOf(const std::string& key) const;
  const nlohmann::json& value() const { return value_; }
  const std::string& file() const { return file_; }

  [[noreturn]] void refuse(const std::string& key, const nlohmann::json& found, const std::string& expected) const;

 private:
  const nlohmann::json& value_;
  std::string file_;
  std::string path_;
};

}  // namespace demo_logger
