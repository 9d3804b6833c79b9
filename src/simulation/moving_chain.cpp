#include "moving_chain.h"

namespace demo_logger {
MovingChain::MovingChain(const RobotDescription& description)
    : mass_(static_cast<Eigen::Index>(description.joints.size()),
            static_cast<Eigen::Index>(description.joints.size())) {
  for (const ArmJoint& joint : description.joints) {
    bodies_.push_back({joint.X_parent_joint, joint.axis, joint.type == JointType::prismatic, joint.body.mass,
                       joint.body.center, joint.body.inertia, Eigen::Isometry3d::Identity(), joint.axis});
  }
  place(Eigen::VectorXd::Zero(size()));
}

void MovingChain::place(const Eigen::VectorXd& q) {
  const Eigen::Isometry3d* parent = &base_;
  for (int i = 0; i < size(); ++i) {
    Body& body = bodies_[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d rotation = parent->linear() * body.X_parent_joint.linear();
    body.axis = rotation * body.axis_in_joint;
    body.pose.translation() = parent->linear() * body.X_parent_joint.translation() + parent->translation();
    if (body.slides) {
      body.pose.linear() = rotation;
      body.pose.translation() += q[i] * body.axis;
    } else {
      body.pose.linear().noalias() = rotation * Eigen::AngleAxisd(q[i], body.axis_in_joint).toRotationMatrix();
    }
    parent = &body.pose;
  }
}

/// From the tip inwards, with the body composed of all links from i on: its momentum (linear p, angular l about the
/// base's origin) per velocity of joint i, seen by the joints before it.
const Eigen::MatrixXd& MovingChain::massMatrix() {
  double mass = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   // mass times centre
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the base's origin
  for (int i = size() - 1; i >= 0; --i) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d R = body.pose.linear();
    const Eigen::Vector3d center = body.pose * body.center_in_link;
    mass += body.mass;
    moment += body.mass * center;
    inertia += R * body.inertia_in_link * R.transpose();
    inertia -= body.mass * center * center.transpose();
    inertia.diagonal().array() += body.mass * center.squaredNorm();

    Eigen::Vector3d p;
    Eigen::Vector3d l;
    if (body.slides) {
      p = mass * body.axis;
      l = moment.cross(body.axis);
    } else {
      const Eigen::Vector3d at_origin = body.pose.translation().cross(body.axis);  // velocity of the body there
      p = mass * at_origin - moment.cross(body.axis);
      l = moment.cross(at_origin) + inertia * body.axis;
    }
    for (int j = 0; j <= i; ++j) {
      const Body& before = bodies_[static_cast<std::size_t>(j)];
      const double seen = before.slides ? before.axis.dot(p) : before.axis.dot(l - before.pose.translation().cross(p));
      mass_(i, j) = mass_(j, i) = seen;
    }
  }
  return mass_;
}

Eigen::Vector3d MovingChain::pointVelocity(int i, const Eigen::Vector3d& point) const {
  const Body& body = bodies_[static_cast<std::size_t>(i)];
  return body.slides ? body.axis : body.axis.cross(point - body.pose.translation());
}

Eigen::Vector3d MovingChain::angularVelocity(int i) const {
  const Body& body = bodies_[static_cast<std::size_t>(i)];
  return body.slides ? Eigen::Vector3d::Zero() : body.axis;
}

}  // namespace demo_logger
