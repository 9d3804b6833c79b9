#include "demo_logger/robot/tracking.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "demo_logger/robot/path_tracking.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/robot/counted_allocations.h"
#include "test/robot/error_of.h"
#include "test/robot/pose_by_hand.h"
#include "test/robot/subjects.h"
#include "test/robot/tracking_paths.h"
#include "test/robot/two_link_by_hand.h"

namespace demo_logger {
namespace {

constexpr double kMillimetre = 1e-3;    // and milliradian
constexpr double kVelocity = 2.5;       // [rad/s]
constexpr double kAcceleration = 10.0;  // [rad/s²]

TrackingOptions measuredOptions() {
  TrackingOptions options;
  options.max_velocity = kVelocity;
  options.max_acceleration = kAcceleration;
  return options;
}

/// Looks at nothing but the positions that come out.
class LimitsWatch {
 public:
  LimitsWatch(const RobotDescription& arm, const Eigen::VectorXd& start, double dt)
      : arm_(arm), dt_(dt), before_(start), last_(start) {}

  void see(const Eigen::VectorXd& q) {
    for (std::size_t k = 0; k < arm_.joints.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const ArmJoint& joint = arm_.joints[k];
      EXPECT_GE(q[i], joint.lower) << joint.name;
      EXPECT_LE(q[i], joint.upper) << joint.name;
      EXPECT_LE(std::abs(q[i] - last_[i]) / dt_, std::min(joint.velocity_limit, kVelocity)) << joint.name;
      EXPECT_LE(std::abs(q[i] - 2.0 * last_[i] + before_[i]) / (dt_ * dt_), kAcceleration) << joint.name;
    }
    before_ = last_;
    last_ = q;
  }

 private:
  const RobotDescription& arm_;
  double dt_;
  Eigen::VectorXd before_, last_;
};

struct WorstErrors {
  double position = 0.0;
  double rotation = 0.0;
};

/// Judged by KDL, with every step's limits watched.
WorstErrors follow(const RobotDescription& arm, const TrackingPath& path, double rate, bool foresight) {
  std::vector<double> times;
  for (std::size_t k = 0; k < path.poses.size(); ++k) times.push_back(static_cast<double>(k) / rate);
  const RobotModel kdl(arm);
  LimitsWatch watch(arm, path.start, 1.0 / rate);
  PathTracker ahead(arm, path.poses, times, path.start, measuredOptions());
  Tracker live(arm, measuredOptions());
  live.reset(path.start);
  WorstErrors worst;
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    if (foresight) {
      ahead.step();
    } else if (k > 0) {
      live.step(path.poses[k], 1.0 / rate);
    }
    const Eigen::VectorXd& q = foresight ? ahead.q() : live.q();
    watch.see(q);
    const Eigen::Isometry3d X = kdl.forwardKinematics(q);
    worst.position = std::max(worst.position, (X.translation() - path.poses[k].translation()).norm());
    worst.rotation = std::max(worst.rotation, angleBetween(X.linear(), path.poses[k].linear()));
  }
  return worst;
}

TEST(TrackingTest, TheToolsWayThroughSingularPosturesIsFollowedToTheMillimetre) {
  for (const Subject& subject : solverSubjects()) {
    const TrackingPath path = TrackingPaths(subject.arm, 100.0, {kVelocity, kAcceleration}).singular();
    const WorstErrors worst = follow(subject.arm, path, 100.0, true);
    EXPECT_LT(worst.position, kMillimetre) << subject.name;
    EXPECT_LT(worst.rotation, kMillimetre) << subject.name;
  }
}

TEST(TrackingTest, NoPathMakesTheArmBreakALimit) {
  for (const Subject& subject : solverSubjects()) {
    for (const bool abrupt : {false, true}) {
      const TrackingPaths paths(subject.arm, 100.0, {kVelocity, kAcceleration}, abrupt);
      for (const TrackingPath& path : paths.all()) follow(subject.arm, path, 100.0, false);  // the watch expects
    }
  }
}

RC_GTEST_PROP(TrackingProperty, TargetsThatJumpMakeTheArmBreakNoLimit, ()) {
  static const RobotDescription arm = describeOwnArm("demo_arm");
  static const RobotModel kdl(arm);
  static Tracker tracker(arm, measuredOptions());
  std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
  const double dt = *rc::gen::element(0.001, 0.01, 0.02);
  const Eigen::VectorXd start = randomPosture(arm, generator);
  tracker.reset(start);
  LimitsWatch watch(arm, start, dt);
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 200; ++k) {
    if (k % 40 == 0) target = kdl.forwardKinematics(randomPosture(arm, generator));
    if (k % 40 == 30) target.translation() *= 5.0;  // far out of reach
    tracker.step(target, dt);
    watch.see(tracker.q());
  }
  RC_ASSERT(!testing::Test::HasFailure());
}

TEST(TrackingTest, ATargetAtRestIsReachedAndHeldWithoutOvershoot) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const RobotModel kdl(arm);
  Eigen::VectorXd start(7), goal(7);
  start << 0.0, 0.5, 0.0, 1.5, 0.0, 1.1, 0.0;
  goal << 0.3, 0.7, 0.1, 1.2, -0.1, 0.9, 0.4;
  const Eigen::Isometry3d target = kdl.forwardKinematics(goal);
  Tracker tracker(arm, measuredOptions());
  tracker.reset(start);
  double least = std::numeric_limits<double>::infinity(), after = 0.0;
  TrackedStep step;
  for (int k = 0; k < 2000; ++k) {
    step = tracker.step(target, 0.001);
    const double error = std::max(step.position_error, step.rotation_error);
    if (least < 1e-4) after = std::max(after, error);
    least = std::min(least, error);
  }
  EXPECT_EQ(step.status, TrackingStatus::tracked);
  EXPECT_LT(std::max(step.position_error, step.rotation_error), 1e-6);
  EXPECT_LT(after, kMillimetre) << "once there it stays";
}

TEST(TrackingTest, VelocityIsTheMeanOfTheLastStep) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const TrackingPath path = TrackingPaths(arm, 50.0, {kVelocity, kAcceleration}).nominal();
  Tracker tracker(arm, measuredOptions());
  tracker.reset(path.start);
  for (std::size_t k = 0; k < 50; ++k) {
    const Eigen::VectorXd before = tracker.q();
    tracker.step(path.poses[k], 0.02);
    EXPECT_LT((tracker.velocity() - (tracker.q() - before) / 0.02).norm(), 1e-12);
  }
}

TEST(TrackingTest, TheFirstStepsFromRestAreSpeedLimitedAndSaidToBe) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  Eigen::VectorXd start(7);
  start << 0.0, 0.5, 0.0, 1.5, 0.0, 1.1, 0.0;
  Tracker tracker(arm, measuredOptions());
  tracker.reset(start);
  Eigen::Isometry3d target = RobotModel(arm).forwardKinematics(start);
  target.translation().x() += 0.05;
  EXPECT_EQ(tracker.step(target, 0.01).status, TrackingStatus::speed_limited);
  EXPECT_STREQ(toString(TrackingStatus::speed_limited), "speed_limited");
}

TEST(TrackingTest, FromAPostureOffThePathForesightFindsTheWayToIt) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const TrackingPath path = TrackingPaths(arm, 100.0, {kVelocity, kAcceleration}).singular();
  const Eigen::VectorXd upright = Eigen::VectorXd::Zero(7);  // stretched: no descent leads away from it
  std::vector<double> times;
  for (std::size_t k = 0; k < path.poses.size(); ++k) times.push_back(0.01 * static_cast<double>(k));
  PathTracker tracker(arm, path.poses, times, upright, measuredOptions());
  LimitsWatch watch(arm, upright, 0.01);
  TrackedStep step;
  for (std::size_t k = 0; k < 300; ++k) {
    step = tracker.step();
    watch.see(tracker.q());
  }
  EXPECT_EQ(step.status, TrackingStatus::tracked) << "3 s are enough for any joint to go anywhere";
}

TEST(TrackingTest, OutOfReachTheArmStretchesTowardsTheHand) {
  const RobotDescription arm = describeOwnArm("two_link");
  Tracker tracker(arm, measuredOptions());
  tracker.reset(Eigen::Vector2d(0.6, 0.5));
  Eigen::Isometry3d hand = Eigen::Isometry3d::Identity();
  hand.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).matrix();  // not that of the stretched arm
  hand.translation() = Eigen::Vector3d(1.2, 0.0, 0.9);                        // 1.5 m away
  TrackedStep step;
  for (int k = 0; k < 4000; ++k) step = tracker.step(hand, 0.001);
  EXPECT_EQ(step.status, TrackingStatus::unreachable);
  const double distance = 1.5 - TwoLinkByHand::l1 - TwoLinkByHand::l2;
  EXPECT_NEAR(step.position_error, distance, 2.0 * kMillimetre) << "position comes before orientation";
  EXPECT_LT(tracker.velocity().cwiseAbs().maxCoeff(), 1e-2) << "and the arm does not spin";
}

TEST(TrackingTest, ContinuousJointsAreNeverWrapped) {
  const RobotDescription arm = describeRobot(R"(<robot name="wheel"><link name="base"/><link name="rim"/>
    <joint name="axle" type="continuous"><parent link="base"/><child link="rim"/><axis xyz="0 0 1"/></joint></robot>)",
                                             {});
  Tracker tracker(arm, measuredOptions());
  tracker.reset(Eigen::VectorXd::Zero(1));
  for (int k = 1; k <= 2000; ++k) {
    Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
    const double angle = 2.0 * std::pow(std::min(0.01 * k, 1.0), 2) * 0.5 + 2.0 * std::max(0.0, 0.01 * k - 1.0);
    target.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix();
    tracker.step(target, 0.01);
  }
  EXPECT_NEAR(tracker.q()[0], 1.0 + 2.0 * 19.0, 1e-3) << "six turns on, not back at the start";
}

TEST(TrackingTest, WithoutATargetTheArmComesToRestWithinItsLimits) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const TrackingPath path = TrackingPaths(arm, 100.0, {kVelocity, kAcceleration}).nominal();
  Tracker tracker(arm, measuredOptions());
  tracker.reset(path.start);
  LimitsWatch watch(arm, path.start, 0.01);
  for (std::size_t k = 0; k < 200; ++k) {
    tracker.step(path.poses[k], 0.01);
    watch.see(tracker.q());
  }
  ASSERT_GT(tracker.velocity().cwiseAbs().maxCoeff(), 0.05);
  Eigen::Isometry3d nothing = Eigen::Isometry3d::Identity();
  nothing.translation().x() = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < 50; ++k) {
    const TrackedStep step = tracker.step(nothing, 0.01);
    EXPECT_EQ(step.status, TrackingStatus::unreachable);
    EXPECT_TRUE(std::isnan(step.position_error));
    watch.see(tracker.q());
  }
  EXPECT_EQ(tracker.velocity().cwiseAbs().maxCoeff(), 0.0);
}

/// Poses anywhere in reach, each held for 6 s: some can only be met with another elbow or wrist.
struct HeldPoses {
  static constexpr std::size_t kSteps = 600;  // of 0.01 s
  PathTracker::Poses poses;
  std::vector<double> times;

  HeldPoses(const RobotDescription& arm, int count) {
    const RobotModel kdl(arm);
    std::mt19937_64 generator(4);
    for (int i = 0; i < count; ++i) {
      poses.insert(poses.end(), kSteps, kdl.forwardKinematics(randomPosture(arm, generator)));
    }
    for (std::size_t k = 0; k < poses.size(); ++k) times.push_back(0.01 * static_cast<double>(k));
  }
};

TEST(TrackingTest, WithPatienceWhatAnotherPostureReachesIsReached) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const HeldPoses held(arm, 12);
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(7);
  TrackingOptions options = measuredOptions();
  options.patience = 0.5;
  for (const bool foresight : {true, false}) {
    PathTracker ahead(arm, held.poses, held.times, start, options);
    Tracker live(arm, options);
    live.reset(start);
    LimitsWatch watch(arm, start, 0.01);
    for (std::size_t k = 0; k < held.poses.size(); ++k) {
      const TrackedStep step = foresight ? ahead.step()
                               : k == 0  ? live.stay(held.poses[0])
                                         : live.step(held.poses[k], 0.01);
      watch.see(foresight ? ahead.q() : live.q());
      ASSERT_NE(step.status, TrackingStatus::unreachable) << "step " << k << ", foresight " << foresight;
      if ((k + 1) % HeldPoses::kSteps == 0) {
        EXPECT_EQ(step.status, TrackingStatus::tracked) << "step " << k << ", foresight " << foresight;
      }
    }
  }
}

TEST(TrackingTest, WithoutPatienceItStaysLocalAndYetCallsNothingUnreachableThatIsNot) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const HeldPoses held(arm, 12);
  Tracker tracker(arm, measuredOptions());
  tracker.reset(Eigen::VectorXd::Zero(7));
  tracker.step(held.poses[0], 0.01);
  int stuck = 0;
  const std::size_t before = allocation_count;
  for (std::size_t k = 1; k < held.poses.size(); ++k) {
    const TrackedStep step = tracker.step(held.poses[k], 0.01);
    ASSERT_NE(step.status, TrackingStatus::unreachable) << "step " << k;
    if ((k + 1) % HeldPoses::kSteps == 0 && !step.in_reach) ++stuck;
  }
  EXPECT_EQ(allocation_count, before) << "neither do searches allocate";
  EXPECT_GT(stuck, 3) << "else these poses show nothing";
}

TEST(TrackingTest, WithinItsLengthButOutOfReachInEveryPostureIsUnreachable) {
  const RobotDescription arm = describeOwnArm("two_link");
  Tracker tracker(arm, measuredOptions());
  tracker.reset(Eigen::Vector2d(0.3, 0.9));
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
  target.translation() = Eigen::Vector3d(0.3, 0.4, 0.3);  // off the plane in which it moves
  TrackedStep step;
  for (int k = 0; k < 300; ++k) step = tracker.step(target, 0.01);
  EXPECT_EQ(step.status, TrackingStatus::unreachable);
  EXPECT_FALSE(step.in_reach);
}

TEST(TrackingTest, UnevenStepsKeepEveryLimit) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const RobotModel kdl(arm);
  std::mt19937_64 generator(9);
  Tracker tracker(arm, measuredOptions());
  tracker.reset(Eigen::VectorXd::Zero(7));
  double previous_dt = 0.2;
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();
  for (int k = 0; k < 2000; ++k) {
    if (k % 100 == 0) target = kdl.forwardKinematics(randomPosture(arm, generator));
    const double dt = std::uniform_real_distribution<double>(0.0005, k % 10 == 0 ? 0.2 : 0.005)(generator);
    const Eigen::VectorXd before = tracker.q(), velocity = tracker.velocity();
    tracker.step(target, dt);
    const Eigen::VectorXd change = tracker.velocity() - velocity;
    EXPECT_LE(change.cwiseAbs().maxCoeff(), kAcceleration * 0.5 * (previous_dt + dt));
    previous_dt = dt;
    for (int i = 0; i < 7; ++i) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(i)];
      EXPECT_LE(std::abs(tracker.q()[i] - before[i]) / dt, std::min(joint.velocity_limit, kVelocity));
      EXPECT_GE(tracker.q()[i], joint.lower);
      EXPECT_LE(tracker.q()[i], joint.upper);
    }
  }
}

TEST(TrackingTest, NoStepAllocatesAndEveryRunGivesTheSameBits) {
  const RobotDescription arm = describeOwnArm("demo_arm");
  const TrackingPath path = TrackingPaths(arm, 100.0, {kVelocity, kAcceleration}).outOfReach();
  Tracker tracker(arm, measuredOptions());
  std::vector<Eigen::VectorXd> first;
  tracker.reset(path.start);
  tracker.step(path.poses[0], 0.01);  // work space takes its size
  const std::size_t before = allocation_count;
  for (const Eigen::Isometry3d& pose : path.poses) tracker.step(pose, 0.01);
  if (kAllocationsAreCounted) {
    EXPECT_EQ(allocation_count, before);
  }

  for (const bool again : {false, true}) {
    tracker.reset(path.start);
    for (std::size_t k = 0; k < path.poses.size(); ++k) {
      tracker.step(path.poses[k], 0.01);
      if (again) {
        EXPECT_EQ(tracker.q(), first[k]);
      } else {
        first.push_back(tracker.q());
      }
    }
  }
}

TEST(TrackingTest, SenselessLimitsStartsAndStepsAreSaidInASentence) {
  const RobotDescription arm = describeOwnArm("two_link");
  TrackingOptions options;
  options.max_acceleration = 0.0;
  EXPECT_EQ(errorOf([&] { Tracker tracker(arm, options); }),
            "tracking: the velocity limit is inf, the acceleration limit 0, the tolerance 0.001; expected "
            "positive numbers");
  Tracker tracker(arm);
  EXPECT_EQ(errorOf([&] { tracker.reset(Eigen::VectorXd::Zero(3)); }),
            "robot 'two_link': cannot start tracking from 3 values, expected a finite one for each of its 2 joints");
  EXPECT_EQ(errorOf([&] { tracker.step(Eigen::Isometry3d::Identity(), 0.0); }),
            "tracking: a step of 0 s, expected a positive time");
  const PathTracker::Poses poses(2, Eigen::Isometry3d::Identity());
  EXPECT_EQ(errorOf([&] {
              PathTracker(arm, poses, {0.5000001, 0.5}, Eigen::VectorXd::Zero(2));
            }),
            "tracking: time 0.5 s does not follow 0.5000001 s; times must strictly increase");
  EXPECT_EQ(errorOf([&] { PathTracker(arm, poses, {0.0}, Eigen::VectorXd::Zero(2)); }),
            "tracking: 1 times for 2 poses, expected one for each");
}

}  // namespace
}  // namespace demo_logger
