// A control loop must not wait for memory: after construction the model asks for none.

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "test/robot/counted_allocations.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

TEST(RobotModelMemoryTest, TheCounterCounts) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  const std::size_t before = allocation_count;
  const Eigen::VectorXd by_eigen = Eigen::VectorXd::Zero(7);
  EXPECT_EQ(allocation_count, before + 1);
  const std::vector<double> by_new(7);
  EXPECT_EQ(allocation_count, before + 2);
}

TEST(RobotModelMemoryTest, NothingIsAllocatedAfterConstruction) {
  if (!kAllocationsAreCounted) GTEST_SKIP() << "the sanitizer has an allocator of its own";
  RobotDescription description = describeOwnArm("demo_arm");
  for (ArmJoint& joint : description.joints) joint.friction_velocity = 0.01;
  const RobotModel model(description);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(7, 0.4);
  const Eigen::VectorXd bad = Eigen::VectorXd::Constant(7, std::numeric_limits<double>::quiet_NaN());
  const TipWrench wrench{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}};
  Eigen::VectorXd torque(7);
  Eigen::MatrixXd mass(7, 7), jacobian(6, 7);
  Eigen::Isometry3d pose;

  const std::size_t before = allocation_count;
  for (int call = 0; call < 10; ++call) {
    model.forwardKinematics(q, pose);
    model.jacobian(q, jacobian);
    model.gravity(q, torque);
    model.massMatrix(q, mass);
    model.coriolis(q, q, torque);
    model.inverseDynamics(q, q, q, torque);
    model.inverseDynamics(q, q, q, wrench, torque);
    model.friction(q, torque);
    model.motorTorque(q, q, q, torque);
    model.motorTorque(q, q, q, wrench, torque);
    model.motorTorque(q, bad, q, torque);
    model.jacobian(bad, jacobian);
  }
  EXPECT_EQ(allocation_count, before);
}

}  // namespace
}  // namespace demo_logger
