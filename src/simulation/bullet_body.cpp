#include "bullet_body.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

static_assert(sizeof(btScalar) == 8, "link bullet-float64: the simulation needs Bullet in double precision");

btVector3 vectorToBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

btQuaternion rotationToBullet(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond quaternion(rotation);
  return {quaternion.x(), quaternion.y(), quaternion.z(), quaternion.w()};
}

struct PrincipalInertia {
  Eigen::Isometry3d X_link_principal;
  Eigen::Vector3d moments;  // [kg m²]
};

PrincipalInertia principalInertia(const BodyInertia& body) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(body.inertia);
  Eigen::Matrix3d axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) = -axes.col(0);
  Eigen::Isometry3d X_link_principal = Eigen::Isometry3d::Identity();
  X_link_principal.linear() = axes;
  X_link_principal.translation() = body.center;
  return {X_link_principal, solver.eigenvalues().cwiseMax(0.0)};  // a rod's smallest moment may round below 0
}

/// Schur complements of M from the tip inwards: the pivots that Featherstone's algorithm divides by.
Eigen::VectorXd articulatedInertia(const Eigen::MatrixXd& mass_matrix) {
  const Eigen::Index n = mass_matrix.rows();
  Eigen::VectorXd pivots(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index beyond = n - i - 1;
    const Eigen::VectorXd coupling = mass_matrix.col(i).tail(beyond);
    const Eigen::MatrixXd outer = mass_matrix.bottomRightCorner(beyond, beyond);
    pivots[i] = mass_matrix(i, i) - (beyond > 0 ? coupling.dot(outer.ldlt().solve(coupling)) : 0.0);
  }
  return pivots;
}

}  // namespace

BulletBody makeBulletBody(const RobotDescription& description) {
  const int size = static_cast<int>(description.joints.size());
  BulletBody result;
  result.body = std::make_unique<btMultiBody>(size, /*mass=*/0.0, btVector3(0, 0, 0), /*fixedBase=*/true,
                                              /*canSleep=*/false);
  btMultiBody& body = *result.body;
  body.setBaseWorldTransform(btTransform::getIdentity());

  Eigen::Isometry3d X_parent_principal = Eigen::Isometry3d::Identity();
  for (int i = 0; i < size; ++i) {
    const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
    const auto [X_link_principal, moments] = principalInertia(joint.body);
    const Eigen::Matrix3d R_principal_parent =
        (X_parent_principal.linear().transpose() * joint.X_parent_joint.linear() * X_link_principal.linear())
            .transpose();
    const btQuaternion parent_to_this = rotationToBullet(R_principal_parent);
    const btVector3 axis = vectorToBullet(X_link_principal.linear().transpose() * joint.axis);
    const btVector3 parent_center_to_pivot =
        vectorToBullet(X_parent_principal.inverse() * joint.X_parent_joint.translation());
    const btVector3 pivot_to_center = vectorToBullet(X_link_principal.linear().transpose() * joint.body.center);
    if (joint.type == JointType::prismatic) {
      body.setupPrismatic(i, joint.body.mass, vectorToBullet(moments), i - 1, parent_to_this, axis,
                          parent_center_to_pivot, pivot_to_center, /*disableParentCollision=*/true);
    } else {
      body.setupRevolute(i, joint.body.mass, vectorToBullet(moments), i - 1, parent_to_this, axis,
                         parent_center_to_pivot, pivot_to_center, /*disableParentCollision=*/true);
    }
    result.X_link_principal.push_back(X_link_principal);
    X_parent_principal = X_link_principal;
  }
  body.finalizeMultiDof();
  body.setHasSelfCollision(false);
  // Bullet's defaults would take 4 % of the speed per second, and clamp it at 100 rad/s.
  body.setLinearDamping(0.0);
  body.setAngularDamping(0.0);
  body.setMaxCoordinateVelocity(BT_LARGE_FLOAT);
  body.setUseGyroTerm(true);
  body.useRK4Integration(false);
  return result;
}

void refuseMasslessJoints(const RobotDescription& description) {
  constexpr double kSmallest = 1e-9;  // [kg m² or kg]: the rotor of a watch; Bullet gives up at 2e-16
  constexpr int kConfigurations = 5;
  const RobotModel model(description);
  Eigen::VectorXd q(model.size());
  for (int configuration = 0; configuration < kConfigurations; ++configuration) {
    // The golden ratio spreads the angles, so that no symmetry hides or fakes a singular arm in all of them.
    for (int i = 0; i < model.size(); ++i) q[i] = 2.0 * std::sin(1.618 * (configuration * model.size() + i));
    const Eigen::VectorXd inertia = articulatedInertia(model.massMatrix(q));
    for (int i = 0; i < model.size(); ++i) {
      if (inertia[i] > kSmallest) continue;
      const ArmJoint& joint = description.joints[static_cast<std::size_t>(i)];
      const bool linear = joint.type == JointType::prismatic;
      std::ostringstream sentence;
      sentence << "robot '" << description.name << "': joint '" << joint.name
               << "' moves (nearly) nothing: " << std::max(0.0, inertia[i]) << (linear ? " kg" : " kg m²")
               << " about its axis, expected above " << kSmallest << "; give link '" << joint.link
               << "' realistic inertia to simulate it";
      throw ModelError(sentence.str());
    }
  }
}

}  // namespace demo_logger
