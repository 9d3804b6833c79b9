#include "demo_logger/pipelines/model_calibration.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "demo_logger/robot/identified_arm.h"
#include "demo_logger/robot/robot_model.h"
#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

RobotDescription demoArm() {
  return describeRobotFile(DEMO_LOGGER_SOURCE_DIR "/urdf/demo_arm.urdf", {"base_link", "tool_tip", {}, 9.81});
}

/// A file of its own that goes with the test.
class ModelFile {
 public:
  ModelFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "model_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~ModelFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  ModelFile(const ModelFile&) = delete;
  ModelFile& operator=(const ModelFile&) = delete;

  std::filesystem::path path() const { return folder_ / "model.yaml"; }
  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(path()).rdbuf();
    return text.str();
  }

  void write(const std::string& text) const { std::ofstream(path()) << text; }

  /// What is said of such a file, with the folder taken away.
  std::string refusalOf(const std::string& text) const {
    write(text);
    try {
      readModelCalibration(path());
    } catch (const FileError& error) {
      return std::string(error.what()).substr(folder_.string().size() + 1);
    }
    return "";
  }

 private:
  std::filesystem::path folder_;
};

ModelCalibration example() {
  ModelCalibration calibration;
  calibration.tip = "tool_tip";
  calibration.side = "link";
  CalibratedBody payload;
  payload.mass = {-0.25, 0.004};
  payload.center = {{{0.01, 0.001}, {-0.02, 0.002}, {0.05, 0.003}}};
  calibration.payload = payload;
  JointCalibration& joint = calibration.joints["joint_2"];
  joint.torque_bias = CalibratedValue{-0.4, 0.01};
  joint.damping = CalibratedValue{0.6, 0.05};
  joint.friction = CalibratedValue{0.3, 0.02};
  joint.friction_velocity = 0.02;
  joint.motor_inertia = CalibratedValue{0.1, 0.0};
  CalibratedBody body;
  body.mass = {2.0, 0.1};
  body.inertia = {{{0.02, 0.001}, {0.0, 0.0}, {0.0, 0.0}, {0.02, 0.001}, {0.0, 0.0}, {0.01, 0.001}}};
  calibration.bodies["joint_3"] = body;
  return calibration;
}

TEST(ModelCalibrationTest, AFileHoldsEveryValueWithItsDeviation) {
  const ModelFile file;
  writeModelCalibration(file.path(), example());
  const ModelCalibration read = readModelCalibration(file.path());
  EXPECT_EQ(read.tip, "tool_tip");
  EXPECT_EQ(read.side, "link");
  ASSERT_TRUE(read.payload);
  EXPECT_EQ(read.payload->mass.value, -0.25);
  EXPECT_EQ(read.payload->mass.deviation, 0.004);
  EXPECT_EQ(read.payload->center[1].value, -0.02);
  EXPECT_EQ(read.payload->center[2].deviation, 0.003);
  EXPECT_EQ(read.payload->inertia[0].value, 0.0) << "a point mass";
  const JointCalibration& joint = read.joints.at("joint_2");
  EXPECT_EQ(joint.torque_bias->value, -0.4);
  EXPECT_EQ(joint.damping->deviation, 0.05);
  EXPECT_EQ(joint.friction->value, 0.3);
  EXPECT_EQ(joint.friction_velocity, 0.02);
  EXPECT_EQ(joint.motor_inertia->deviation, 0.0) << "stated, not fitted";
  EXPECT_EQ(read.bodies.at("joint_3").body().inertia(2, 2), 0.01);
}

TEST(ModelCalibrationTest, AFileIsNotReplacedUnlessAsked) {
  const ModelFile file;
  writeModelCalibration(file.path(), example());
  const std::string before = file.text();
  EXPECT_THROW(writeModelCalibration(file.path(), {}), FileError);
  EXPECT_EQ(file.text(), before);
  EXPECT_NO_THROW(writeModelCalibration(file.path(), {}, /*overwrite=*/true));
}

TEST(ModelCalibrationTest, WhatIsWrongInAFileIsSaidWithFileLineKeyAndValue) {
  const ModelFile file;
  EXPECT_EQ(file.refusalOf("payload:\n  mass: heavy\n  center: [0, 0, 0]\n"),
            "model.yaml:2: payload.mass is \"heavy\", expected a number from -1000 to 1000 [kg].");
  EXPECT_EQ(file.refusalOf("payload:\n  mass: 1\n"), "model.yaml:2: payload.center is missing, expected it here.");
  EXPECT_EQ(file.refusalOf("payload:\n  mass: 1\n  center: [0, 0]\n"),
            "model.yaml:3: payload.center is a list of 2, expected a list of 3 numbers.");
  EXPECT_EQ(file.refusalOf("payload:\n  mass: 1\n  center: [0, 0, 70]\n"),
            "model.yaml:3: payload.center[2] is \"70\", expected a number from -10 to 10 [m].");
  EXPECT_EQ(
      file.refusalOf("joints:\n  joint_1: {damping: -1}\n"),
      "model.yaml:2: joints.joint_1.damping is \"-1\", expected a number from 0 to 1000000 [N m s/rad or N s/m].");
  EXPECT_EQ(file.refusalOf("joints:\n  joint_1: {friction: .nan}\n"),
            "model.yaml:2: joints.joint_1.friction is \".nan\", expected a number from 0 to 1000000 [N m or N].");
  EXPECT_EQ(file.refusalOf("joints:\n  joint_1: {damping_deviation: 1}\n"),
            "model.yaml:2: joints.joint_1.damping is missing, expected it here.");
  EXPECT_EQ(file.refusalOf("joints: [1]\n"),
            "model.yaml:1: joints is a list of 1, expected a mapping of keys to values.");
  EXPECT_EQ(file.refusalOf("side: both\n"), "model.yaml:1: side is \"both\", expected motor or link.");
  EXPECT_EQ(file.refusalOf("side: link\nside: motor\n"), "model.yaml:2: side is there twice, expected once.");
  EXPECT_EQ(file.refusalOf("tip: tool\nload: {}\n"),
            "model.yaml:2: load is not known here, expected format, tip, side, payload, joints or bodies.");
  EXPECT_EQ(file.refusalOf("format: demo_logger_model/2\n"),
            "model.yaml:1: format is \"demo_logger_model/2\", expected demo_logger_model/1.");
  EXPECT_EQ(file.refusalOf("just text"), "model.yaml: holds \"just text\", expected a mapping of keys to values");
  EXPECT_EQ(file.refusalOf("tip: [\n").rfind("model.yaml:2: is not YAML: ", 0), 0U);
  EXPECT_THROW(readModelCalibration(file.path().string() + ".none"), FileError);
}

TEST(ModelCalibrationTest, NumbersThatNoArmHasAreRefusedAllOfThem) {
  const ModelFile file;
  const auto refusalOf = [&file](const std::string& key_and_value) {
    return file.refusalOf("joints:\n  elbow: {" + key_and_value + "}\n");
  };
  const std::string place = "model.yaml:2: joints.elbow.";
  EXPECT_EQ(refusalOf("torque_bias: 1e300"),
            place + "torque_bias is \"1e300\", expected a number from -1000000 to 1000000 [N m or N].");
  EXPECT_EQ(refusalOf("torque_bias: 0, torque_bias_deviation: 1e300"),
            place + "torque_bias_deviation is \"1e300\", expected a number from 0 to 1000000000.");
  EXPECT_EQ(refusalOf("friction_velocity: 1e300"),
            place + "friction_velocity is \"1e300\", expected a number above 0, up to 1000 [rad/s or m/s].");
  EXPECT_EQ(refusalOf("motor_inertia: 1e300"),
            place + "motor_inertia is \"1e300\", expected a number from 0 to 100000 [kg m² or kg].");
}

TEST(ModelCalibrationTest, AFullFileIsReadInTimeInProportionToIt) {
  const ModelFile file;  // where each key is compared with all others, this is one that nobody waits for
  std::string text = "format: demo_logger_model/1\njoints:\n";
  std::size_t joints = 0;
  while (text.size() < 980000) text += "  j" + std::to_string(joints++) + ": {}\n";
  file.write(text);
  EXPECT_EQ(readModelCalibration(file.path()).joints.size(), joints);
  EXPECT_EQ(file.refusalOf(text.substr(text.find("joints")) + "  j7: {}\n"),
            "model.yaml:" + std::to_string(joints + 2) + ": joints.j7 is there twice, expected once.");
}

TEST(ModelCalibrationTest, WhatIsNoSingleModelOfItsFormatIsRefused) {
  const ModelFile file;
  EXPECT_EQ(file.refusalOf("side: link\n"), "model.yaml:1: format is missing, expected it here.");
  EXPECT_EQ(file.refusalOf("format: demo_logger_model/1\n---\nside: link\n"),
            "model.yaml:3: a second YAML document begins, expected one only");
  EXPECT_EQ(file.refusalOf(std::string(1000001, '#')), "model.yaml: is larger than 1 MB, expected a model (YAML)");
  EXPECT_THROW(readModelCalibration("/dev/zero"), FileError) << "which never ends";
  const std::filesystem::path pipe = file.path().parent_path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(readModelCalibration(pipe), FileError) << "which nobody writes to";
}

TEST(ModelCalibrationTest, APayloadsWeightAddsUpWhateverItsSign) {
  const RobotDescription arm = demoArm();
  Eigen::VectorXd q(7);
  q << 0.3, -0.8, 0.5, 1.2, -0.4, 0.9, 0.2;
  for (const double mass : {0.3, -0.3}) {
    ModelCalibration calibration;
    calibration.payload.emplace();
    calibration.payload->mass.value = mass;
    calibration.payload->center = {{{0.02, 0.0}, {0.0, 0.0}, {0.05, 0.0}}};
    const RobotModel model(calibrate(arm, calibration).robot);
    const RobotModel bare(arm);
    // The weight at its centre of mass, as a wrench upon the tip.
    const Eigen::Vector3d force = mass * Eigen::Vector3d(0.0, 0.0, -9.81);
    const Eigen::Vector3d lever = bare.forwardKinematics(q).linear() * Eigen::Vector3d(0.02, 0.0, 0.05);
    Eigen::VectorXd wrench(6);
    wrench << force, lever.cross(force);
    const Eigen::VectorXd expected = bare.gravity(q) - bare.jacobian(q).transpose() * wrench;
    EXPECT_LT((model.gravity(q) - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(ModelCalibrationTest, AnArmThatLosesMatterKeepsAPossibleLastBody) {
  const RobotDescription arm = demoArm();
  const double last = arm.joints.back().body.mass;
  BodyInertia lost;
  lost.mass = -0.9 * last;
  lost.center = {0.0, 0.0, 0.1};
  const RobotDescription lighter = withPayload(arm, lost);
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(7, 0.4);
  const Eigen::MatrixXd M = RobotModel(lighter).massMatrix(q);
  EXPECT_GT(M.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0.0);
  EXPECT_NEAR(lighter.joints.back().body.mass, 0.1 * last, 1e-12);

  lost.mass = -last;
  try {
    withPayload(arm, lost);
    ADD_FAILURE() << "nothing is left";
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("expected to leave some of it"), std::string::npos) << error.what();
  }
}

TEST(ModelCalibrationTest, DrivesAndBiasesGoToTheirJoints) {
  ModelCalibration calibration;
  calibration.joints["joint_5"].torque_bias = CalibratedValue{0.7, 0.0};
  calibration.joints["joint_2"].friction = CalibratedValue{0.3, 0.0};
  calibration.side = "link";
  const CalibratedArm arm = calibrate(demoArm(), calibration);
  EXPECT_EQ(arm.drives_side, "link");
  EXPECT_EQ(arm.torque_bias[4], 0.7);
  EXPECT_EQ(arm.torque_bias.cwiseAbs().sum(), 0.7);
  EXPECT_EQ(arm.seenAt("link").joints[1].friction, 0.3);
  EXPECT_EQ(arm.biasAt("link")[4], 0.7);
}

TEST(ModelCalibrationTest, EffortsOfEachSideShowTheDrivesOfThatSide) {
  RobotDescription robot = demoArm();
  robot.joints[1].motor_inertia = 0.1;
  ASSERT_GT(robot.joints[1].damping, 0.0);
  ModelCalibration calibration;
  calibration.joints["joint_2"].friction = CalibratedValue{0.3, 0.0};
  calibration.joints["joint_2"].torque_bias = CalibratedValue{0.7, 0.0};

  const CalibratedArm of_motors = calibrate(robot, calibration);
  EXPECT_EQ(of_motors.seenAt("motor").joints[1].friction, 0.3);
  EXPECT_EQ(of_motors.seenAt("motor").joints[1].damping, robot.joints[1].damping) << "what is absent stays";
  EXPECT_EQ(of_motors.biasAt("motor")[1], 0.7);
  EXPECT_EQ(of_motors.seenAt("link").joints[1].friction, 0.0);
  EXPECT_EQ(of_motors.seenAt("link").joints[1].damping, 0.0) << "the URDF's is that of the motors";
  EXPECT_TRUE(of_motors.biasAt("link").isZero(0.0));
  EXPECT_TRUE(of_motors.knowsOnlyTheOtherSide("link"));

  calibration.side = "link";
  const CalibratedArm of_links = calibrate(robot, calibration);
  EXPECT_EQ(of_links.seenAt("link").joints[1].friction, 0.3);
  EXPECT_EQ(of_links.seenAt("link").joints[1].damping, 0.0);
  EXPECT_EQ(of_links.seenAt("link").joints[1].motor_inertia, 0.0);
  EXPECT_EQ(of_links.seenAt("motor").joints[1].damping, robot.joints[1].damping) << "the description's own count";
  EXPECT_EQ(of_links.seenAt("motor").joints[1].motor_inertia, 0.1);
  EXPECT_EQ(of_links.seenAt("motor").joints[1].friction, robot.joints[1].friction);
  EXPECT_TRUE(of_links.biasAt("motor").isZero(0.0));
}

TEST(ModelCalibrationTest, AnotherArmsModelIsRefused) {
  const auto refusal = [](const ModelCalibration& calibration) -> std::string {
    try {
      calibrate(demoArm(), calibration);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  ModelCalibration calibration;
  calibration.joints["elbow"].friction = CalibratedValue{0.3, 0.0};
  EXPECT_EQ(refusal(calibration).rfind("no joint 'elbow' to drive in the arm of robot 'demo_arm'", 0), 0U)
      << refusal(calibration);
  ModelCalibration other_tip = example();
  other_tip.tip = "flange";
  EXPECT_EQ(refusal(other_tip),
            "the model has a payload at tip 'flange', but the tip of the arm is 'tool_tip'; choose the tip that the "
            "model was made for");
}

}  // namespace
}  // namespace demo_logger
