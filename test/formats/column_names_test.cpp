#include "demo_logger/formats/column_names.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <set>

namespace demo_logger {
namespace {

using Names = std::vector<std::string>;

// Names that collide often: short, from few characters, some of them long.
Names anyNames() {
  const auto character = rc::gen::element('a', 'B', '_', '1', '2', '/', '.', ' ', '\n', '\xc3', '\xa9');
  return *rc::gen::container<Names>(
      rc::gen::oneOf(rc::gen::container<std::string>(character),
                     rc::gen::map(rc::gen::container<std::string>(character),
                                  [](const std::string& end) { return std::string(70, 'q') + end; }),
                     rc::gen::element<std::string>("time", "a", "a_2", "a_3", "a/2")));
}

TEST(ColumnNamesTest, OtherCharactersBecomeUnderscores) {
  EXPECT_EQ(makePortable({"q_arm/left.elbow-1"}).names, Names{"q_arm_left_elbow_1"});
  EXPECT_EQ(makePortable({"q_joint 1 (rad)"}).names, Names{"q_joint_1__rad_"});
}

TEST(ColumnNamesTest, ACharacterOfSeveralBytesBecomesOneUnderscore) {
  EXPECT_EQ(makePortable({"q_épaule"}).names, Names{"q__paule"});
}

TEST(ColumnNamesTest, ALeadingDigitAndAnEmptyNameGetAnUnderscore) {
  EXPECT_EQ(makePortable({"3rd", ""}).names, (Names{"_3rd", "_"}));
}

TEST(ColumnNamesTest, CollisionsAreNumbered) {
  EXPECT_EQ(makePortable({"a/b", "a.b", "a-b"}).names, (Names{"a_b", "a_b_2", "a_b_3"}));
}

TEST(ColumnNamesTest, ANameThatIsFineKeepsItselfAgainstOnesThatAreNot) {
  EXPECT_EQ(makePortable({"a/b", "a_b", "a_b_2"}).names, (Names{"a_b_3", "a_b", "a_b_2"}));
}

TEST(ColumnNamesTest, TimeIsTaken) { EXPECT_EQ(makePortable({"time"}).names, Names{"time_2"}); }

TEST(ColumnNamesTest, LongNamesThatDifferOnlyAtTheEndStayDifferent) {
  const std::string long_name(80, 'q');
  const PortableNames portable = makePortable({long_name + "1", long_name + "2"});
  EXPECT_EQ(portable.names[0].size(), kLongestColumnName);
  EXPECT_NE(portable.names[0], portable.names[1]);
  EXPECT_EQ(portable.names[0].substr(0, 54), std::string(54, 'q')) << "8 digits of the hash and an underscore follow";
  EXPECT_EQ(makePortable({long_name + "2"}).names[0], portable.names[1]) << "the hash depends on the name alone";
}

TEST(ColumnNamesTest, TheMappingNamesWhatChangedAndNothingElse) {
  const PortableNames portable = makePortable({"q_elbow", "q/elbow"});
  EXPECT_EQ(portable.original_names, (std::map<std::string, std::string>{{"q_elbow_2", "q/elbow"}}));
}

RC_GTEST_PROP(ColumnNamesTest, AllNamesArePortableAndUnique, ()) {
  const Names originals = anyNames();
  const Names names = makePortable(originals).names;
  RC_ASSERT(names.size() == originals.size());
  RC_ASSERT(std::set<std::string>(names.begin(), names.end()).size() == names.size());
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
  for (const std::string& name : names) {
    RC_ASSERT(name.size() >= 1U && name.size() <= 63U);
    RC_ASSERT(letters.find(name[0]) != std::string::npos);
    RC_ASSERT(name.find_first_not_of(letters + "0123456789") == std::string::npos);
    RC_ASSERT(isPortable(name));
    RC_ASSERT(name != "time");
  }
}

RC_GTEST_PROP(ColumnNamesTest, OnceIsEnough, ()) {
  const Names names = makePortable(anyNames()).names;
  const PortableNames again = makePortable(names);
  RC_ASSERT(again.names == names);
  RC_ASSERT(again.original_names.empty());
}

RC_GTEST_PROP(ColumnNamesTest, EveryOriginalCanBeFoundAgain, ()) {
  const Names originals = anyNames();
  const PortableNames portable = makePortable(originals);
  for (std::size_t i = 0; i < originals.size(); ++i) {
    const auto changed = portable.original_names.find(portable.names[i]);
    RC_ASSERT(originals[i] == (changed == portable.original_names.end() ? portable.names[i] : changed->second));
  }
}

TEST(ColumnNamesTest, LettersAreThoseOfAsciiWhateverTheLocale) {
  EXPECT_TRUE(isPortable("q_elbow"));
  for (const char* name : {"", "1st", "q elbow", "q_\xe9paule", "tête", "q-1"}) {
    EXPECT_FALSE(isPortable(name)) << name;
  }
  EXPECT_FALSE(isPortable(std::string(64, 'q')));
}

}  // namespace
}  // namespace demo_logger
