#pragma once

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/recording/stream_configuration.h"
#include "src/ros/bag_reader.h"

namespace demo_logger {

/// What to take from a bag.
struct ImportPlan {
  std::string joint_states;  // topic
  std::vector<StreamConfiguration> streams;
  std::vector<std::string> notes;  // what was chosen without being told, and what is left out
};

/// Joint states from `joint_states` if given, else from /joint_states, else from the only topic of that type. Streams
/// as given in `streams`; with none, the one Twist topic named teleop_cmd, or else cmd_vel, becomes `teleop_cmd`.
/// Throws FileError listing the topics that exist, where nothing can be imported or the choice is not clear.
ImportPlan planImport(const BagReader& bag, const std::optional<std::string>& joint_states,
                      const std::vector<StreamConfiguration>& streams);

}  // namespace demo_logger
