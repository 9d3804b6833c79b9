#pragma once

#include <demo_logger/Label.h>
#include <demo_logger/Start.h>
#include <demo_logger/Status.h>
#include <demo_logger/Stop.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Joy.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "src/nodes/demo_logger_parameters.h"
#include "src/nodes/human_torque_publisher.h"
#include "src/nodes/live_recorder.h"
#include "src/nodes/recording_diagnostics.h"

namespace demo_logger {

/// Wires joint states, commands and further streams to a LiveRecorder; services, a joystick's buttons or the first
/// joint state begin an episode. Its callbacks run on the global queue: spin it.
///
///   in        joint_states   sensor_msgs/JointState
///             teleop_cmd     geometry_msgs/Twist or TwistStamped
///             ~streams       any supported type, topics as configured
///             joy            sensor_msgs/Joy, if `buttons` are given
///   out       ~status        demo_logger/Status, latched
///             ~human_torque  sensor_msgs/JointState, if `human_torque` is asked for
///             /diagnostics   diagnostic_msgs/DiagnosticArray, each second
///   services  ~start ~stop ~discard ~label
///   reads     teleop_map     the map in force, written by the teleoperation node; goes into the sidecar
class DemoLoggerNode {
 public:
  /// `node` resolves the topics, `private_node` the status and the services. Throws Error if it cannot record.
  DemoLoggerNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                 const DemoLoggerParameters& parameters);

  /// Ends the open episode, if there is one, as complete. Works after ROS has shut down, too.
  Reply close();

 private:
  bool onStart(Start::Request& request, Start::Response& response);
  bool onStop(Stop::Request& request, Stop::Response& response);
  bool onDiscard(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onLabel(Label::Request& request, Label::Response& response);
  void listenToButtons();
  void onJoy(const sensor_msgs::Joy& joy);

  Reply start(const Start::Request& request);
  Reply stop(const std::string& outcome, const std::string& notes);
  /// Stops with `outcome`, or gives it to the last episode if none is open.
  Reply judge(const std::string& outcome);

  void readTeleopMap();
  void publishStatus(const RecorderStatus& status);
  /// Each fault of an episode is said once on the console.
  void sayFaults(const RecorderStatus& status);
  void publishStatusIfChanged();
  void everySecond();

  ros::NodeHandle node_;
  const Buttons buttons_;
  std::vector<int> pressed_;                          // the buttons of the last joy message
  std::optional<HumanTorquePublisher> human_torque_;  // of the recorder's thread
  LiveRecorder recorder_;
  RecordingDiagnostics diagnostics_;
  std::string teleop_map_problem_;
  std::string problem_;            // why nothing can be recorded, as last said
  std::string episode_of_faults_;  // the episode whose faults were said, and what was said
  std::set<std::string> said_faults_;
  std::optional<Status> published_;

  ros::Publisher status_publisher_;
  ros::Subscriber joy_subscriber_;
  std::vector<ros::ServiceServer> services_;
  std::vector<ros::SteadyTimer> timers_;
};

}  // namespace demo_logger
