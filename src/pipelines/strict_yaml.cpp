#include "strict_yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/quotation.h"
#include "demo_logger/trajectory/regular_file.h"

namespace demo_logger {
namespace {

constexpr std::uintmax_t kLargestFile = 1000000;  // [B]

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (std::size_t i = 0; i < words.size(); ++i) {
    list += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  }
  return list;
}

/// A value as a sentence can show it.
std::string shown(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list of " + std::to_string(node.size());
  if (!node.IsScalar()) return "nothing";
  return inQuotes(node.Scalar());
}

}  // namespace

StrictYaml::StrictYaml(std::string file, std::string prefix, const YAML::Node& node)
    : file_(std::move(file)), prefix_(std::move(prefix)), line_(node.Mark().line + 1) {
  const auto refuseKey = [this](const YAML::Node& key, const std::string& why) {
    throw FileError(file_ + ":" + std::to_string(key.Mark().line + 1) + ": " + why);
  };
  for (const auto& entry : node) {
    const YAML::Node& key = entry.first;
    if (!key.IsScalar()) refuseKey(key, "a key is " + shown(key) + ", expected a word.");
    if (!values_.emplace(key.Scalar(), entry.second).second) {
      refuseKey(key, prefix_ + key.Scalar() + " is there twice, expected once.");
    }
    keys_.push_back(key.Scalar());
  }
}

StrictYaml StrictYaml::read(const std::string& path) {
  std::error_code status;
  if (!std::filesystem::exists(path, status)) throw FileError(path + ": no such file, expected a model (YAML)");
  requireRegularFile(path, "a model (YAML)");
  if (std::filesystem::file_size(path, status) > kLargestFile) {
    throw FileError(path + ": is larger than 1 MB, expected a model (YAML)");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) throw FileError(path + ": cannot be read, expected a model (YAML)");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1) {
      throw FileError(path + ":" + std::to_string(documents[1].Mark().line + 1) +
                      ": a second YAML document begins, expected one only");
    }
    const YAML::Node root = documents.empty() ? YAML::Node() : documents.front();
    if (!root.IsMap()) throw FileError(path + ": holds " + shown(root) + ", expected a mapping of keys to values");
    return {path, "", root};
  } catch (const YAML::Exception& error) {
    throw FileError(path + ":" + std::to_string(error.mark.line + 1) + ": is not YAML: " + error.msg);
  }
}

void StrictYaml::refuse(const YAML::Node& node, const std::string& key, const std::string& expected) const {
  throw FileError(file_ + ":" + std::to_string(node.Mark().line + 1) + ": " + prefix_ + key + " is " + shown(node) +
                  ", expected " + expected + ".");
}

void StrictYaml::allow(const std::vector<std::string>& keys_allowed) const {
  for (const std::string& key : keys_) {
    if (std::find(keys_allowed.begin(), keys_allowed.end(), key) != keys_allowed.end()) continue;
    throw FileError(file_ + ":" + std::to_string(values_.at(key).Mark().line + 1) + ": " + prefix_ + key +
                    " is not known here, expected " + listed(keys_allowed) + ".");
  }
}

bool StrictYaml::has(const std::string& key) const { return values_.count(key) > 0; }

YAML::Node StrictYaml::required(const std::string& key) const {
  if (const auto found = values_.find(key); found != values_.end()) return found->second;
  throw FileError(file_ + ":" + std::to_string(line_) + ": " + prefix_ + key + " is missing, expected it here.");
}

StrictYaml StrictYaml::mapping(const std::string& key) const {
  const YAML::Node node = required(key);
  if (!node.IsMap()) refuse(node, key, "a mapping of keys to values");
  return {file_, prefix_ + key + ".", node};
}

std::string StrictYaml::text(const std::string& key) const {
  const YAML::Node node = required(key);
  if (!node.IsScalar()) refuse(node, key, "a word");
  return node.Scalar();
}

std::string StrictYaml::word(const std::string& key, const std::vector<std::string>& allowed) const {
  std::string found = text(key);
  if (std::find(allowed.begin(), allowed.end(), found) == allowed.end()) refuse(required(key), key, listed(allowed));
  return found;
}

double StrictYaml::toNumber(const YAML::Node& node, const std::string& key, const Range& range) const {
  // Not by yaml-cpp, which reads numbers as the locale has them.
  const std::string text = node.IsScalar() ? node.Scalar() : std::string();
  double value = 0.0;
  const char* begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  const auto [end, fault] = std::from_chars(begin, text.data() + text.size(), value);
  const bool is_number = fault == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  if (!is_number || value < range.least || value > range.most) refuse(node, key, range.expected);
  return value;
}

double StrictYaml::number(const std::string& key, const Range& range) const {
  return toNumber(required(key), key, range);
}

std::vector<double> StrictYaml::numbers(const std::string& key, std::size_t count, const Range& range) const {
  const YAML::Node node = required(key);
  if (!node.IsSequence() || node.size() != count) {
    refuse(node, key, "a list of " + std::to_string(count) + " numbers");
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(toNumber(node[i], key + "[" + std::to_string(i) + "]", range));
  }
  return values;
}

}  // namespace demo_logger
