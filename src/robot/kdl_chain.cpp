#include "kdl_chain.h"

namespace demo_logger {
namespace {

KDL::RigidBodyInertia toKdl(const BodyInertia& body) {
  const Eigen::Matrix3d& I = body.inertia;
  return KDL::RigidBodyInertia(body.mass, demo_logger::toKdl(body.center),
                               KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
}

}  // namespace

KDL::Vector toKdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame toKdl(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
          toKdl(Eigen::Vector3d(X.translation()))};
}

KDL::Chain makeKdlChain(const RobotDescription& description) {
  KDL::Chain chain;
  for (const ArmJoint& joint : description.joints) {
    const KDL::Frame X_parent_joint = toKdl(joint.X_parent_joint);
    const auto type = joint.type == JointType::prismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
    chain.addSegment(KDL::Segment(joint.link,
                                  KDL::Joint(joint.name, X_parent_joint.p, X_parent_joint.M * toKdl(joint.axis), type),
                                  X_parent_joint, toKdl(joint.body)));
  }
  chain.addSegment(KDL::Segment("tip", KDL::Joint("tip", KDL::Joint::Fixed), toKdl(description.X_lastlink_tip)));
  return chain;
}

}  // namespace demo_logger
