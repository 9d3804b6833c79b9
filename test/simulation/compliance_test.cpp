// Which gains an arm may be given.

#include "demo_logger/simulation/compliance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>

#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"
#include "test/simulation/arms.h"
#include "test/simulation/simple_arms.h"

namespace demo_logger {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

Eigen::VectorXd seven(double value) { return Eigen::VectorXd::Constant(7, value); }

template <typename Function>
std::string messageOf(Function function) {
  try {
    function();
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "taken";
}

std::string judged(const RobotDescription& arm, const ImpedanceGains& gains, double h = kPeriod) {
  return messageOf([&] { requireStable(gains, arm, h); });
}

TEST(ComplianceTest, GainsAreOnePerJointOneForAllOrTheDefaults) {
  const RobotDescription arm = describeDemoArm();
  const ImpedanceGains defaults{seven(50.0), seven(0.2)};
  EXPECT_EQ(impedanceGains(arm, {}, {}, defaults).stiffness, defaults.stiffness);
  EXPECT_EQ(impedanceGains(arm, {}, {}, defaults).damping, defaults.damping);
  EXPECT_EQ(impedanceGains(arm, {30.0}, {}, defaults).stiffness, seven(30.0));
  EXPECT_EQ(impedanceGains(arm, {30.0}, {}, defaults).damping, defaults.damping);
  EXPECT_EQ(impedanceGains(arm, {}, {1, 2, 3, 4, 5, 6, 7}, defaults).damping[6], 7.0);
}

TEST(ComplianceTest, GainsThatMakeNoSenseAreNamed) {
  const RobotDescription arm = describeDemoArm();
  EXPECT_EQ(
      messageOf([&] {
        impedanceGains(arm, {1.0, 2.0}, {}, {});
      }),
      "impedance: stiffness has 2 values, expected one for each of the 7 joints, one for all of them, or none for "
      "the defaults.");
  EXPECT_EQ(messageOf([&] {
              impedanceGains(arm, {}, {1, 1, -0.5, 1, 1, 1, 1}, {});
            }),
            "impedance: damping of joint_3 is -0.5 N m s/rad, expected a number from 0 to 1e+09 N m s/rad.");
  EXPECT_EQ(messageOf([&] { impedanceGains(arm, {std::numeric_limits<double>::infinity()}, {}, {}); }),
            "impedance: stiffness of joint_1 is inf N m/rad, expected a number from 0 to 1e+09 N m/rad.");
  RobotDescription slide = makePendulum();
  slide.joints[0].type = JointType::prismatic;
  EXPECT_EQ(messageOf([&] { impedanceGains(slide, {-1.0}, {}, {}); }),
            "impedance: stiffness of hinge is -1 N/m, expected a number from 0 to 1e+09 N/m.");
}

TEST(ComplianceTest, GainsTooLargeToReckonWithAreRefusedNotLetThrough) {
  const RobotDescription arm = describeDemoArm();
  const double h = kPeriod;
  for (const double gain : {1e10, 1e154, 1e306, 1e308, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(impedanceGains(arm, {gain}, {gain}, {}), ConfigurationError) << gain;
    EXPECT_THROW(requireStable({seven(gain), seven(gain)}, arm, h), ConfigurationError) << gain;
    EXPECT_THROW(requireStable({seven(0.0), seven(gain)}, arm, h), ConfigurationError) << gain;
  }
  EXPECT_EQ(judged(arm, {seven(50.0), seven(1e308)}),
            "impedance: damping of joint_1 is 1e+308 N m s/rad, expected a number from 0 to 1e+09 N m s/rad.");
  EXPECT_THROW(requireStable({seven(kLargestGain), seven(kLargestGain)}, arm, h), ConfigurationError)
      << "within the range, and far from stable";
}

TEST(ComplianceTest, TheBoundOfAPendulumIsItsInertiaOverThePeriod) {
  const RobotDescription pendulum = makePendulum();  // 1 kg m²
  EXPECT_EQ(judged(pendulum, {vector1(0.0), vector1(999.0)}), "taken");
  EXPECT_EQ(
      judged(pendulum, {vector1(0.0), vector1(2500.0)}),
      "impedance: damping of hinge is 2500 N m s/rad, expected at most 1000 N m s/rad: λmax(M⁻¹ K_d) reaches 2500 "
      "1/s within the joints' limits, beyond the 1000 1/s of the control rate. Try 800 N m s/rad, or a higher "
      "control rate.");
  RobotDescription geared = makePendulum();
  geared.joints[0].motor_inertia = 2.0;
  EXPECT_EQ(judged(geared, {vector1(0.0), vector1(2500.0)}), "taken") << "3 kg m² with its motor";
}

TEST(ComplianceTest, AHeldSpringNeedsHalfAPeriodOfItselfAsDamping) {
  const RobotDescription pendulum = makePendulum();
  EXPECT_EQ(judged(pendulum, {vector1(400.0), vector1(0.2)}), "taken") << "K_d = h K_p / 2";
  const std::string message = judged(pendulum, {vector1(400.0), vector1(0.1)});
  EXPECT_EQ(message.rfind("impedance: stiffness of hinge is 400 N m/rad with a damping of 0.1 N m s/rad, expected at "
                          "most 200 N m/rad: the held spring would swing up, by a factor of 1.00005",
                          0),
            0U)
      << message;  // |z|² = 1 + h² K_p / 2 − h K_d = 1.0001
  EXPECT_NE(message.find(" each control period of 0.001 s. Try a damping of 0.4 N m s/rad."), std::string::npos)
      << message;
}

TEST(ComplianceTest, NoGainsAtAllAreGravityCompensationAndTaken) {
  const RobotDescription arm = describeDemoArm();
  EXPECT_EQ(judged(arm, {seven(0.0), seven(0.0)}), "taken");
  ImpedanceGains one_joint{seven(0.0), seven(0.0)};
  one_joint.stiffness[1] = 50.0;
  one_joint.damping[1] = 5.0;
  EXPECT_EQ(judged(arm, one_joint), "taken") << "the others stay where they are put";
}

TEST(ComplianceTest, TheJointThatIsOverdampedIsTheOneNamed) {
  const RobotDescription arm = describeDemoArm();
  for (Eigen::Index i = 0; i < 7; ++i) {
    ImpedanceGains gains{seven(0.0), seven(0.0)};
    gains.damping[i] = 1e4;
    const std::string message = judged(arm, gains);
    EXPECT_EQ(message.rfind("impedance: damping of joint_" + std::to_string(i + 1) + " is 10000 N m s/rad", 0), 0U)
        << message;
  }
}

TEST(ComplianceTest, ABoundThatIsFollowedIsTaken) {
  const RobotDescription arm = describeDemoArm();
  const std::string message = judged(arm, {seven(0.0), seven(40.0)});
  const std::string key = "expected at most ";
  const double bound = std::stod(message.substr(message.find(key) + key.size()));
  EXPECT_EQ(judged(arm, {seven(0.0), seven(0.999 * bound)}), "taken") << message;
  EXPECT_NE(judged(arm, {seven(0.0), seven(1.001 * bound)}), "taken") << message;
}

/// The number after `key` in `message`, or `otherwise` if it does not say so.
double adviceIn(const std::string& message, const std::string& key, double otherwise) {
  const std::size_t place = message.rfind(key);
  return place == std::string::npos ? otherwise : std::stod(message.substr(place + key.size()));
}

TEST(ComplianceTest, AdviceOnAStiffnessIsTakenIfItIsFollowed) {
  const RobotDescription arm = describeDemoArm();
  const ImpedanceGains defaults = defaultImpedanceGains(arm, kPeriod);
  for (const double stiffness : {2000.0, 1e4, 1e7, kLargestGain}) {
    for (const std::vector<double>& damping : {std::vector<double>{}, {0.0}, {1e-9}, {0.9}}) {
      const std::string refusal = judged(arm, impedanceGains(arm, {stiffness}, damping, defaults));
      if (refusal == "taken") continue;
      const std::string advice = refusal.substr(refusal.find(" s. ") + 4);
      const double stiff = adviceIn(advice, "stiffness of ", stiffness);
      const double damp = adviceIn(advice, "damping of ", -1.0);
      EXPECT_GT(stiff, 0.0) << refusal;
      EXPECT_EQ(judged(arm, impedanceGains(arm, {stiff}, damp < 0.0 ? damping : std::vector<double>{damp}, defaults)),
                "taken")
          << refusal;
    }
  }
}

TEST(ComplianceTest, AdviceForOneJointAfterTheOtherComesToAnEnd) {
  const RobotDescription arm = describeDemoArm();
  ImpedanceGains gains{seven(3000.0), defaultImpedanceGains(arm, kPeriod).damping};
  gains.stiffness[2] = 1e5;
  std::string refusal = judged(arm, gains);
  for (int followed = 0; refusal != "taken"; ++followed) {
    ASSERT_LE(followed, 7) << refusal;
    const std::string key = "stiffness of joint_";
    ASSERT_EQ(refusal.rfind("impedance: " + key, 0), 0U) << refusal;
    const Eigen::Index joint = std::stoi(refusal.substr(refusal.find(key) + key.size())) - 1;
    const std::string advice = refusal.substr(refusal.find(" s. ") + 4);
    gains.stiffness[joint] = adviceIn(advice, "stiffness of ", gains.stiffness[joint]);
    gains.damping[joint] = adviceIn(advice, "damping of ", gains.damping[joint]);
    refusal = judged(arm, gains);
  }
}

TEST(ComplianceTest, TheSampleSeesWhatAFarLargerOneSees) {
  const RobotDescription arm = describeDemoArm();
  const RobotModel model(arm);
  const ImpedanceGains gains = defaultImpedanceGains(arm, kPeriod);
  double sampled = 0.0;
  for (const Eigen::VectorXd& q : judgedPostures(arm)) {
    for (int i = 0; i < 7; ++i) {
      ASSERT_GE(q[i], arm.joints[static_cast<std::size_t>(i)].lower);
      ASSERT_LE(q[i], arm.joints[static_cast<std::size_t>(i)].upper);
    }
    sampled = std::max(sampled, judgeStability(gains, model.massMatrix(q), kPeriod).damping_rate);
  }
  std::mt19937 random(1);
  double largest = 0.0;
  for (int k = 0; k < 20000; ++k) {
    Eigen::VectorXd q(7);
    for (std::size_t i = 0; i < 7; ++i) {
      q[static_cast<Eigen::Index>(i)] =
          std::uniform_real_distribution<double>(arm.joints[i].lower, arm.joints[i].upper)(random);
    }
    const Eigen::MatrixXd M = model.massMatrix(q);
    const Eigen::MatrixXd rates = M.llt().solve(Eigen::MatrixXd(gains.damping.asDiagonal()));
    largest = std::max(largest, rates.eigenvalues().real().maxCoeff());
  }
  EXPECT_LT(largest, 1.02 * sampled);
}

TEST(ComplianceTest, TheDefaultsSuitAnyArmAtAnyControlRate) {
  for (const double h : {1e-4, 1e-3, 1e-2}) {
    const RobotDescription arm = describeDemoArm();
    const ImpedanceGains gains = defaultImpedanceGains(arm, h);
    EXPECT_EQ(judged(arm, gains, h), "taken") << h;
    EXPECT_GT(gains.stiffness.minCoeff(), 0.0);
    EXPECT_EQ(judged(makePendulum(), defaultImpedanceGains(makePendulum(), h), h), "taken") << h;
  }
  const ImpedanceGains pendulum = defaultImpedanceGains(makePendulum(), kPeriod);
  EXPECT_NEAR(pendulum.stiffness[0], 16.0, 1e-9) << "(4 rad/s)² on 1 kg m²";
  EXPECT_NEAR(pendulum.damping[0], 2.0 * 0.7 * 4.0, 1e-9);
}

}  // namespace
}  // namespace demo_logger
