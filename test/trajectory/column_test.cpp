#include "demo_logger/trajectory/column.h"

#include <gtest/gtest.h>

namespace demo_logger {
namespace {

TEST(ColumnTest, EveryRoleAndInterpolationIsFoundAgainByItsWord) {
  for (const Role role : {Role::state, Role::control, Role::auxiliary}) {
    EXPECT_EQ(roleFromString(toString(role)), role);
  }
  for (const Interpolation interpolation :
       {Interpolation::linear, Interpolation::slerp, Interpolation::hold, Interpolation::none}) {
    EXPECT_EQ(interpolationFromString(toString(interpolation)), interpolation);
  }
}

TEST(ColumnTest, UsesTheWordsOfTheFileFormat) {
  EXPECT_STREQ(toString(Role::control), "control");
  EXPECT_STREQ(toString(Interpolation::hold), "hold");
}

TEST(ColumnTest, AnyOtherWordIsNoRoleAndNoInterpolation) {
  for (const char* word : {"", "State", "state ", "observation", "cubic"}) {
    EXPECT_EQ(roleFromString(word), std::nullopt) << word;
    EXPECT_EQ(interpolationFromString(word), std::nullopt) << word;
  }
}

}  // namespace
}  // namespace demo_logger
