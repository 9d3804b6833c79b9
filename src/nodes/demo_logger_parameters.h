#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

#include "demo_logger/pipelines/human_torque_observer.h"
#include "demo_logger/recording/recorder.h"
#include "demo_logger/robot/robot_description.h"
#include "src/ros/parameters.h"

namespace demo_logger {

/// Which button of `joy` does what; -1: none does.
struct Buttons {
  int start = -1;
  int stop = -1;     // outcome unknown
  int success = -1;  // stops with this outcome, or labels the last episode with it
  int failure = -1;
  int discard = -1;

  bool any() const { return start >= 0 || stop >= 0 || success >= 0 || failure >= 0 || discard >= 0; }
};

/// Whose torque is observed as it happens: of one who guides this arm.
struct ObservedHuman {
  HumanTorqueObserverConfiguration observer;
  CalibratedArm arm;
  std::string model;  // file that the arm was calibrated by, empty: its URDF
};

/// A recorded stream of wrenches upon the arm, at a link of it.
struct RecordedWrench {
  std::string stream;
  RobotDescription arm_to_sensor;  // ends at the link
};

/// All that demo_logger_node is told from outside. config/record.yaml explains each of them.
struct DemoLoggerParameters {
  RecorderConfiguration recorder;
  Buttons buttons;
  std::optional<RobotDescription> robot;  // for the tool pose, where `base` or `tip` is given, and for human_torque
  std::optional<ObservedHuman> human_torque;
  std::optional<RecordedWrench> wrench;
};

/// `robot_description` is the URDF, empty if there is none. Throws ConfigurationError or ModelError, one sentence with
/// the full name of the parameter: wrong type, out of range, not understood.
DemoLoggerParameters parseDemoLoggerParameters(Parameters& parameters, const std::string& robot_description);

/// The same from the parameter server, below `private_node`. Where the topic of a stream, seen from `node`, is
/// published already, its type says which columns the stream has; a type that cannot be recorded is refused.
DemoLoggerParameters readDemoLoggerParameters(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

}  // namespace demo_logger
