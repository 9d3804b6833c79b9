#include "demo_logger/trajectory/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {
namespace {

class RegularFileTest : public ::testing::Test {
 protected:
  RegularFileTest()
      : folder_(std::filesystem::path(testing::TempDir()) / ("regular_file_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~RegularFileTest() override { std::filesystem::remove_all(folder_); }

  std::string refusalOf(const std::string& name) const {
    try {
      requireRegularFile(folder_ / name, "a table.");
    } catch (const FileError& error) {
      return std::string(error.what()).substr(folder_.string().size() + 1);
    }
    return "taken";
  }

  const std::filesystem::path folder_;
};

TEST_F(RegularFileTest, AFileIsTakenAlsoThroughALinkAndWhatIsNotThereIsLeftToItsReader) {
  std::ofstream(folder_ / "table") << "1\n";
  std::filesystem::create_symlink("table", folder_ / "link");
  EXPECT_EQ(refusalOf("table"), "taken");
  EXPECT_EQ(refusalOf("link"), "taken");
  EXPECT_EQ(refusalOf("nothing"), "taken");
}

TEST_F(RegularFileTest, WhatMayNeverEndIsNamed) {
  std::filesystem::create_symlink("/dev/zero", folder_ / "endless");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusalOf("endless"), "endless: is a device, expected a table.");
  EXPECT_EQ(refusalOf("pipe"), "pipe: is a pipe, expected a table.");
  EXPECT_EQ(refusalOf("."), ".: is a directory, expected a table.");
}

}  // namespace
}  // namespace demo_logger
