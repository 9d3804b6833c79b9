#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <random>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/eventually.h"
#include "test/recording/faulty_file_system.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {
namespace {

/// Intervals so short that a test needs not wait, and a disk that does as it is told.
class DiskFaultsTest : public testing::Test {
 protected:
  EpisodeWriterOptions options() const {
    EpisodeWriterOptions options;
    options.flush_interval = 0.001;
    options.sync_interval = 0.005;
    options.retry_interval = 0.002;
    return options;
  }
  std::unique_ptr<EpisodeWriter> makeWriter(const EpisodeWriterOptions& options) {
    return std::make_unique<EpisodeWriter>(EpisodeReservation(directory_.path(), &disk_), jointColumns(), Metadata{},
                                           options);
  }
  Metadata savedMetadata() const { return readSidecar(directory_ / "demo_000001.json").metadata; }

  RecordingDirectory directory_;
  FaultyFileSystem disk_;
};

TEST_F(DiskFaultsTest, InterruptedAndShortWritesLoseNothing) {
  disk_.interrupts = true;
  disk_.longest_write = 7;
  const auto writer = makeWriter(options());
  for (std::uint64_t k = 0; k < 500; ++k) {
    writer->write(knownRow(k));
  }
  const std::filesystem::path file = writer->finish(Metadata{});
  expectKnownRows(readTable(file), 0, 500);
  EXPECT_EQ(savedMetadata().counters.at("rows_not_written"), 0U);
  EXPECT_TRUE(savedMetadata().faults.empty());
}

TEST_F(DiskFaultsTest, AFullDiskIsNamedWithItsPathAndTheBytesFreeAndRowsWaitUntilThereIsRoom) {
  const auto writer = makeWriter(options());
  writer->write(knownRow(0));
  ASSERT_TRUE(eventually([&] { return writer->bytes() > 0; }));
  disk_.room = 0;
  for (std::uint64_t k = 1; k < 100; ++k) {
    writer->write(knownRow(k));
  }
  ASSERT_TRUE(eventually([&] { return writer->fault().value_or("").find(".csv.part") != std::string::npos; }));
  EXPECT_EQ(writer->fault()->find("disk full: " + (directory_ / "demo_000001.csv.part").string() +
                                  " takes no more rows (No space left on device, 0 bytes free); what is in it stays "
                                  "readable"),
            0U)
      << *writer->fault();

  disk_.room = 1'000'000;
  ASSERT_TRUE(eventually([&] { return !writer->fault(); })) << *writer->fault();
  const std::filesystem::path file = writer->finish(Metadata{});
  expectKnownRows(readTable(file), 0, 100);
  const Metadata metadata = savedMetadata();
  EXPECT_EQ(metadata.rows, 100U);
  EXPECT_EQ(metadata.counters.at("rows_not_written"), 0U);
  ASSERT_FALSE(metadata.faults.empty()) << "a fault that is over must not be hidden";
  EXPECT_GE(metadata.faults[0].stamp, kStart);
}

TEST_F(DiskFaultsTest, WhereverTheDiskIsFullTheFileHoldsWholeRowsAndTheOthersAreCounted) {
  std::mt19937 random(11);
  for (int run = 0; run < 40; ++run) {
    RecordingDirectory directory;
    FaultyFileSystem disk;
    EpisodeReservation reservation(directory.path(), &disk);
    EpisodeWriterOptions never_synced = options();
    never_synced.sync_interval = 1000.0;
    EpisodeWriter writer(std::move(reservation), jointColumns(), Metadata{}, never_synced);
    ASSERT_TRUE(eventually([&] { return std::filesystem::file_size(directory / "demo_000001.json.part") > 0; }));
    disk.room = std::uniform_int_distribution<int>(40, 3000)(random);
    disk.longest_write = std::uniform_int_distribution<std::size_t>(1, 200)(random);
    for (std::uint64_t k = 0; k < 300; ++k) {
      writer.write(knownRow(k));
    }
    const std::filesystem::path file = writer.finish(Metadata{});
    const std::string text = readFile(file);
    ASSERT_EQ(text.back(), '\n');
    const Table table = readTable(file);
    EXPECT_LT(table.rows.size(), 300U);
    expectKnownRows(table, 0, table.rows.size());
    EXPECT_EQ(table.rows.size() + writer.rowsNotWritten(), 300U);
  }
}

TEST_F(DiskFaultsTest, RowsBeyondTheBoundedQueueAreCountedAsNotWritten) {
  EpisodeWriterOptions small = options();
  small.queue_bytes = 50 * (sizeof(Nanoseconds) + 2 * sizeof(double));  // 50 rows
  const auto writer = makeWriter(small);
  writer->write(knownRow(0));
  ASSERT_TRUE(eventually([&] { return writer->bytes() > 0; }));
  disk_.write_error = EIO;
  for (std::uint64_t k = 1; k <= 80; ++k) {
    writer->write(knownRow(k));
  }
  EXPECT_EQ(writer->rows(), 81U);
  EXPECT_EQ(writer->rowsNotWritten(), 30U) << "80 rows came while 50 had room";
  ASSERT_TRUE(eventually([&] { return writer->fault().has_value(); }));
  EXPECT_EQ(writer->fault()->find("disk error: "), 0U) << *writer->fault();
  EXPECT_NE(writer->fault()->find("Input/output error"), std::string::npos) << *writer->fault();
  disk_.write_error = 0;
  ASSERT_TRUE(eventually([&] { return !writer->fault(); }));
  expectKnownRows(readTable(writer->finish(Metadata{})), 0, 51);
  EXPECT_EQ(savedMetadata().counters.at("rows_not_written"), 30U);
}

TEST_F(DiskFaultsTest, GivingRowsNeverWaitsForADiskThatHangs) {
  disk_.writes_hang = true;
  disk_.syncs_hang = true;
  const auto writer = makeWriter(options());
  for (std::uint64_t k = 0; k < 10000; ++k) {
    writer->write(knownRow(k));  // were one of them to wait for the disk, this would never end
    writer->update(Metadata{});
  }
  EXPECT_EQ(writer->rows(), 10000U);
  EXPECT_EQ(writer->bytes(), 0U);
  EXPECT_FALSE(writer->fault());
  disk_.writes_hang = false;
  disk_.syncs_hang = false;
  expectKnownRows(readTable(writer->finish(Metadata{})), 0, 10000);
}

TEST_F(DiskFaultsTest, ASyncThatHangsDelaysNoWrite) {
  disk_.syncs_hang = true;
  const auto writer = makeWriter(options());
  std::uint64_t bytes = 0;
  for (std::uint64_t k = 0; k < 20; ++k) {
    writer->write(knownRow(k));
    EXPECT_TRUE(eventually([&] { return writer->bytes() > bytes; })) << "row " << k << " waits for the sync";
    bytes = writer->bytes();
  }
  disk_.syncs_hang = false;
}

TEST_F(DiskFaultsTest, ASourceThatMayWaitLosesNothingToASlowDiskAndDoesNotHangOnAFullOne) {
  EpisodeWriterOptions patient = options();
  patient.queue_bytes = 5 * (sizeof(Nanoseconds) + 2 * sizeof(double));  // 5 rows
  patient.may_wait = true;
  const auto writer = makeWriter(patient);
  for (std::uint64_t k = 0; k < 100; ++k) {
    writer->write(knownRow(k));
  }
  EXPECT_EQ(writer->rowsNotWritten(), 0U);
  disk_.room = 0;
  for (std::uint64_t k = 100; k < 200; ++k) {
    writer->write(knownRow(k));
  }
  EXPECT_GE(writer->rowsNotWritten(), 90U);
  disk_.room = 1'000'000;
  const Table table = readTable(writer->finish(Metadata{}));
  EXPECT_EQ(table.rows.size() + writer->rowsNotWritten(), 200U);
}

TEST_F(DiskFaultsTest, AnEpisodeOfWhichNothingCouldBeWrittenSaysSoAndLeavesNothing) {
  disk_.room = 0;
  const auto writer = makeWriter(options());
  writer->write(knownRow(0));
  try {
    writer->finish(Metadata{});
    FAIL() << "expected a FileError";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()).find("demo_000001: none of its 1 rows could be written. disk full: "), 0U)
        << error.what();
  }
  EXPECT_EQ(directory_.listing(), "");
}

TEST_F(DiskFaultsTest, AFileThatIsRemovedWhileItIsRecordedIsReportedAtOnce) {
  const auto writer = makeWriter(options());
  writer->write(knownRow(0));
  ASSERT_TRUE(eventually([&] { return writer->bytes() > 0; }));
  EXPECT_FALSE(writer->fault());
  const std::filesystem::path part = directory_ / "demo_000001.csv.part";
  std::filesystem::remove(part);
  ASSERT_TRUE(eventually([&] { return writer->fault().has_value(); }));
  EXPECT_EQ(*writer->fault(), part.string() +
                                  " has been removed or replaced while it is recorded: its rows are lost when the "
                                  "episode ends. Stop now and start again.");
  EXPECT_THROW(writer->finish(Metadata{}), FileError);
}

TEST_F(DiskFaultsTest, AFailingSyncIsReportedAndRecordingGoesOn) {
  const auto writer = makeWriter(options());
  disk_.sync_error = EIO;
  writer->write(knownRow(0));
  const auto isNamed = [](const std::vector<Fault>& faults) {
    return std::any_of(faults.begin(), faults.end(), [](const Fault& fault) {
      return fault.what.find("could not be synced (Input/output error)") != std::string::npos;
    });
  };
  ASSERT_TRUE(eventually([&] { return isNamed(writer->faults()); }));
  writer->write(knownRow(1));
  disk_.sync_error = 0;
  expectKnownRows(readTable(writer->finish(Metadata{})), 0, 2);
  EXPECT_TRUE(isNamed(savedMetadata().faults));
}

TEST_F(DiskFaultsTest, WhenTheRenameFailsTheSentenceNamesBothFilesAndThePartStays) {
  const auto writer = makeWriter(options());
  writer->write(knownRow(0));
  disk_.rename_error = EIO;
  try {
    writer->finish(Metadata{});
    FAIL() << "expected a FileError";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()),
              (directory_ / "demo_000001.csv.part").string() +
                  " cannot be renamed to demo_000001.csv: Input/output error. Its rows are whole; `demo_tool recover` "
                  "will finish it.");
  }
  EXPECT_EQ(directory_.listing(), "demo_000001.csv.part demo_000001.json.part");
}

TEST_F(DiskFaultsTest, AFinalNameTakenAtTheMomentOfTheRenameIsNotOverwritten) {
  for (const char* intruder : {"demo_000001.csv", "demo_000001.json"}) {
    const RecordingDirectory directory;
    EpisodeWriter writer(EpisodeReservation(directory.path(), &disk_), jointColumns(), Metadata{}, options());
    writer.write(knownRow(0));
    writeFile(directory / intruder, "of someone else");
    disk_.sees_no_file = true;
    EXPECT_EQ(writer.finish(Metadata{}), directory / "demo_000002.csv");
    disk_.sees_no_file = false;
    EXPECT_EQ(readFile(directory / intruder), "of someone else");
    EXPECT_EQ(directory.listing(), intruder + std::string(" demo_000002.csv demo_000002.json"));
    EXPECT_EQ(readSidecar(directory / "demo_000002.json").metadata.id, "demo_000002");
  }
}

TEST_F(DiskFaultsTest, ARealSmallDiskThatRunsFullKeepsWholeRowsAndTheSidecarTellsTheLoss) {
  const std::filesystem::path disk = directory_ / "small_disk";
  std::filesystem::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "mounting a tmpfs of 256 KiB is not permitted here";
  }
  struct Unmount {
    std::filesystem::path disk;
    ~Unmount() { ::umount(disk.c_str()); }
  } unmount{disk};
  const std::filesystem::path ballast = disk / "ballast";
  writeFile(ballast, std::string(100 * 1024, 'x'));

  EpisodeWriter writer(EpisodeReservation(disk), jointColumns(), Metadata{}, options());
  std::uint64_t given = 0;
  ASSERT_TRUE(eventually([&] {
    for (int i = 0; i < 100; ++i) {
      writer.write(knownRow(given++));
    }
    return writer.fault().has_value();
  }));
  EXPECT_EQ(writer.fault()->find("disk full: "), 0U) << *writer.fault();

  std::filesystem::remove(ballast);  // the user makes room
  ASSERT_TRUE(eventually([&] { return !writer.fault(); })) << *writer.fault();
  while (given < 20000) {  // 20000 rows need some 400 KiB
    writer.write(knownRow(given++));
  }
  const std::filesystem::path file = writer.finish(Metadata{});
  const Table table = readTable(file);
  EXPECT_GT(table.rows.size(), 1000U);
  expectKnownRows(table, 0, table.rows.size());
  const Metadata metadata = readSidecar(disk / "demo_000001.json").metadata;
  EXPECT_EQ(metadata.status, "complete");
  EXPECT_EQ(metadata.rows, table.rows.size());
  EXPECT_EQ(metadata.counters.at("rows_not_written"), given - table.rows.size());
  EXPECT_FALSE(metadata.faults.empty());
}

}  // namespace
}  // namespace demo_logger
