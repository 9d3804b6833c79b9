#pragma once

#include <demo_logger/AppliedCommand.h>
#include <demo_logger/ApplyWrench.h>
#include <demo_logger/SetControlMode.h>
#include <demo_logger/SetLoad.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>
#include <topic_tools/shape_shifter.h>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "demo_logger/simulation/joint_state_faults.h"
#include "demo_logger/simulation/simulated_arm.h"
#include "demo_logger/simulation/tick_clock.h"
#include "src/nodes/simulated_arm_parameters.h"

namespace demo_logger {

/// Wires a SimulatedArm to ROS: commands and services come in on one thread, and wait for the next control tick, which
/// the thread in run() makes in real time.
///   subscribes  teleop_cmd (Twist or TwistStamped), joint_group_{effort,velocity,position}_controller/command,
///               joint_target, joint_trajectory, human_wrench
///   publishes   joint_states, applied_command, ground_truth/{joint_states,human_torque}, /clock when asked,
///               /diagnostics
///   services    ~set_control_mode, ~set_load, ~apply_wrench, ~save_state, ~reset_simulation, ~pause_physics,
///               ~unpause_physics
class SimulatedArmNode {
 public:
  SimulatedArmNode(ros::NodeHandle node, ros::NodeHandle private_node, const SimulatedArmParameters& parameters);

  /// Until ROS shuts down.
  void run();

 private:
  using TwistEvent = ros::MessageEvent<topic_tools::ShapeShifter const>;
  using WrenchEvent = ros::MessageEvent<geometry_msgs::WrenchStamped const>;

  struct SentWrench {
    LinkWrench wrench;
    Nanoseconds duration = 0;
    std::string source;
  };
  /// What came in between two ticks.
  struct Inbox {
    std::vector<ArmCommand> commands;
    std::vector<SentWrench> wrenches;
    std::vector<std::pair<std::string, std::string>> refusals;  // from whom, why
    std::uint64_t dropped = 0;
    std::optional<std::pair<ControlMode, ImpedanceGains>> mode;
    std::optional<std::optional<BodyInertia>> load;
    bool reset = false;
  };
  /// What the loop has to say to the diagnostics.
  struct LoopReport {
    std::uint64_t ticks = 0;
    std::uint64_t overruns = 0;
    std::uint64_t jumps = 0;
    std::uint64_t refused = 0;
    std::uint64_t dropped = 0;
    Nanoseconds largest_delay = 0;
    bool paused = false;
    std::string mode;
    Eigen::VectorXd q;
    std::string reason;
    std::string last_refusal;
    std::vector<std::string> clock_mismatches;
    JointStateFaults::Counters faults;
  };

  template <typename Message>
  void subscribe(ros::NodeHandle& node, const std::string& topic, std::function<ArmCommand(const Message&)> convert);
  void receiveTwist(const TwistEvent& event);
  void receiveWrench(const WrenchEvent& event);
  void put(ArmCommand command, const std::string& source);

  void advertiseServices(ros::NodeHandle& private_node);
  std::pair<LinkWrench, std::string> wrenchUpon(const std::string& link, const geometry_msgs::Wrench& message,
                                                bool in_link_axes) const;
  bool setLoad(SetLoad::Request& request, SetLoad::Response& response);
  bool applyWrench(ApplyWrench::Request& request, ApplyWrench::Response& response);
  bool saveState(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool setControlMode(SetControlMode::Request& request, SetControlMode::Response& response);
  ImpedanceGains requestedGains(ControlMode mode, const SetControlMode::Request& request);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool setPaused(bool paused);

  void restoreState(std::optional<Nanoseconds> next);
  Inbox takeInbox();
  void answerStateRequests();
  void tick(TickClock& clock);
  void publish(const ArmTick& tick);
  void report(TickClock& clock, const ArmTick& tick, std::uint64_t dropped);
  void startDiagnostics(ros::NodeHandle& node);
  void diagnoseLoop(diagnostic_updater::DiagnosticStatusWrapper& status);
  void diagnoseStart(diagnostic_updater::DiagnosticStatusWrapper& status) const;
  void diagnoseCommands(diagnostic_updater::DiagnosticStatusWrapper& status);

  SimulatedArmParameters parameters_;
  SimulatedArm arm_;
  std::vector<std::string> overlaps_;  // with floor and obstacles at the start, a sentence each
  JointStateFaults faults_;
  std::map<std::string, AttachedLink> links_;  // by name
  ros::Publisher joint_states_;
  ros::Publisher applied_command_;
  ros::Publisher ground_truth_;
  ros::Publisher external_torque_;
  ros::Publisher clock_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<ros::ServiceServer> services_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
  sensor_msgs::JointState truth_message_;  // reused: names do not change
  AppliedCommand::Ptr applied_message_;

  std::mutex mutex_;  // guards what follows
  Inbox inbox_;
  bool paused_ = false;
  bool state_wanted_ = false;  // by ~save_state, which waits for the tick to be whole
  std::string state_;
  std::condition_variable state_saved_;
  LoopReport report_;
  LoopReport last_report_;          // of the diagnostics before
  std::uint64_t refused_told_ = 0;  // by the diagnostics before
};

}  // namespace demo_logger
