#pragma once

#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <optional>

#include "demo_logger/pipelines/human_torque_observer.h"
#include "demo_logger/recording/clock_watch.h"
#include "demo_logger/recording/sample.h"

namespace demo_logger {

/// Publishes the torque that a person exerts on the joints as it happens, whether an episode is recorded or not:
///   out   ~human_torque   sensor_msgs/JointState, effort: torque [N m or N]; stamp and order of the joint state
/// for every joint state with positions and efforts of the whole arm, NaN where the observer knows nothing. A row of a
/// recording waits for its stragglers; this does not, but it is the same observer.
class HumanTorquePublisher {
 public:
  HumanTorquePublisher(ros::NodeHandle private_node, const CalibratedArm& arm,
                       const HumanTorqueObserverConfiguration& configuration);

  /// A joint state as it came. One that is not newer than the last is left out, as is one whose clock cannot be told
  /// yet (ClockWatch, as in a recording): where it jumped, this begins anew with the second on the new clock.
  void onJointState(const JointStateSample& sample);

 private:
  bool take(const JointStateSample& sample);
  bool isNext(const ClockReading& reading);

  HumanTorqueObserver observer_;
  ros::Publisher publisher_;
  ClockWatch clock_;
  std::optional<Nanoseconds> last_;
  Eigen::VectorXd q_, effort_, torque_;
  sensor_msgs::JointState message_;
};

}  // namespace demo_logger
