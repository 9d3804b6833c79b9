#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/sample.h"

namespace demo_logger {

/// Where a message that carries these names has the arm's joints.
struct JointMapping {
  std::uint64_t id = 0;  // differs where the names differ
  std::vector<std::string> names;
  std::vector<std::optional<std::size_t>> places;  // of each of the arm's joints in the message
  std::size_t carried = 0;                         // how many of them it has
  std::vector<std::string> others;                 // names that are not the arm's
  bool distinct = true;                            // no name is given twice

  bool complete() const { return carried == places.size(); }
  bool hasFirst() const { return !places.empty() && places.front().has_value(); }
};

/// The arm's joints, and how to find them by name in messages of any order. Mappings are remembered by their names, so
/// that a steady publisher costs one comparison.
class JointLayout {
 public:
  /// `joints` empty: the first message that maps decides.
  explicit JointLayout(std::vector<std::string> joints);

  const std::vector<std::string>& joints() const { return joints_; }
  /// Takes the names of a first message as the arm's joints.
  void learn(const std::vector<std::string>& names);

  /// The reference lasts until the next call.
  const JointMapping& map(const std::vector<std::string>& names);

 private:
  static constexpr std::size_t kRemembered = 8;

  std::vector<std::string> joints_;
  std::vector<JointMapping> mappings_;
  std::uint64_t made_ = 0;
  std::size_t last_ = 0;    // the mapping used last
  std::size_t oldest_ = 0;  // the one to forget next
};

/// Why a joint state cannot be used: arrays that disagree in length, a name beyond kLongestName. Nothing if it can.
std::optional<std::string> whatIsWrong(const JointStateSample& sample);
constexpr std::size_t kLongestName = 255;

/// How many joints a message has: its names, or the longest array where it has none.
std::size_t jointsOf(const JointStateSample& sample);

/// joint0, joint1, …
std::vector<std::string> numberedJoints(std::size_t count);

/// "a, b, c" for a sentence; of a long list the beginning.
std::string listOf(const std::vector<std::string>& names);

}  // namespace demo_logger
