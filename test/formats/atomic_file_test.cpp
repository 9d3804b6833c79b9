#include "demo_logger/formats/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "demo_logger/trajectory/error.h"
#include "test/formats/temporary_folder.h"

namespace demo_logger {
namespace {

TEST(AtomicFileTest, TheFileAppearsWithCommitAndNotBefore) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.json";
  {
    AtomicFile file(path, /*overwrite=*/false);
    file.write("{");
    file.write("}");
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  EXPECT_EQ(TemporaryFolder::read(path), "{}");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFileTest, WhatIsNoFileIsNotReplaced) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  try {
    AtomicFile(path, /*overwrite=*/true);
    FAIL() << "a pipe was replaced";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(),
              path.string() + ": is a device or the like, not a file that can be replaced; choose another name.");
  }
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST(AtomicFileTest, WithoutCommitNothingIsLeft) {
  const TemporaryFolder folder;
  { AtomicFile(folder.path() / "a.json", false).write("half"); }
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(AtomicFileTest, AFileThatAppearsMeanwhileIsNotReplaced) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.json";
  {
    AtomicFile file(path, false);
    file.write("late");
    folder.write("a.json", "first");
    EXPECT_THROW(file.commit(), FileError);
  }
  EXPECT_EQ(TemporaryFolder::read(path), "first");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFileTest, OfSeveralFilesNoneIsThereIfOneCannotBe) {
  const TemporaryFolder folder;
  folder.write("b", "old");
  AtomicFiles files;
  for (const char* name : {"a", "b", "c"}) files.add(folder.path() / name, /*overwrite=*/name[0] == 'b').write(name);
  folder.write("c", "first");  // meanwhile
  EXPECT_THROW(files.commit(), FileError);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a"));
  EXPECT_EQ(TemporaryFolder::read(folder.path() / "b"), "b") << "what it replaced is gone";
  EXPECT_EQ(TemporaryFolder::read(folder.path() / "c"), "first");

  AtomicFiles others;
  for (const char* name : {"d", "e"}) others.add(folder.path() / name, false).write(name);
  others.commit();
  EXPECT_EQ(TemporaryFolder::read(folder.path() / "d"), "d");
  EXPECT_EQ(TemporaryFolder::read(folder.path() / "e"), "e");
}

TEST(AtomicFileTest, SeveralFilesMayBeMoreThanAProcessMayHaveOpen) {
  const TemporaryFolder folder;
  rlimit usual = {};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  rlimit few = usual;
  few.rlim_cur = 20;
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  std::string message;
  try {
    AtomicFiles files;
    for (int i = 0; i < 100; ++i) files.add(folder.path() / std::to_string(i), false).write("x");
    files.commit();
  } catch (const FileError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_NOFILE, &usual);
  EXPECT_EQ(message, "");
  EXPECT_EQ(folder.entries(), 100U);
}

TEST(AtomicFileTest, AWriteThatFailsIsToldAndLeavesTheOldFile) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.csv", "old");
  rlimit unlimited = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limited = unlimited;
  limited.rlim_cur = 1000;  // bytes: like a disk that is full after them
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limited), 0);
  std::string message = "no error";
  try {
    writeFileAtomically(path, std::string(5000, 'x'), /*overwrite=*/true);
  } catch (const FileError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(message, path.string() + ": cannot be written (File too large); nothing was left behind.");
  EXPECT_EQ(TemporaryFolder::read(path), "old");
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(AtomicFileTest, ADirectoryIsNoFile) {
  const TemporaryFolder folder;
  try {
    writeFileAtomically(folder.path(), "x", true);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), folder.path().string() + ": is a directory; expected the name of a file to write.");
  }
}

TEST(AtomicFileTest, RenamingNeverReplacesAFile) {
  const TemporaryFolder folder;
  const auto from = folder.write("a.part", "new");
  const auto to = folder.write("a", "old");
  try {
    renameWithoutReplacing(from, to);
    FAIL();
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(),
              to.string() + ": exists already and is not overwritten; choose another name or ask to overwrite.");
  }
  EXPECT_EQ(TemporaryFolder::read(to), "old");
  renameWithoutReplacing(from, folder.path() / "b");
  EXPECT_EQ(TemporaryFolder::read(folder.path() / "b"), "new");
}

}  // namespace
}  // namespace demo_logger
