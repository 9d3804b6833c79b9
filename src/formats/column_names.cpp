#include "demo_logger/formats/column_names.h"

#include <cstdint>
#include <cstdio>
#include <set>

namespace demo_logger {
namespace {

// Not std::isalpha, whose answer depends on the locale.
bool isLetter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isContinuationOfUtf8(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

// FNV-1a, 32 bit: short, and the same on every machine.
std::string hashOf(std::string_view text) {
  std::uint32_t hash = 2166136261U;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 16777619U;
  }
  char digits[9];
  std::snprintf(digits, sizeof(digits), "%08x", static_cast<unsigned>(hash));
  return digits;
}

std::string withPortableCharacters(std::string_view original) {
  std::string name;
  for (std::size_t i = 0; i < original.size(); ++i) {
    const char c = original[i];
    if (isLetter(c) || isDigit(c)) {
      name += c;
    } else if (i == 0 || !isContinuationOfUtf8(c)) {
      name += '_';
    }
  }
  if (name.empty() || isDigit(name.front())) {
    name.insert(name.begin(), '_');
  }
  if (name.size() > kLongestColumnName) {
    const std::string ending = "_" + hashOf(original);
    name.resize(kLongestColumnName - ending.size());
    name += ending;
  }
  return name;
}

std::string numberedUntilFree(const std::string& name, const std::set<std::string>& taken) {
  std::string candidate = name;
  for (int number = 2; taken.count(candidate) > 0; ++number) {
    const std::string ending = "_" + std::to_string(number);
    candidate = name.substr(0, kLongestColumnName - ending.size()) + ending;
  }
  return candidate;
}

}  // namespace

bool isPortable(std::string_view name) {
  if (name.empty() || name.size() > kLongestColumnName || isDigit(name.front())) {
    return false;
  }
  for (const char c : name) {
    if (!isLetter(c) && !isDigit(c)) {
      return false;
    }
  }
  return true;
}

PortableNames makePortable(const std::vector<std::string>& originals) {
  PortableNames result;
  result.names.resize(originals.size());
  std::set<std::string> taken = {"time"};
  for (std::size_t i = 0; i < originals.size(); ++i) {
    if (isPortable(originals[i]) && taken.insert(originals[i]).second) {
      result.names[i] = originals[i];
    }
  }
  for (std::size_t i = 0; i < originals.size(); ++i) {
    if (result.names[i].empty()) {
      result.names[i] = numberedUntilFree(withPortableCharacters(originals[i]), taken);
      taken.insert(result.names[i]);
      result.original_names[result.names[i]] = originals[i];
    }
  }
  return result;
}

}  // namespace demo_logger
