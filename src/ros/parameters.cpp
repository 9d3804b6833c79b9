#include "src/ros/parameters.h"

#include <cmath>
#include <utility>

#include "demo_logger/trajectory/print.h"

namespace demo_logger {

using XmlRpc::XmlRpcValue;

std::string describeGiven(const XmlRpcValue& given) {
  XmlRpcValue value = given;  // the accessors of XmlRpcValue are not const
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value) ? "the truth value true" : "the truth value false";
    case XmlRpcValue::TypeInt:
      return print(static_cast<int>(value));
    case XmlRpcValue::TypeDouble:
      return printExactly(static_cast<double>(value));
    case XmlRpcValue::TypeString:
      return "the text \"" + static_cast<std::string>(value) + "\"";
    case XmlRpcValue::TypeArray:
      return "a list of " + std::to_string(value.size());
    case XmlRpcValue::TypeStruct:
      return "a group of parameters";
    case XmlRpcValue::TypeDateTime:
      return "a date";
    case XmlRpcValue::TypeBase64:
      return "binary data";
    case XmlRpcValue::TypeInvalid:
      break;
  }
  return "empty";
}

namespace {

std::string withUnit(const std::string& text, const Range& range) {
  return range.unit.empty() ? text : text + " " + range.unit;
}

std::string expectation(const std::string& kind, const Range& range) {
  const bool below = std::isfinite(range.upper);
  const bool above = std::isfinite(range.lower);
  if (above && below)
    return withUnit(kind + " from " + printExactly(range.lower) + " to " + printExactly(range.upper), range);
  if (above) return withUnit(kind + " of at least " + printExactly(range.lower), range);
  if (below) return withUnit(kind + " of at most " + printExactly(range.upper), range);
  return range.unit.empty() ? kind : kind + " [" + range.unit + "]";
}

[[noreturn]] void refuse(const std::string& name, const std::string& found, const std::string& expected) {
  throw ConfigurationError(name + " is " + found + ", expected " + expected + ".");
}

double toNumber(const std::string& name, XmlRpcValue value, const Range& range) {
  double number = 0.0;
  if (value.getType() == XmlRpcValue::TypeInt) {
    number = static_cast<int>(value);
  } else if (value.getType() == XmlRpcValue::TypeDouble) {
    number = static_cast<double>(value);
  } else {
    refuse(name, describeGiven(value), expectation("a number", range));
  }
  if (!std::isfinite(number) || number < range.lower || number > range.upper) {
    refuse(name, withUnit(printExactly(number), range), expectation("a number", range));
  }
  return number;
}

int toInteger(const std::string& name, XmlRpcValue value, const Range& range) {
  if (value.getType() != XmlRpcValue::TypeInt) refuse(name, describeGiven(value), expectation("a whole number", range));
  const int number = static_cast<int>(value);
  if (number < range.lower || number > range.upper) {
    refuse(name, withUnit(std::to_string(number), range), expectation("a whole number", range));
  }
  return number;
}

std::string toText(const std::string& name, XmlRpcValue value) {
  if (value.getType() != XmlRpcValue::TypeString) refuse(name, describeGiven(value), "a text");
  return static_cast<std::string>(value);
}

std::string element(const std::string& name, int index) { return name + "[" + std::to_string(index) + "]"; }

template <typename Convert>
auto toList(const std::string& name, XmlRpcValue value, const std::string& expected, Convert convert) {
  if (value.getType() != XmlRpcValue::TypeArray) refuse(name, describeGiven(value), expected);
  std::vector<decltype(convert(name, value))> list;
  list.reserve(static_cast<std::size_t>(value.size()));
  for (int i = 0; i < value.size(); ++i) list.push_back(convert(element(name, i), value[i]));
  return list;
}

}  // namespace

Parameters::Parameters(std::string name, const XmlRpcValue& values) : name_(std::move(name)), values_(values) {
  const XmlRpcValue::Type type = values_.getType();
  if (type != XmlRpcValue::TypeStruct && type != XmlRpcValue::TypeInvalid) {
    refuse(name_, describeGiven(values_), "a group of parameters");
  }
}

bool Parameters::has(const std::string& key) const {
  return values_.getType() == XmlRpcValue::TypeStruct && values_.hasMember(key);
}

std::string Parameters::fullName(const std::string& key) const {
  return name_ == "/" ? name_ + key : name_ + "/" + key;
}

std::optional<XmlRpcValue> Parameters::raw(const std::string& key) {
  known_.insert(key);
  if (!has(key)) return std::nullopt;
  return values_[key];
}

bool Parameters::flag(const std::string& key, bool fallback) {
  std::optional<XmlRpcValue> value = raw(key);
  if (!value) return fallback;
  if (value->getType() != XmlRpcValue::TypeBoolean) refuse(fullName(key), describeGiven(*value), "true or false");
  return static_cast<bool>(*value);
}

int Parameters::integer(const std::string& key, int fallback, const Range& range) {
  const std::optional<XmlRpcValue> value = raw(key);
  return value ? toInteger(fullName(key), *value, range) : fallback;
}

double Parameters::number(const std::string& key, double fallback, const Range& range) {
  const std::optional<XmlRpcValue> value = raw(key);
  return value ? toNumber(fullName(key), *value, range) : fallback;
}

std::string Parameters::text(const std::string& key, const std::string& fallback) {
  const std::optional<XmlRpcValue> value = raw(key);
  return value ? toText(fullName(key), *value) : fallback;
}

std::string Parameters::choice(const std::string& key, const std::string& fallback,
                               const std::vector<std::string>& choices) {
  std::string value = text(key, fallback);
  std::string listed;
  for (const std::string& choice : choices) {
    if (choice == value) return value;
    listed += (listed.empty() ? "" : ", ") + choice;
  }
  refuse(fullName(key), "\"" + value + "\"", "one of " + listed);
}

std::vector<double> Parameters::numbers(const std::string& key, const std::vector<double>& fallback,
                                        const Range& range) {
  const std::optional<XmlRpcValue> value = raw(key);
  if (!value) return fallback;
  return toList(fullName(key), *value, "a list of numbers",
                [&](const std::string& name, const XmlRpcValue& item) { return toNumber(name, item, range); });
}

std::vector<int> Parameters::integers(const std::string& key, const std::vector<int>& fallback, const Range& range) {
  const std::optional<XmlRpcValue> value = raw(key);
  if (!value) return fallback;
  return toList(fullName(key), *value, "a list of whole numbers",
                [&](const std::string& name, const XmlRpcValue& item) { return toInteger(name, item, range); });
}

std::vector<std::string> Parameters::texts(const std::string& key, const std::vector<std::string>& fallback) {
  const std::optional<XmlRpcValue> value = raw(key);
  if (!value) return fallback;
  return toList(fullName(key), *value, "a list of texts",
                [](const std::string& name, const XmlRpcValue& item) { return toText(name, item); });
}

std::vector<std::vector<double>> Parameters::matrix(const std::string& key,
                                                    const std::vector<std::vector<double>>& fallback) {
  const std::optional<XmlRpcValue> value = raw(key);
  if (!value) return fallback;
  const std::string expected = "a list of rows, each a list of numbers";
  auto rows = toList(fullName(key), *value, expected, [&](const std::string& name, const XmlRpcValue& row) {
    return toList(name, row, "a row of numbers",
                  [](const std::string& cell, const XmlRpcValue& item) { return toNumber(cell, item, {}); });
  });
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].size() != rows[0].size()) {
      refuse(element(fullName(key), static_cast<int>(i)), "a row of " + std::to_string(rows[i].size()),
             std::to_string(rows[0].size()) + " as in the first row");
    }
  }
  return rows;
}

Parameters Parameters::group(const std::string& key) {
  const std::optional<XmlRpcValue> value = raw(key);
  return {fullName(key), value ? *value : XmlRpcValue()};
}

std::vector<Parameters> Parameters::groups(const std::string& key) {
  const std::optional<XmlRpcValue> value = raw(key);
  if (!value) return {};
  return toList(fullName(key), *value, "a list of groups of parameters",
                [](const std::string& name, const XmlRpcValue& item) { return Parameters(name, item); });
}

void Parameters::rejectUnknown() const {
  if (values_.getType() != XmlRpcValue::TypeStruct) return;
  XmlRpcValue values = values_;
  for (const auto& [key, value] : values) {
    if (known_.count(key) != 0) continue;
    std::string understood;
    for (const std::string& name : known_) understood += (understood.empty() ? "" : ", ") + name;
    throw ConfigurationError(fullName(key) + " is not a parameter that is understood here; known are " + understood +
                             ". Is it a slip of the pen, or left over from an earlier run (rosparam delete " +
                             fullName(key) + ")?");
  }
}

Parameters readParameters(const ros::NodeHandle& node) {
  XmlRpcValue values;
  node.getParam(node.getNamespace(), values);
  return {node.getNamespace(), values};
}

std::string readRobotDescription(const ros::NodeHandle& node) {
  std::string name;
  if (!node.searchParam("robot_description", name)) {
    throw ConfigurationError(node.resolveName("robot_description") +
                             " is not set, here or in a namespace above, expected the URDF of the arm as a text.");
  }
  XmlRpcValue value;
  node.getParam(name, value);
  return toText(name, value);
}

}  // namespace demo_logger
