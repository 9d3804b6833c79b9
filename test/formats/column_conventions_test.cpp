#include "demo_logger/formats/column_conventions.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

void expectColumn(const Column& column, const char* unit, Role role, Interpolation interpolation) {
  EXPECT_EQ(column.unit, unit) << column.name;
  EXPECT_STREQ(toString(column.role), toString(role)) << column.name;
  EXPECT_STREQ(toString(column.interpolation), toString(interpolation)) << column.name;
}

TEST(ColumnConventionsTest, JointColumnsSayPositionVelocityAndEffort) {
  const auto columns = describeColumns({"q_elbow", "dq_elbow", "tau_elbow", "tau_h_elbow", "receipt_delay"});
  expectColumn(columns[0], "rad", Role::state, Interpolation::linear);
  expectColumn(columns[1], "rad/s", Role::state, Interpolation::linear);
  expectColumn(columns[2], "N m", Role::auxiliary, Interpolation::linear);
  expectColumn(columns[3], "N m", Role::auxiliary, Interpolation::linear);
  expectColumn(columns[4], "s", Role::auxiliary, Interpolation::none);
}

TEST(ColumnConventionsTest, TheToolPoseIsAStateWithAnOrientation) {
  const auto columns = describeColumns({"ee_x", "ee_y", "ee_z", "ee_qx", "ee_qy", "ee_qz", "ee_qw"});
  for (int i = 0; i < 3; ++i) {
    expectColumn(columns[i], "m", Role::state, Interpolation::linear);
  }
  for (int i = 3; i < 7; ++i) {
    expectColumn(columns[i], "", Role::state, Interpolation::slerp);
  }
}

TEST(ColumnConventionsTest, TheDefaultCommandIsAControlInForceUntilReplaced) {
  const auto columns = describeColumns({"u_vx", "u_wz", "u_elbow", "u_age"});
  expectColumn(columns[0], "m/s", Role::control, Interpolation::hold);
  expectColumn(columns[1], "rad/s", Role::control, Interpolation::hold);
  expectColumn(columns[2], "", Role::control, Interpolation::hold);
  expectColumn(columns[3], "s", Role::auxiliary, Interpolation::none);
}

TEST(ColumnConventionsTest, ColumnsBesideAnAgeAreAStreamInForceUntilReplaced) {
  const auto columns = describeColumns({"hand_x", "hand_age", "pad_axis0", "pad_button11", "pad_age", "target_elbow",
                                        "target_age", "wrist_ft_fx", "wrist_ft_tz", "wrist_ft_age"});
  expectColumn(columns[0], "m", Role::control, Interpolation::hold);
  expectColumn(columns[1], "s", Role::auxiliary, Interpolation::none);
  expectColumn(columns[2], "", Role::auxiliary, Interpolation::hold);
  expectColumn(columns[3], "", Role::auxiliary, Interpolation::hold);
  expectColumn(columns[5], "", Role::control, Interpolation::hold);
  expectColumn(columns[7], "N", Role::auxiliary, Interpolation::hold);
  expectColumn(columns[8], "N m", Role::auxiliary, Interpolation::hold);
}

TEST(ColumnConventionsTest, WithoutAnAgeAPoseIsAMeasurement) {
  const auto columns = describeColumns({"cup_x", "cup_qx", "cup_qy", "cup_qz", "cup_qw", "cup_vx"});
  expectColumn(columns[0], "m", Role::auxiliary, Interpolation::linear);
  expectColumn(columns[1], "", Role::auxiliary, Interpolation::slerp);
  expectColumn(columns[4], "", Role::auxiliary, Interpolation::slerp);
  expectColumn(columns[5], "m/s", Role::auxiliary, Interpolation::linear);
}

TEST(ColumnConventionsTest, AQuaternionNeedsItsFourComponentsInARow) {
  const auto columns = describeColumns({"hand_qx", "hand_qy", "hand_qw", "hand_qz"});
  for (const Column& column : columns) {
    expectColumn(column, "", Role::auxiliary, Interpolation::none);
  }
}

TEST(ColumnConventionsTest, ANameThatSaysNothingIsAuxiliary) {
  expectColumn(describeColumns({"temperature"})[0], "", Role::auxiliary, Interpolation::none);
  expectColumn(describeColumns({"axis"})[0], "", Role::auxiliary, Interpolation::none);
}

}  // namespace
}  // namespace demo_logger
