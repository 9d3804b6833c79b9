#include "json_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace demo_logger {
namespace {

using Json = nlohmann::json;

constexpr int kDeepestNesting = 64;

constexpr double kLargestExactInteger = 9007199254740992.0;  // 2^53

bool isNumber(const Json& value) { return value.is_number() || value.is_null(); }

bool isNumberArray(const Json& value) { return value.is_array() && std::all_of(value.begin(), value.end(), isNumber); }

double toDouble(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::vector<double> toDoubles(const Json& value) {
  std::vector<double> numbers;
  for (const Json& item : value) {
    numbers.push_back(toDouble(item));
  }
  return numbers;
}

// Some programs write every number as a float: 3.0 counts as 3.
bool isWhole(const Json& value) {
  if (value.is_number_float()) {
    const double number = value.get<double>();
    return std::trunc(number) == number && std::abs(number) <= kLargestExactInteger;
  }
  return value.is_number_integer();
}

std::string shortened(const Json& value) {
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) {
    text = text.substr(0, 57) + "...";
  }
  return text;
}

}  // namespace

Json parseJson(std::string_view text, const std::string& file) {
  const auto refuse_depth = [&file](int depth, Json::parse_event_t /*event*/, Json& /*parsed*/) {
    if (depth > kDeepestNesting) {
      throw FileError(file + ": is nested more than " + std::to_string(kDeepestNesting) +
                      " levels deep; expected the sidecar of a demonstration.");
    }
    return true;
  };
  try {
    return Json::parse(text.begin(), text.end(), refuse_depth);
  } catch (const Json::parse_error& error) {
    const std::size_t position = std::min(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n');
    throw FileError(file + ":" + std::to_string(line) + ": is not valid JSON" +
                    (error.byte > text.size() ? " because it ends too early. Was the file cut?"
                                              : " at byte " + std::to_string(error.byte) +
                                                    ". Was it edited by hand? A JSON checker shows the place."));
  } catch (const Json::exception& error) {
    throw FileError(file + ": cannot be read as JSON (" + error.what() + ").");
  }
}

JsonFields::JsonFields(const Json& value, std::string file, std::string path)
    : value_(value), file_(std::move(file)), path_(std::move(path)) {
  if (!value_.is_object()) {
    throw FileError(file_ + ": " + (path_.empty() ? std::string("the content") : "key `" + path_ + "`") + " is " +
                    shortened(value_) + ", expected an object {…}.");
  }
}

const Json* JsonFields::find(const char* key) const {
  const auto found = value_.find(key);
  return found == value_.end() ? nullptr : &*found;
}

std::string JsonFields::nameOf(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

void JsonFields::refuse(const std::string& key, const Json& found, const std::string& expected) const {
  throw FileError(file_ + ": key `" + nameOf(key) + "` is " + shortened(found) + ", expected " + expected + ".");
}

void JsonFields::read(const char* key, bool& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!found->is_boolean()) {
    refuse(key, *found, "true or false");
  }
  target = found->get<bool>();
}

void JsonFields::read(const char* key, double& target) const {
  const Json* found = find(key);
  if (found == nullptr) {
    return;
  }
  if (!isNumber(*found)) {
    refuse(key, *found, "a number");
  }
  target = toDouble(*found);
}

void JsonFields::read(const char* key, std::int64_t& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!isWhole(*found) || (found->is_number_unsigned() &&
                           found->get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()})) {
    refuse(key, *found, "a whole number");
  }
  target = found->get<std::int64_t>();
}

void JsonFields::read(const char* key, std::uint64_t& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!isWhole(*found) || (!found->is_number_unsigned() && found->get<double>() < 0.0)) {
    refuse(key, *found, "a whole number, 0 or more");
  }
  target = found->get<std::uint64_t>();
}

void JsonFields::read(const char* key, std::string& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!found->is_string()) {
    refuse(key, *found, "text in quotes");
  }
  target = found->get<std::string>();
}

void JsonFields::read(const char* key, std::vector<std::string>& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!found->is_array() ||
      !std::all_of(found->begin(), found->end(), [](const Json& item) { return item.is_string(); })) {
    refuse(key, *found, "an array of texts in quotes");
  }
  target = found->get<std::vector<std::string>>();
}

void JsonFields::read(const char* key, std::vector<double>& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!isNumberArray(*found)) {
    refuse(key, *found, "an array of numbers");
  }
  target = toDoubles(*found);
}

void JsonFields::read(const char* key, std::vector<std::vector<double>>& target) const {
  const Json* found = find(key);
  if (found == nullptr || found->is_null()) {
    return;
  }
  if (!found->is_array() || !std::all_of(found->begin(), found->end(), isNumberArray)) {
    refuse(key, *found, "an array of rows of numbers");
  }
  target.clear();
  for (const Json& row : *found) {
    target.push_back(toDoubles(row));
  }
}

}  // namespace demo_logger
