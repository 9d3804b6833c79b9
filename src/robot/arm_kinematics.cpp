#include "arm_kinematics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

/// Moves the frame along its joint, the z axis.
inline void move(double q, bool prismatic, RigidPose& frame) {
  if (prismatic) {
    frame.p += q * frame.R.col(2);
    return;
  }
  const double c = std::cos(q), s = std::sin(q);
  const Eigen::Vector3d x = frame.R.col(0);
  frame.R.col(0) = c * x + s * frame.R.col(1);
  frame.R.col(1) = c * frame.R.col(1) - s * x;
}

}  // namespace

ArmKinematics::ArmKinematics(const RobotDescription& robot) {
  if (robot.joints.empty() || robot.joints.size() > kMostJoints) {
    throw ModelError("robot '" + robot.name + "' has " + std::to_string(robot.joints.size()) +
                     " moving joints from base to tip, expected 1 to " + std::to_string(kMostJoints) +
                     " for inverse kinematics");
  }
  Eigen::Matrix3d R_turned_joint = Eigen::Matrix3d::Identity();  // of the joint before
  for (const ArmJoint& joint : robot.joints) {
    const Eigen::Matrix3d R_joint_turned =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), joint.axis).toRotationMatrix();
    joints_.push_back({R_turned_joint * joint.X_parent_joint.linear() * R_joint_turned,
                       R_turned_joint * joint.X_parent_joint.translation(), joint.type == JointType::prismatic});
    if (joints_.size() > 1) reach_ += joints_.back().p.norm();
    if (joints_.back().prismatic) reach_ += std::max(std::abs(joint.lower), std::abs(joint.upper));
    R_turned_joint = R_joint_turned.transpose();
  }
  X_last_tip_.R = R_turned_joint * robot.X_lastlink_tip.linear();
  X_last_tip_.p = R_turned_joint * robot.X_lastlink_tip.translation();
  reach_ += X_last_tip_.p.norm();
}

void ArmKinematics::forward(const JointVector& q, RigidPose& X_base_tip) const {
  RigidPose frame{joints_.front().R, joints_.front().p};
  move(q[0], joints_.front().prismatic, frame);
  for (std::size_t i = 1; i < joints_.size(); ++i) {
    frame.p += frame.R * joints_[i].p;
    frame.R = (frame.R * joints_[i].R).eval();
    move(q[static_cast<Eigen::Index>(i)], joints_[i].prismatic, frame);
  }
  X_base_tip.p = frame.p + frame.R * X_last_tip_.p;
  X_base_tip.R.noalias() = frame.R * X_last_tip_.R;
}

void ArmKinematics::forward(const JointVector& q, RigidPose& X_base_tip, JacobianMatrix& jacobian) const {
  const Eigen::Index n = size();
  jacobian.resize(6, n);
  RigidPose frame{joints_.front().R, joints_.front().p};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Joint& joint = joints_[static_cast<std::size_t>(i)];
    if (i > 0) {
      frame.p += frame.R * joint.p;
      frame.R = (frame.R * joint.R).eval();
    }
    // Where the joint is and which way it points, until the tip is known.
    jacobian.col(i).head<3>() = frame.p;
    jacobian.col(i).tail<3>() = frame.R.col(2);
    move(q[i], joint.prismatic, frame);
  }
  X_base_tip.p = frame.p + frame.R * X_last_tip_.p;
  X_base_tip.R.noalias() = frame.R * X_last_tip_.R;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d axis = jacobian.col(i).tail<3>();
    if (joints_[static_cast<std::size_t>(i)].prismatic) {
      jacobian.col(i).head<3>() = axis;
      jacobian.col(i).tail<3>().setZero();
    } else {
      const Eigen::Vector3d arm = X_base_tip.p - jacobian.col(i).head<3>();
      jacobian.col(i).head<3>() = axis.cross(arm);
    }
  }
}

}  // namespace demo_logger
