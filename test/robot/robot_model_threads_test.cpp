// KDL's chain remembers the last pose of each of its joints: threads that share one get wrong results, some 5 % of
// them.

#include <gtest/gtest.h>

#include <random>
#include <thread>
#include <vector>

#include "demo_logger/robot/robot_model.h"
#include "test/robot/own_arms.h"

namespace demo_logger {
namespace {

constexpr int kThreads = 3;
constexpr int kRounds = 60;

/// What a model says of one state, to the bit.
struct Answer {
  Eigen::VectorXd q, dq;
  Eigen::Isometry3d pose;
  Eigen::MatrixXd jacobian, mass;
  Eigen::VectorXd torque;
};

std::vector<Answer> answersAlone(const RobotDescription& description, int states) {
  const RobotModel model(description);
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> angle(-2.5, 2.5);
  std::vector<Answer> answers(static_cast<std::size_t>(states));
  for (Answer& answer : answers) {
    answer.q = Eigen::VectorXd::NullaryExpr(model.size(), [&] { return angle(generator); });
    answer.dq = Eigen::VectorXd::NullaryExpr(model.size(), [&] { return angle(generator); });
    answer.pose = model.forwardKinematics(answer.q);
    answer.jacobian = model.jacobian(answer.q);
    answer.mass = model.massMatrix(answer.q);
    answer.torque = model.motorTorque(answer.q, answer.dq, answer.dq);
  }
  return answers;
}

int wrongAnswers(const RobotModel& model, const std::vector<Answer>& truth) {
  int wrong = 0;
  Eigen::Isometry3d pose;
  Eigen::MatrixXd jacobian, mass;
  Eigen::VectorXd torque;
  for (int round = 0; round < kRounds; ++round) {
    for (const Answer& right : truth) {
      model.forwardKinematics(right.q, pose);
      model.jacobian(right.q, jacobian);
      model.massMatrix(right.q, mass);
      model.motorTorque(right.q, right.dq, right.dq, torque);
      wrong += static_cast<int>(pose.matrix() != right.pose.matrix()) + static_cast<int>(jacobian != right.jacobian) +
               static_cast<int>(mass != right.mass) + static_cast<int>(torque != right.torque);
    }
  }
  return wrong;
}

/// Each thread begins elsewhere in the list, so that no two ask for the same state.
std::vector<int> wrongAnswersOfThreads(const std::vector<const RobotModel*>& models, const std::vector<Answer>& truth) {
  std::vector<int> wrong(models.size(), 0);
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < models.size(); ++thread) {
    std::vector<Answer> turned = truth;
    std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(thread * truth.size() / models.size()),
                turned.end());
    threads.emplace_back([&wrong, &models, thread, turned] { wrong[thread] = wrongAnswers(*models[thread], turned); });
  }
  for (std::thread& thread : threads) thread.join();
  return wrong;
}

TEST(RobotModelThreadsTest, OneModelServesSeveralThreads) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const std::vector<Answer> truth = answersAlone(description, 200);
  const RobotModel shared(description);
  EXPECT_EQ(wrongAnswersOfThreads({kThreads, &shared}, truth), std::vector<int>(kThreads, 0));
}

TEST(RobotModelThreadsTest, ModelsOfOneDescriptionKnowNothingOfEachOther) {
  const RobotDescription description = describeOwnArm("demo_arm");
  const std::vector<Answer> truth = answersAlone(description, 200);
  std::vector<RobotModel> own;
  for (int thread = 0; thread < kThreads; ++thread) own.emplace_back(description);
  EXPECT_EQ(wrongAnswersOfThreads({&own[0], &own[1], &own[2]}, truth), std::vector<int>(kThreads, 0));
}

}  // namespace
}  // namespace demo_logger
