#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "demo_logger/robot/robot_description.h"

namespace demo_logger {

/// The arm as Bullet wants it. Bullet's links have their origin at the centre of mass and their axes along the
/// principal axes of inertia: `X_link_principal[i]` is that frame in the URDF's link frame of joint i.
struct BulletBody {
  std::unique_ptr<btMultiBody> body;  // base fixed at the world's origin
  std::vector<Eigen::Isometry3d> X_link_principal;
};

/// No damping, no sleeping, gyroscopic terms on; no gravity, which is the world's.
BulletBody makeBulletBody(const RobotDescription& description);

/// Throws ModelError naming the first joint whose articulated inertia (what it feels with the joints beyond it loose)
/// is nearly nothing in some of a fixed set of configurations.
void refuseMasslessJoints(const RobotDescription& description);

}  // namespace demo_logger
