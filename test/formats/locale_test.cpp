#include <gtest/gtest.h>

#include <clocale>
#include <cstdio>
#include <locale>

#include "demo_logger/formats/demonstration_file.h"
#include "test/formats/temporary_folder.h"

namespace demo_logger {
namespace {

// German, for C and C++ alike: decimal comma, points between thousands.
class LocaleTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_NE(std::setlocale(LC_ALL, "de_DE.UTF-8"), nullptr) << "install the package locales-all";
    std::locale::global(std::locale("de_DE.UTF-8"));
    char text[8];
    std::snprintf(text, sizeof(text), "%.1f", 0.5);
    ASSERT_STREQ(text, "0,5") << "the locale must really be in force, or this test shows nothing";
  }
  void TearDown() override {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
  }
};

TEST_F(LocaleTest, FilesAreTheSameInGermany) {
  Demonstration demonstration;
  demonstration.columns = {{"q_elbow", "rad", Role::state, Interpolation::linear, ""}};
  demonstration.time = {0.0, 1234.5};
  demonstration.values.resize(2, 1);
  demonstration.values << 0.1, 1234567.891;
  demonstration.metadata.start_stamp = 1'600'000'000'500'000'000;
  demonstration.metadata.effort.control_period = 0.001;
  const TemporaryFolder folder;
  const auto csv = folder.path() / "a.csv";
  writeDemonstration(csv, demonstration);

  EXPECT_EQ(TemporaryFolder::read(csv), "time,q_elbow\n0,0.1\n1234.5,1234567.891\n");
  const std::string json = TemporaryFolder::read(folder.path() / "a.json");
  EXPECT_NE(json.find("\"control_period\": 0.001"), std::string::npos);
  EXPECT_NE(json.find("\"secs\": 1600000000"), std::string::npos);

  const Demonstration back = readDemonstration(csv).demonstration;
  EXPECT_EQ(back.time, demonstration.time);
  EXPECT_EQ(back.values, demonstration.values);
  EXPECT_EQ(back.metadata.effort.control_period, 0.001);
}

}  // namespace
}  // namespace demo_logger
