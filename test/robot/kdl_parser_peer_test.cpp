// kdl_parser, the reader of URDF that most of ROS uses, as an independent peer of our own.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "test/robot/own_arms.h"
#include "test/robot/real_arms.h"

namespace demo_logger {
namespace {

void compareForwardKinematics(const std::string& path, const RobotDescription& description) {
  std::ifstream file(path, std::ios::binary);
  KDL::Tree tree;
  ASSERT_TRUE(kdl_parser::treeFromString({std::istreambuf_iterator<char>(file), {}}, tree)) << path;
  KDL::Chain chain;
  ASSERT_TRUE(tree.getChain(description.base, description.tip, chain)) << path;
  ASSERT_EQ(chain.getNrOfJoints(), description.joints.size()) << path;

  const RobotModel model(description);
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::JntArray peer_q(chain.getNrOfJoints());
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> angle(-2.9, 2.9);
  for (int state = 0; state < 200; ++state) {
    Eigen::VectorXd q(model.size());
    for (int i = 0; i < model.size(); ++i) q[i] = angle(generator);
    peer_q.data = q;
    KDL::Frame peer;
    ASSERT_EQ(solver.JntToCart(peer_q, peer), 0);
    const Eigen::Isometry3d ours = model.forwardKinematics(q);
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(ours.translation()[row], peer.p(row), 1e-12) << path;
      for (int column = 0; column < 3; ++column) EXPECT_NEAR(ours.linear()(row, column), peer.M(row, column), 1e-12);
    }
  }
}

TEST(KdlParserPeerTest, FindsTheTipWhereWeDo) {
  for (const std::string name : {"demo_arm", "two_link"}) compareForwardKinematics(ownUrdf(name), describeOwnArm(name));
  if (realArmFolder().empty()) {
    GTEST_SKIP() << "the package's own arms agree; set DEMO_LOGGER_URDF to a folder of arms to compare those too";
  }
  for (const RealArm& arm : realArms()) compareForwardKinematics(realArmPath(arm), describeRealArm(arm));
}

}  // namespace
}  // namespace demo_logger
