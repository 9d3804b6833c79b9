#pragma once

#include <demo_logger/AppliedCommand.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/Wrench.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <std_msgs/Float32MultiArray.h>
#include <std_msgs/Float64MultiArray.h>

#include "demo_logger/recording/sample.h"

namespace demo_logger {

// ROS messages become the recorder's samples. What a header says (stamp, frame_id) replaces what `arrival` holds;
// messages without a header keep stamp 0, which the synchroniser reads as "placed by receipt". Values are taken as they
// are: finding what is malformed, not finite or not normalised is the synchroniser's work.

Nanoseconds toNanoseconds(const ros::Time& time);
ros::Time toRosTime(Nanoseconds stamp);

JointStateSample toJointStateSample(sensor_msgs::JointState message, Arrival arrival);

StreamSample toStreamSample(const geometry_msgs::Twist& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::TwistStamped& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::Pose& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::PoseStamped& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::Transform& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::TransformStamped& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::Wrench& message, Arrival arrival);
StreamSample toStreamSample(const geometry_msgs::WrenchStamped& message, Arrival arrival);
StreamSample toStreamSample(const sensor_msgs::Joy& message, Arrival arrival);

/// A joint command: the positions if there are any, else the velocities, else the efforts.
StreamSample toStreamSample(const sensor_msgs::JointState& message, Arrival arrival);
/// A joint command by name; its units follow from the control mode.
StreamSample toStreamSample(const AppliedCommand& message, Arrival arrival);
/// A joint command without names: joint0, joint1, …, unit unknown.
StreamSample toStreamSample(const std_msgs::Float64MultiArray& message, Arrival arrival);
StreamSample toStreamSample(const std_msgs::Float32MultiArray& message, Arrival arrival);

}  // namespace demo_logger
