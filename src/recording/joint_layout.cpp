#include "joint_layout.h"

#include <algorithm>
#include <set>
#include <utility>

#include "demo_logger/trajectory/quotation.h"

namespace demo_logger {
namespace {

constexpr std::size_t kListed = 10;

JointMapping makeMapping(std::uint64_t id, const std::vector<std::string>& names,
                         const std::vector<std::string>& joints) {
  JointMapping mapping;
  mapping.id = id;
  mapping.names = names;
  for (const std::string& joint : joints) {
    const auto place = std::find(names.begin(), names.end(), joint);
    if (place == names.end()) {
      mapping.places.emplace_back();
    } else {
      mapping.places.emplace_back(static_cast<std::size_t>(place - names.begin()));
      ++mapping.carried;
    }
  }
  const std::set<std::string> ours(joints.begin(), joints.end());
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (ours.count(name) == 0) mapping.others.push_back(name);
    mapping.distinct = seen.insert(name).second && mapping.distinct;
  }
  return mapping;
}

}  // namespace

JointLayout::JointLayout(std::vector<std::string> joints) : joints_(std::move(joints)) {}

void JointLayout::learn(const std::vector<std::string>& names) {
  joints_ = names;
  mappings_.clear();
}

const JointMapping& JointLayout::map(const std::vector<std::string>& names) {
  if (last_ < mappings_.size() && mappings_[last_].names == names) return mappings_[last_];
  const auto known = std::find_if(mappings_.begin(), mappings_.end(),
                                  [&names](const JointMapping& mapping) { return mapping.names == names; });
  if (known != mappings_.end()) {
    last_ = static_cast<std::size_t>(known - mappings_.begin());
  } else if (mappings_.size() < kRemembered) {
    last_ = mappings_.size();
    mappings_.push_back(makeMapping(++made_, names, joints_));
  } else {
    last_ = oldest_;
    oldest_ = (oldest_ + 1) % kRemembered;
    mappings_[last_] = makeMapping(++made_, names, joints_);
  }
  return mappings_[last_];
}

std::size_t jointsOf(const JointStateSample& sample) {
  if (!sample.names.empty()) return sample.names.size();
  return std::max({sample.position.size(), sample.velocity.size(), sample.effort.size()});
}

std::optional<std::string> whatIsWrong(const JointStateSample& sample) {
  const std::size_t joints = jointsOf(sample);
  const auto disagrees = [joints](const std::vector<double>& values) {
    return !values.empty() && values.size() != joints;
  };
  if (disagrees(sample.position) || disagrees(sample.velocity) || disagrees(sample.effort)) {
    return "it has " + std::to_string(sample.names.size()) + " names, " + std::to_string(sample.position.size()) +
           " positions, " + std::to_string(sample.velocity.size()) + " velocities and " +
           std::to_string(sample.effort.size()) + " efforts";
  }
  const bool too_long = std::any_of(sample.names.begin(), sample.names.end(),
                                    [](const std::string& name) { return name.size() > kLongestName; });
  if (too_long) return "it has a joint name beyond " + std::to_string(kLongestName) + " characters";
  return std::nullopt;
}

std::vector<std::string> numberedJoints(std::size_t count) {
  std::vector<std::string> names;
  names.reserve(count);
  for (std::size_t i = 0; i < count; ++i) names.push_back("joint" + std::to_string(i));
  return names;
}

std::string listOf(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kListed); ++i) list += (i == 0 ? "" : ", ") + shortened(names[i]);
  if (names.size() > kListed) list += " and " + std::to_string(names.size() - kListed) + " more";
  return list;
}

}  // namespace demo_logger
