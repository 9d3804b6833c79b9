// Arms that people own, compared with a reading of their URDF that shares no line with the robot room: every link of
// the tree is placed by recursion from the root, and torque is the slope of the potential energy of all masses.

#include <gtest/gtest.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <string>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/own_arms.h"
#include "test/robot/real_arms.h"

namespace demo_logger {
namespace {

using Positions = std::map<std::string, double>;  // of the arm's joints, by name
using Poses = std::map<std::string, Eigen::Matrix4d>;

class TreeByHand {
 public:
  explicit TreeByHand(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    model_ = urdf::parseURDF(std::string{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()});
  }

  /// Pose of every link in the root.
  Poses poses(const Positions& arm) const {
    Poses result;
    place(*model_->getRoot(), Eigen::Matrix4d::Identity(), arm, result);
    return result;
  }

  /// Of all masses, with gravity along −z of the root [J].
  double potentialEnergy(const Positions& arm) const {
    double energy = 0.0;
    for (const auto& [name, X_root_link] : poses(arm)) {
      const auto& inertial = model_->getLink(name)->inertial;
      if (!inertial) continue;
      const urdf::Vector3& center = inertial->origin.position;
      energy += 9.81 * inertial->mass * (X_root_link * Eigen::Vector4d(center.x, center.y, center.z, 1.0)).z();
    }
    return energy;
  }

  /// Mass below a joint [kg], whatever moves there.
  double massBeyond(const std::string& joint) const { return massBelow(*linkBelow(joint)); }

 private:
  urdf::LinkConstSharedPtr linkBelow(const std::string& joint) const {
    return model_->getLink(model_->getJoint(joint)->child_link_name);
  }

  double massBelow(const urdf::Link& link) const {
    double mass = link.inertial ? link.inertial->mass : 0.0;
    for (const auto& child : link.child_links) mass += massBelow(*child);
    return mass;
  }

  double position(const urdf::Joint& joint, const Positions& arm) const {
    if (const auto found = arm.find(joint.name); found != arm.end()) return found->second;
    if (joint.mimic) {
      return joint.mimic->multiplier * position(*model_->getJoint(joint.mimic->joint_name), arm) + joint.mimic->offset;
    }
    if (joint.type == urdf::Joint::CONTINUOUS || !joint.limits) return 0.0;
    return std::min(std::max(0.0, joint.limits->lower), joint.limits->upper);
  }

  /// Unit quaternion to matrix, written out rather than a library's.
  static Eigen::Matrix4d origin(const urdf::Pose& pose) {
    double x = 0.0, y = 0.0, z = 0.0, w = 0.0;
    pose.rotation.getQuaternion(x, y, z, w);
    Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
    X.topLeftCorner<3, 3>() << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w),  //
        2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),                         //
        2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y);
    X.topRightCorner<3, 1>() << pose.position.x, pose.position.y, pose.position.z;
    return X;
  }

  /// Rodrigues' formula.
  static Eigen::Matrix4d motion(const urdf::Joint& joint, double q) {
    Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
    Eigen::Vector3d a(joint.axis.x, joint.axis.y, joint.axis.z);
    if (joint.type == urdf::Joint::FIXED || joint.type == urdf::Joint::FLOATING) return X;
    a /= std::sqrt(a.dot(a));
    if (joint.type == urdf::Joint::PRISMATIC) {
      X.topRightCorner<3, 1>() = q * a;
      return X;
    }
    Eigen::Matrix3d cross;
    cross << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
    X.topLeftCorner<3, 3>() += std::sin(q) * cross + (1.0 - std::cos(q)) * cross * cross;
    return X;
  }

  void place(const urdf::Link& link, const Eigen::Matrix4d& X_root_link, const Positions& arm, Poses& result) const {
    result[link.name] = X_root_link;
    for (const auto& joint : link.child_joints) {
      place(*model_->getLink(joint->child_link_name),
            X_root_link * origin(joint->parent_to_joint_origin_transform) * motion(*joint, position(*joint, arm)), arm,
            result);
    }
  }

  urdf::ModelInterfaceSharedPtr model_;
};

struct Subject {
  std::string path;
  RobotDescription description;
};

/// The package's own arms, and those of the folder if it is there.
std::vector<Subject> subjects() {
  std::vector<Subject> result;
  for (const std::string name : {"demo_arm", "two_link"}) result.push_back({ownUrdf(name), describeOwnArm(name)});
  if (realArmFolder().empty()) return result;
  for (const RealArm& arm : realArms()) result.push_back({realArmPath(arm), describeRealArm(arm)});
  return result;
}

Positions named(const RobotDescription& arm, const Eigen::VectorXd& q) {
  Positions positions;
  for (std::size_t i = 0; i < arm.joints.size(); ++i) positions[arm.joints[i].name] = q[static_cast<Eigen::Index>(i)];
  return positions;
}

class RandomConfigurations {
 public:
  explicit RandomConfigurations(const RobotDescription& arm) : arm_(arm) {}
  Eigen::VectorXd operator()() {
    Eigen::VectorXd q(static_cast<Eigen::Index>(arm_.joints.size()));
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(i)];
      q[i] =
          std::uniform_real_distribution<double>(std::max(joint.lower, -M_PI), std::min(joint.upper, M_PI))(generator_);
    }
    return q;
  }

 private:
  const RobotDescription& arm_;
  std::mt19937 generator_{7};
};

TEST(RealArmsTest, AreThere) {
  if (realArmFolder().empty()) {
    GTEST_SKIP() << "set DEMO_LOGGER_URDF to a folder of arms: only the package's own two are tested";
  }
  EXPECT_EQ(subjects().size(), 2u + realArms().size());
}

TEST(RealArmsTest, ForwardKinematicsAgreesWithThePlacingOfEveryLink) {
  for (const Subject& subject : subjects()) {
    const TreeByHand tree(subject.path);
    const RobotModel model(subject.description);
    RandomConfigurations random(model.description());
    double worst = 0.0;
    for (int state = 0; state < 200; ++state) {
      const Eigen::VectorXd q = random();
      const Poses poses = tree.poses(named(model.description(), q));
      const Eigen::Matrix4d X_base_tip =
          poses.at(subject.description.base).inverse() * poses.at(subject.description.tip);
      worst = std::max(worst, (model.forwardKinematics(q).matrix() - X_base_tip).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(worst, 1e-12) << subject.path;
  }
}

TEST(RealArmsTest, EveryMassThatAJointMovesIsInTheModel) {
  for (const Subject& subject : subjects()) {
    const TreeByHand tree(subject.path);
    double beyond = 0.0;
    for (auto joint = subject.description.joints.rbegin(); joint != subject.description.joints.rend(); ++joint) {
      beyond += joint->body.mass;
      EXPECT_NEAR(beyond, tree.massBeyond(joint->name), 1e-9) << subject.path << " " << joint->name;
    }
  }
}

/// Central differences of the energy err by h²/6 of its third derivative: U is a sum of sines of at most ~150 J.
TEST(RealArmsTest, GravityIsTheSlopeOfThePotentialEnergyOfAllMasses) {
  constexpr double h = 1e-4;
  constexpr double kTolerance = 1e-6;  // [N m]: 150 J · 1e-8 / 6, and rounding 150 J · 1e-15 / h
  for (const Subject& subject : subjects()) {
    if (!subject.description.has_inertia) continue;
    const TreeByHand tree(subject.path);
    const RobotModel model(subject.description);
    RandomConfigurations random(model.description());
    for (int state = 0; state < 30; ++state) {
      const Eigen::VectorXd q = random();
      const Eigen::VectorXd torque = model.gravity(q);
      for (int i = 0; i < model.size(); ++i) {
        Eigen::VectorXd before = q, after = q;
        before[i] -= h;
        after[i] += h;
        const double slope = (tree.potentialEnergy(named(model.description(), after)) -
                              tree.potentialEnergy(named(model.description(), before))) /
                             (2.0 * h);
        EXPECT_NEAR(torque[i], slope, kTolerance) << subject.path << " joint " << i + 1;
      }
    }
  }
}

TEST(RealArmsTest, AnArmWithoutInertiaSaysWhichLinkWhenDynamicsAreAsked) {
  if (realArmFolder().empty()) GTEST_SKIP() << "set DEMO_LOGGER_URDF to a folder of arms";
  const RealArm sia20d{"sia20d", "base_link", "tool0"};
  const RobotModel model(describeRealArm(sia20d));
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(model.size());
  EXPECT_TRUE(model.forwardKinematics(q).matrix().allFinite());
  try {
    model.gravity(q);
    FAIL() << "gravity of an arm without inertia";
  } catch (const ModelError& error) {
    EXPECT_EQ(error.what(), "no dynamics for robot 'motoman_sia20d': " + realArmPath(sia20d) +
                                ": nothing that joint 'joint_s' moves has mass up to the next joint; give link "
                                "'link_s' an <inertial> element");
  }
}

TEST(RealArmsTest, LimitsOfRealArmsAreTheNarrowerOnes) {
  if (realArmFolder().empty()) GTEST_SKIP() << "set DEMO_LOGGER_URDF to a folder of arms";
  const RobotDescription iiwa = describeRealArm({"iiwa14", "iiwa_link_0", "iiwa_link_ee"});
  EXPECT_EQ(iiwa.joints[0].upper, 2.9321531433504737) << "soft 168°, hard 170°";
  const RobotDescription pr2 = describeRealArm({"pr2", "torso_lift_link", "r_wrist_roll_link"});
  EXPECT_EQ(pr2.joints[4].type, JointType::continuous);
  EXPECT_TRUE(std::isinf(pr2.joints[4].upper));
}

}  // namespace
}  // namespace demo_logger
