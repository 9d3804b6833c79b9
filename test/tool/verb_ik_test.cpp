#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "demo_logger/formats/csv_writer.h"
#include "demo_logger/robot/robot_model.h"
#include "test/robot/pose_by_hand.h"
#include "test/robot/subjects.h"
#include "test/tool/tool_run.h"

namespace demo_logger {
namespace {

const std::string kTwoLink = " --urdf " DEMO_LOGGER_SOURCE_DIR "/urdf/two_link.urdf --base base_link --tip tool_tip ";
const std::string kDemoArm = " --urdf " DEMO_LOGGER_SOURCE_DIR "/urdf/demo_arm.urdf --base base_link --tip tool_tip ";
const std::string kStraightUp = "x,y,z,qx,qy,qz,qw\n0,0,0.9,0,0,0,1\n";

void appendRowOf(std::string& text, std::vector<double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    appendNumber(text, values[i]);
    text += i + 1 < values.size() ? ',' : '\n';
  }
}

std::vector<double> rowOf(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  return {X.translation().x(), X.translation().y(), X.translation().z(), q.x(), q.y(), q.z(), q.w()};
}

TEST(VerbIkTest, WritesOneRowPerPoseInOrderWithTheStatusLast) {
  const ToolRun run;
  const RobotDescription arm = describeOwnArm("demo_arm");
  const RobotModel kdl(arm);
  std::mt19937_64 generator(1);
  std::string poses = "time,x,y,z,qx,qy,qz,qw\n";
  std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> targets;
  for (int i = 0; i < 200; ++i) {
    targets.push_back(kdl.forwardKinematics(randomPosture(arm, generator)));
    std::vector<double> row = rowOf(targets.back());
    row.insert(row.begin(), 5.0 - i);  // solve does not mind the order of times
    appendRowOf(poses, row);
  }
  run.write("poses.csv", poses);
  const auto outcome = run("ik poses.csv -o joints.csv --tolerance 1e-9" + kDemoArm);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("joints.csv: 200 rows: 200 solved, largest residual "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  const auto table = run.cells("joints.csv");
  ASSERT_EQ(table.size(), 201U);
  const std::vector<std::string> header = {"time",      "q_joint_1",    "q_joint_2", "q_joint_3",
                                           "q_joint_4", "q_joint_5",    "q_joint_6", "q_joint_7",
                                           "residual",  "microseconds", "status"};
  EXPECT_EQ(table[0], header);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto& row = table[i + 1];
    EXPECT_EQ(row[0], std::to_string(5 - static_cast<int>(i)));
    Eigen::VectorXd q(7);
    for (int joint = 0; joint < 7; ++joint) q[joint] = std::stod(row[1 + static_cast<std::size_t>(joint)]);
    EXPECT_LT(poseDistance(kdl.forwardKinematics(q), targets[i]), 1e-9 + 1e-12) << i;
    EXPECT_LE(std::stod(row[8]), 1e-9);
    EXPECT_GT(std::stod(row[9]), 0.0);
    EXPECT_EQ(row[10], "solved");
  }
}

TEST(VerbIkTest, SeedsChooseTheTurnAndTimeIsLeftOutWhereThereIsNone) {
  const ToolRun run;
  run.write("poses.csv",
            "q0_joint_1,q0_joint_2,x,y,z,qx,qy,qz,qw\n6.2,0.1,0,0,0.9,0,0,0,1\n-6.2,0.1,0,0,0.9,0,0,0,1\n");
  EXPECT_EQ(run("ik poses.csv -o joints.csv" + kTwoLink).exit_code, 0);
  const auto table = run.cells("joints.csv");
  ASSERT_EQ(table.size(), 3U);
  EXPECT_EQ(table[0].front(), "q_joint_1");
  EXPECT_NEAR(std::stod(table[1][0]), 2.0 * M_PI, 1e-2)
      << "stretched is singular: the angle is only as good as the root";
  EXPECT_NEAR(std::stod(table[2][0]), -2.0 * M_PI, 1e-2);
}

TEST(VerbIkTest, UnsolvedRowsAreFindingsWithTheBestThatWasFound) {
  const ToolRun run;
  run.write("poses.csv", "x,y,z,qx,qy,qz,qw\n0,0,1.5,0,0,0,1\n0,0,0.9,0,0,0,1\nNaN,0,0.9,0,0,0,1\n0,0,0.9,0,0,0,0\n");
  const auto outcome = run("ik poses.csv -o joints.csv" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("poses.csv:4: the pose holds a value that is not a finite number; the row is not solved "
                             "(and 1 row more)"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("joints.csv: 4 rows: 3 failed, 1 solved, "), std::string::npos) << outcome.out;
  const auto table = run.cells("joints.csv");
  ASSERT_EQ(table.size(), 5U);
  EXPECT_EQ(table[1].back(), "failed");
  EXPECT_NEAR(std::stod(table[1][2]), 0.6, 1e-3) << "1.5 m asked, 0.9 m reached";
  EXPECT_EQ(table[2].back(), "solved");
  for (const std::size_t row : {3U, 4U}) {
    EXPECT_EQ(table[row][0], "NaN");
    EXPECT_EQ(table[row][2], "NaN");
    EXPECT_EQ(table[row].back(), "failed");
  }
}

TEST(VerbIkTest, WithoutASinglePoseThereIsNoResidual) {
  const ToolRun run;
  run.write("poses.csv", "x,y,z,qx,qy,qz,qw\n0,0,0.9,0,0,0,0\n");
  const auto outcome = run("ik poses.csv -o joints.csv" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.out.find("joints.csv: 1 rows: 1 failed, no residual, "), std::string::npos) << outcome.out;
  const auto json = run("ik poses.csv -o joints.csv --force --json" + kTwoLink);
  EXPECT_TRUE(nlohmann::json::parse(json.out)["tables"][0]["largest_residual"].is_null()) << json.out;
}

TEST(VerbIkTest, AQuaternionOfAnotherLengthIsNormalisedAndSaid) {
  const ToolRun run;
  run.write("poses.csv", "x,y,z,qx,qy,qz,qw\n0,0,0.9,0,0,0,1.17\n");
  const auto outcome = run("ik poses.csv -o joints.csv" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_NE(outcome.out.find("poses.csv:2: the quaternion has length 1.17, expected 1; it is normalised\n"),
            std::string::npos)
      << outcome.out;
}

TEST(VerbIkTest, ASeedOutOfLimitsIsSaidWithJointAndLimits) {
  const ToolRun run;
  run.write("poses.csv",
            "x,y,z,qx,qy,qz,qw,q0_joint_1,q0_joint_2\n0.5,0,0.3,0,0.7071067811865476,0,0.7071067811865476,99,0\n");
  const auto outcome = run("ik poses.csv -o joints.csv" + kTwoLink);
  EXPECT_NE(
      outcome.out.find("poses.csv:2: the seed of joint 'joint_1' is 99, out of its limits -12.5664 to 12.5664; the "
                       "nearest limit is taken"),
      std::string::npos)
      << outcome.out;
}

TEST(VerbIkTest, WhatKinematicsWritesCanBeRead) {
  const ToolRun run;
  run.write("motion.csv", "time,q_joint_1,q_joint_2\n0,0.3,0.9\n0.1,0.4,1.0\n");
  ASSERT_EQ(run("kinematics motion.csv -o posed.csv" + kTwoLink).exit_code, 0);
  EXPECT_EQ(run("ik posed.csv -o joints.csv" + kTwoLink).exit_code, 0);
  const auto table = run.cells("joints.csv");
  EXPECT_NEAR(std::stod(table[2][1]), 0.4, 1e-6);
  EXPECT_NEAR(std::stod(table[2][2]), 1.0, 1e-6);
}

TEST(VerbIkTest, RefusesInOneSentenceAndWritesNothing) {
  const ToolRun run;
  run.write("poses.csv", kStraightUp);
  run.write("there.csv", "mine");
  run.write("short.csv", "x,y,z,qx,qy,qz\n0,0,0.9,0,0,0\n");
  run.write("half.csv", "x,y,z,qx,qy,qz,qw,q0_joint_2\n0,0,0.9,0,0,0,1,0\n");
  const std::vector<std::pair<std::string, std::string>> refused = {
      {"ik poses.csv -o there.csv" + kTwoLink,
       "there.csv: exists already and is not overwritten; choose another name, or add --force\n"},
      {"ik nothing.csv -o joints.csv" + kTwoLink, "nothing.csv: no such file or directory\n"},
      {"ik short.csv -o joints.csv" + kTwoLink,
       "short.csv:1: there is no column `qw`, expected the pose of the tip as x, y, z [m], qx, qy, qz, qw\n"},
      {"ik half.csv -o joints.csv" + kTwoLink,
       "half.csv:1: there is no column `q0_joint_1`, expected a q0_ column for each of the 2 joints of robot "
       "'two_link', "
       "or none\n"},
      {"ik poses.csv short.csv -o many" + kTwoLink,
       "short.csv:1: there is no column `qw`, expected the pose of the tip as x, y, z [m], qx, qy, qz, qw\n"},
      {"ik poses.csv short.csv -o there.csv" + kTwoLink,
       "there.csv: is a file, expected a directory for the results of 2 inputs\n"},
      {"ik poses.csv -o joints.csv --at torso" + kTwoLink,
       "--at \"torso\": expected JOINT=VALUE with a position in rad or m, as in --at torso=0.3\n"},
      {"ik poses.csv -o joints.csv --at torso=0.3 --at torso=1" + kTwoLink,
       "--at says twice where joint 'torso' is held, at 0.3 and at 1 [rad or m]; expected once per joint\n"},
      {"ik poses.csv -o joints.csv --tolerance=-1" + kTwoLink,
       "--tolerance is -1 m and rad, expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --tolerance 0" + kTwoLink,
       "--tolerance is 0 m and rad, expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --tolerance nan" + kTwoLink,
       "--tolerance is nan m and rad, expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --budget 5ms" + kTwoLink, "--budget is \"5ms\", expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --mode track --rate inf" + kTwoLink,
       "--rate is inf Hz, expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --mode track --max-velocity 1e999" + kTwoLink,
       "--max-velocity is 1e999 rad/s or m/s, expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --mode track --max-acceleration 0" + kTwoLink,
       "--max-acceleration is 0 rad/s² or m/s², expected a finite number above 0\n"},
      {"ik poses.csv -o joints.csv --jobs 0" + kTwoLink, "--jobs is 0, expected a whole number from 1 to 256\n"},
      {"ik poses.csv -o joints.csv --jobs 1.5" + kTwoLink, "--jobs is 1.5, expected a whole number from 1 to 256\n"},
      {"kinematics poses.csv -o joints.csv --jobs many" + kTwoLink,
       "--jobs is \"many\", expected a whole number from 1 to 256\n"},
      {"torque poses.csv -o joints.csv --max-gap 0" + kTwoLink, "--max-gap is 0 s, expected a finite number above 0\n"},
      {"torque poses.csv -o joints.csv --fit model.yaml --model-error 2" + kTwoLink,
       "--model-error is 2, expected a finite number from 0.0001 to 1\n"},
      {"torque poses.csv -o joints.csv --control-period=-0.001" + kTwoLink,
       "--control-period is -0.001 s, expected a finite number above 0, at most 1\n"},
      {"import poses.bag -o many --max-wait 11", "--max-wait is 11 s, expected a finite number from 0 to 10\n"},
      {"import poses.bag -o many --split-gap=-1", "--split-gap is -1 s, expected a finite number of at least 0\n"},
      {"ik poses.csv -o joints.csv --urdf none.urdf", "none.urdf: no such file, expected a robot description (URDF)\n"},
  };
  for (const auto& [arguments, sentence] : refused) {
    const auto outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.err, sentence);
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(run.exists("joints.csv"));
    EXPECT_FALSE(run.exists("many"));
    EXPECT_EQ(run.read("there.csv"), "mine");
  }
  EXPECT_EQ(run("ik poses.csv -o there.csv --force" + kTwoLink).exit_code, 0);
  EXPECT_NE(run.read("there.csv"), "mine");
}

TEST(VerbIkTest, ManyTablesGoIntoADirectoryAndJsonIsOneObject) {
  const ToolRun run;
  run.write("a.csv", kStraightUp);
  run.write("b.csv", kStraightUp);
  const auto outcome = run("ik a.csv b.csv -o joints --jobs 2 --json" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto tables = nlohmann::json::parse(outcome.out)["tables"];
  ASSERT_EQ(tables.size(), 2U);
  EXPECT_EQ(tables[1]["output"], "joints/b.csv");
  EXPECT_EQ(tables[1]["rows"], 1);
  EXPECT_EQ(tables[1]["status"]["solved"], 1);
  EXPECT_TRUE(run.exists("joints/a.csv"));
}

/// A hand that moves 0.2 m along x and back, from rest to rest.
std::string handMotion(bool with_time) {
  std::string poses =
      with_time ? "time,x,y,z,qx,qy,qz,qw,q0_joint_1,q0_joint_2\n" : "x,y,z,qx,qy,qz,qw,q0_joint_1,q0_joint_2\n";
  const RobotModel kdl(describeOwnArm("two_link"));
  for (int k = 0; k <= 200; ++k) {
    const double t = 0.01 * k;
    const double s = 0.5 * (1.0 - std::cos(M_PI * t));
    std::vector<double> row = rowOf(kdl.forwardKinematics(Eigen::Vector2d(0.3 + 0.5 * s, 0.9 - 0.3 * s)));
    if (with_time) row.insert(row.begin(), t);
    row.push_back(0.3);
    row.push_back(0.9);
    appendRowOf(poses, row);
  }
  return poses;
}

TEST(VerbIkTest, TrackStartsAtRestAtTheSeedAndKeepsTheLimits) {
  const ToolRun run;
  run.write("timed.csv", handMotion(true));
  run.write("rows.csv", handMotion(false));
  for (const std::string arguments : {"timed.csv", "rows.csv --rate 100", "timed.csv --no-foresight"}) {
    const auto outcome =
        run("ik " + arguments + " -o joints.csv --force --mode track --max-velocity 3 --max-acceleration 5" + kTwoLink);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("joints.csv: 201 rows: 201 tracked, "), std::string::npos) << outcome.out;
    const auto table = run.cells("joints.csv");
    ASSERT_EQ(table.size(), 202U);
    const std::size_t first = arguments == "rows.csv --rate 100" ? 0 : 1;
    EXPECT_EQ(table[1][first], "0.3");
    EXPECT_EQ(table[1][first + 1], "0.9");
    for (std::size_t k = 2; k < table.size(); ++k) {
      EXPECT_EQ(table[k].back(), "tracked");
      const double now = std::stod(table[k][first]), last = std::stod(table[k - 1][first]);
      const double before = k > 2 ? std::stod(table[k - 2][first]) : last;
      EXPECT_LE(std::abs(now - last) / 0.01, 3.0);
      EXPECT_LE(std::abs(now - 2.0 * last + before) / 1e-4, 5.0);
    }
    EXPECT_NEAR(std::stod(table.back()[first]), 0.3, 1e-3);
  }
}

TEST(VerbIkTest, TrackSaysWhatKeptItFromTheTarget) {
  const ToolRun run;
  std::string poses = "x,y,z,qx,qy,qz,qw,q0_joint_1,q0_joint_2\n";
  for (int k = 0; k < 50; ++k) poses += "0.4,0,0.5,0,0.3,0,0.95,0.2,0.3\n";
  for (int k = 0; k < 300; ++k) poses += "1.5,0,0.5,0,0.3,0,0.95,0.2,0.3\n";
  poses += "NaN,0,0.5,0,0.3,0,0.95,0.2,0.3\n";
  run.write("poses.csv", poses);
  const auto outcome = run("ik poses.csv -o joints.csv --mode track --json" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 1);
  const auto status = nlohmann::json::parse(outcome.out)["tables"][0]["status"];
  EXPECT_GT(status["speed_limited"].get<int>() + status["unreachable"].get<int>(), 300);
  const auto table = run.cells("joints.csv");
  EXPECT_EQ(table[349].back(), "unreachable");
  EXPECT_EQ(table[351].back(), "unreachable");
  EXPECT_EQ(table[351][2], "NaN") << "no target, no residual; the joints slow down";
  EXPECT_NE(table[351][0], "NaN");
}

TEST(VerbIkTest, TimesThatGoBackCannotBeTracked) {
  const ToolRun run;
  run.write("poses.csv", "time,x,y,z,qx,qy,qz,qw\n0,0,0,0.9,0,0,0,1\n0.1,0,0,0.9,0,0,0,1\n0.1,0,0,0.9,0,0,0,1\n");
  const auto outcome = run("ik poses.csv -o joints.csv --mode track" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err,
            "poses.csv:4: time 0.1 s does not follow the row before; to track, times must strictly increase\n");
  EXPECT_FALSE(run.exists("joints.csv"));
}

TEST(VerbKinematicsTest, AddsThePoseOfTheClosedFormAndKeepsEverythingElse) {
  const ToolRun run;
  run.write("motion.csv", "time,q_joint_2,note,q_joint_1\n0,0.5,7,0\n0.1,NaN,8,0\n");
  const auto outcome = run("kinematics motion.csv -o posed.csv" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.out.find("posed.csv: 2 rows with the pose of tool_tip in base_link; 1 of them without, as the "
                             "position of a joint is missing (NaN)\n"),
            std::string::npos)
      << outcome.out;
  const auto table = run.cells("posed.csv");
  const std::vector<std::string> header = {"time", "q_joint_2", "note",  "q_joint_1", "ee_x", "ee_y",
                                           "ee_z", "ee_qx",     "ee_qy", "ee_qz",     "ee_qw"};
  EXPECT_EQ(table[0], header);
  EXPECT_EQ(table[1][2], "7");
  EXPECT_NEAR(std::stod(table[1][4]), 0.4 * std::sin(0.5), 1e-15);
  EXPECT_NEAR(std::stod(table[1][6]), 0.5 + 0.4 * std::cos(0.5), 1e-15);
  EXPECT_NEAR(std::stod(table[1][8]), std::sin(0.25), 1e-15);
  EXPECT_EQ(table[2][4], "NaN") << "a joint without a position leaves no pose";
  const auto sidecar = nlohmann::json::parse(run.read("posed.json"));
  EXPECT_EQ(sidecar["robot"]["tip"], "tool_tip");
  EXPECT_EQ(sidecar["provenance"]["parent"], "motion.csv");
  EXPECT_EQ(sidecar["provenance"]["steps"].back(), "kinematics --base base_link --tip tool_tip");
}

TEST(VerbKinematicsTest, WhatIkWritesLeadsBackToItsPoses) {
  const ToolRun run;
  for (const std::string time : {"", "time"}) {
    const std::string comma = time.empty() ? "" : ",";
    run.write("poses.csv", time + comma + "x,y,z,qx,qy,qz,qw\n" + (time.empty() ? "" : "7,") +
                               "0.4,0,0.5,0,0.7071067811865476,0,0.7071067811865476\n" + (time.empty() ? "" : "5,") +
                               "0.1,0.1,0.5,NaN,0,0,1\n");
    ASSERT_EQ(run("ik poses.csv -o joints.csv --force" + kTwoLink).exit_code, 1);
    const auto outcome = run("kinematics joints.csv -o posed.csv --force --json" + kTwoLink);
    EXPECT_EQ(outcome.exit_code, 1) << outcome.err << "the second row has no joints";
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["recordings"][0]["rows_without_pose"], 1);
    const auto joints = run.cells("joints.csv"), posed = run.cells("posed.csv");
    ASSERT_EQ(posed.size(), 3U);
    const std::size_t width = joints[0].size();
    ASSERT_EQ(posed[0].size(), width + 7);
    for (std::size_t row = 0; row < 3; ++row) {
      EXPECT_EQ(std::vector<std::string>(posed[row].begin(), posed[row].begin() + static_cast<std::ptrdiff_t>(width)),
                joints[row]);
    }
    EXPECT_EQ(posed[0][width], "ee_x");
    EXPECT_NEAR(std::stod(posed[1][width]), 0.4, 1e-6);
    EXPECT_NEAR(std::stod(posed[1][width + 2]), 0.5, 1e-6);
    EXPECT_EQ(posed[2][width], "NaN");
    EXPECT_FALSE(run.exists("posed.json")) << "such tables are no demonstrations";
    EXPECT_EQ(run("ik posed.csv -o again.csv --force" + kTwoLink).exit_code, 1) << "and can be solved again";
  }
  run.write("whole.csv", "q_joint_1,q_joint_2,status\n0,0.5,solved\n");
  EXPECT_EQ(run("kinematics whole.csv -o posed_whole.csv" + kTwoLink).exit_code, 0) << "every row has its pose";
}

TEST(VerbKinematicsTest, AStatusOfNumbersIsARecordingsOwnColumn) {
  const ToolRun run;
  run.write("motion.csv", "time,q_joint_1,q_joint_2,status\n0,0,0,3\n0.1,0,0,4\n");
  EXPECT_EQ(run("kinematics motion.csv -o posed.csv" + kTwoLink).exit_code, 0);
  EXPECT_EQ(run.cells("posed.csv")[2][3], "4");
  EXPECT_TRUE(run.exists("posed.json"));
}

TEST(VerbKinematicsTest, PosesThatAreThereAreReplacedNotDoubled) {
  const ToolRun run;
  run.write("motion.csv", "time,ee_x,q_joint_1,q_joint_2,ee_z\n0,9,0,0,9\n0.1,9,0,0,9\n");
  ASSERT_EQ(run("kinematics motion.csv -o posed.csv" + kTwoLink).exit_code, 0);
  const auto table = run.cells("posed.csv");
  EXPECT_EQ(table[0].size(), 10U);
  EXPECT_EQ(table[0][3], "ee_x");
  EXPECT_EQ(table[1][1], "0");
  EXPECT_NEAR(std::stod(table[1][5]), 0.9, 1e-15);
}

TEST(VerbKinematicsTest, AMissingJointIsNamedAndNothingIsWritten) {
  const ToolRun run;
  run.write("motion.csv", "time,q_joint_1\n0,0\n0.1,0\n");
  const auto outcome = run("kinematics motion.csv -o posed.csv" + kTwoLink);
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err,
            "motion.csv: no column `q_joint_2` with the position of joint 'joint_2', which the pose of 'tool_tip' in "
            "'base_link' depends on\n");
  EXPECT_FALSE(run.exists("posed.csv"));
  run.write("whole.csv", "time,q_joint_1,q_joint_2\n0,0,0\n0.1,0,0\n");
  run.write("posed.json", "{}");
  EXPECT_EQ(run("kinematics whole.csv -o posed.csv" + kTwoLink).err,
            "posed.json: exists already and is not overwritten; choose another name, or add --force\n");
  EXPECT_FALSE(run.exists("posed.csv"));
}

}  // namespace
}  // namespace demo_logger
