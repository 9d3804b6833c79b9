#include "demo_logger/recording/episode_reservation.h"

#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>
#include <set>

#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "src/recording/episode_name.h"
#include "src/recording/file_system.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {
namespace {

std::string messageOf(const std::filesystem::path& directory) {
  try {
    EpisodeReservation reservation(directory);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(EpisodeReservationTest, TheFirstEpisodeOfADirectoryIsNumberOneAndTheDirectoryIsCreated) {
  const RecordingDirectory directory;
  const EpisodeReservation reservation(directory / "new/demos");
  EXPECT_EQ(reservation.id(), "demo_000001");
  EXPECT_EQ(reservation.file(), directory / "new/demos/demo_000001.csv");
  EXPECT_EQ(directory.listing("new/demos"), "demo_000001.csv.part demo_000001.json.part");
}

TEST(EpisodeReservationTest, AReservationThatIsGivenBackLeavesNothingBehind) {
  const RecordingDirectory directory;
  { const EpisodeReservation reservation(directory.path()); }
  EXPECT_EQ(directory.listing(), "");
}

TEST(EpisodeReservationTest, NumbersGoOnBehindTheHighestAndNeverFillAGap) {
  const RecordingDirectory directory;
  writeFile(directory / "demo_000002.csv", "");
  writeFile(directory / "demo_000017.json", "");
  writeFile(directory / "demo_12.csv", "");
  writeFile(directory / "demo_000099_copy.csv", "");
  EXPECT_EQ(EpisodeReservation(directory.path()).id(), "demo_000018");
}

TEST(EpisodeReservationTest, ADiscardedEpisodeKeepsItsNumber) {
  const RecordingDirectory directory;
  std::filesystem::create_directory(directory / "discarded");
  writeFile(directory / "discarded/demo_000004.csv", "");
  EXPECT_EQ(EpisodeReservation(directory.path()).id(), "demo_000005");
}

TEST(EpisodeReservationTest, NumbersBeyondAMillionHaveMoreDigits) {
  const RecordingDirectory directory;
  writeFile(directory / "demo_999999.csv", "");
  EXPECT_EQ(EpisodeReservation(directory.path()).id(), "demo_1000000");
}

TEST(EpisodeReservationTest, TwoRecordersInOneDirectoryGetDifferentNumbers) {
  const RecordingDirectory directory;
  const EpisodeReservation first(directory.path());
  const EpisodeReservation second(directory.path());
  EXPECT_EQ(first.id(), "demo_000001");
  EXPECT_EQ(second.id(), "demo_000002");
}

TEST(EpisodeReservationTest, ManyProcessesAtOnceNeverShareANumber) {
  constexpr int kProcesses = 4;
  constexpr int kEpisodes = 25;
  const RecordingDirectory directory;
  for (int process = 0; process < kProcesses; ++process) {
    if (::fork() == 0) {
      for (int episode = 0; episode < kEpisodes; ++episode) {
        EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
        writer.write(knownRow(static_cast<std::uint64_t>(process)));
        writer.finish(Metadata{});
      }
      ::_exit(0);
    }
  }
  for (int process = 0; process < kProcesses; ++process) {
    int status = -1;
    ::wait(&status);
    EXPECT_EQ(status, 0);
  }
  std::vector<int> episodes_of(kProcesses, 0);
  for (const auto& entry : std::filesystem::directory_iterator(directory.path())) {
    if (entry.path().extension() == ".csv") {
      const Table table = readTable(entry.path());
      ASSERT_EQ(table.rows.size(), 1U) << entry.path();
      ++episodes_of[static_cast<std::size_t>(table.rows[0][1])];
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(entry.path()).replace_extension(".json")));
    }
  }
  EXPECT_EQ(episodes_of, std::vector<int>(kProcesses, kEpisodes)) << "an episode was overwritten";
}

TEST(EpisodeReservationTest, BothPartsAreHeldUnderAnExclusiveLockAndAreNotForEveryonesEyes) {
  const RecordingDirectory directory;
  const mode_t mask = ::umask(0);
  const EpisodeReservation reservation(directory.path());
  ::umask(mask);
  for (const char* name : {"demo_000001.csv.part", "demo_000001.json.part"}) {
    const FileDescriptor other(operatingSystem(), operatingSystem().open(directory / name));
    EXPECT_EQ(operatingSystem().lock(other.get()), -EWOULDBLOCK) << name;
    struct stat status {};
    ASSERT_EQ(::stat((directory / name).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640U) << name;
  }
}

TEST(EpisodeReservationTest, ASymbolicLinkInThePlaceOfAPartIsNeverFollowed) {
  const RecordingDirectory directory;
  const std::filesystem::path victim = directory / "victim";
  std::filesystem::create_symlink(victim, directory / "demo_000001.csv.part");
  EXPECT_EQ(operatingSystem().create(directory / "demo_000001.csv.part"), -EEXIST);
  EXPECT_EQ(operatingSystem().open(directory / "demo_000001.csv.part"), -ELOOP);

  EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
  writer.write(knownRow(0));
  EXPECT_EQ(writer.finish(Metadata{}).filename(), "demo_000002.csv");
  EXPECT_FALSE(std::filesystem::exists(victim));
}

TEST(EpisodeReservationTest, AFileInThePlaceOfTheDirectoryIsNamed) {
  const RecordingDirectory directory;
  writeFile(directory / "demos", "");
  EXPECT_EQ(messageOf(directory / "demos"), (directory / "demos").string() +
                                                ": there is a file of that name, expected a directory for the "
                                                "recordings. Remove it or choose another output directory.");
  EXPECT_EQ(messageOf(directory / "demos/below"), (directory / "demos/below").string() +
                                                      ": there is a file of that name, expected a directory for the "
                                                      "recordings. Remove it or choose another output directory.");
}

/// Runs `action` as somebody who may not write everywhere, as root may.
template <typename Action>
void asOrdinaryUser(Action action) {
  constexpr uid_t kNobody = 65534;
  const bool is_root = ::geteuid() == 0;
  if (is_root) {
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  action();
  if (is_root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
}

TEST(EpisodeReservationTest, ADirectoryThatCannotBeWrittenToIsNamedWithTheReason) {
  const RecordingDirectory directory;
  std::filesystem::permissions(directory.path(), std::filesystem::perms(0555));
  asOrdinaryUser([&] {
    EXPECT_EQ(messageOf(directory.path()), (directory / "demo_000001.csv.part").string() +
                                               " cannot be created: Permission denied. Recordings need a directory "
                                               "that can be written to; choose another output directory.");
    EXPECT_EQ(messageOf(directory / "demos"), (directory / "demos").string() +
                                                  ": the directory for the recordings cannot be created: Permission "
                                                  "denied. Choose another output directory.");
  });
  std::filesystem::permissions(directory.path(), std::filesystem::perms(0755));
}

}  // namespace
}  // namespace demo_logger
