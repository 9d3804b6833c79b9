#include "demo_logger/recording/episode_writer.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>
#include <random>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/eventually.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {
namespace {

TEST(EpisodeWriterTest, WhatIsWrittenStandsInTheFileAndInItsSidecar) {
  const RecordingDirectory directory;
  Metadata metadata;
  metadata.task = "pour";
  EpisodeWriter writer(directory.path(), jointColumns(), metadata);
  EXPECT_EQ(writer.id(), "demo_000001");
  EXPECT_EQ(writer.file(), directory / "demo_000001.csv");
  for (std::uint64_t k = 0; k < 1001; ++k) {
    writer.write(knownRow(k));
  }
  EXPECT_EQ(writer.rows(), 1001U);
  metadata.outcome = "success";
  const std::filesystem::path file = writer.finish(metadata);

  EXPECT_EQ(file, directory / "demo_000001.csv");
  EXPECT_EQ(directory.listing(), "demo_000001.csv demo_000001.json");
  const Table table = readTable(file);
  EXPECT_EQ(table.header, "time,q_joint0,q_joint1");
  expectKnownRows(table, 0, 1001);
  const Sidecar sidecar = readSidecar(directory / "demo_000001.json");
  EXPECT_EQ(sidecar.metadata.id, "demo_000001");
  EXPECT_EQ(sidecar.metadata.task, "pour");
  EXPECT_EQ(sidecar.metadata.outcome, "success");
  EXPECT_EQ(sidecar.metadata.status, "complete");
  EXPECT_EQ(sidecar.metadata.rows, 1001U);
  EXPECT_EQ(sidecar.metadata.duration, 1.0);
  EXPECT_EQ(sidecar.metadata.start_stamp, kStart);
  EXPECT_EQ(sidecar.metadata.counters.at("rows_not_written"), 0U);
  EXPECT_TRUE(sidecar.metadata.faults.empty());
  ASSERT_EQ(sidecar.columns.size(), 2U);
  EXPECT_EQ(sidecar.columns[1].name, "q_joint1");
}

TEST(EpisodeWriterTest, RandomNumbersReadBackBitEqualAndMissingOnesAsNaN) {
  const RecordingDirectory directory;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-300, 300);
  EpisodeWriter writer(directory.path(), jointColumns(3), Metadata{});
  std::vector<Row> rows;
  for (std::uint64_t k = 0; k < 5000; ++k) {
    Row row = knownRow(k, 0);
    row.values = {std::pow(10.0, exponent(random)), -std::numeric_limits<double>::quiet_NaN(), exponent(random)};
    writer.write(row);
    rows.push_back(row);
  }
  const Table table = readTable(writer.finish(Metadata{}));
  ASSERT_EQ(table.rows.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    EXPECT_EQ(table.rows[k][1], rows[k].values[0]);
    EXPECT_TRUE(std::isnan(table.rows[k][2]));
    EXPECT_EQ(table.rows[k][3], rows[k].values[2]);
  }
}

TEST(EpisodeWriterTest, AValueThatARowLacksIsMissingAndASurplusOneIsLeftOut) {
  const RecordingDirectory directory;
  EpisodeWriter writer(directory.path(), jointColumns(2), Metadata{});
  writer.write(knownRow(0, 1));
  writer.write(knownRow(1, 3));
  EXPECT_EQ(readFile(writer.finish(Metadata{})), "time,q_joint0,q_joint1\n0,0,NaN\n0.001,1,1.001\n");
}

TEST(EpisodeWriterTest, WithoutFinishTheEpisodeIsClosedAsInterrupted) {
  const RecordingDirectory directory;
  {
    EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
    writer.write(knownRow(0));
  }
  EXPECT_EQ(directory.listing(), "demo_000001.csv demo_000001.json");
  EXPECT_EQ(readSidecar(directory / "demo_000001.json").metadata.status, "interrupted: not finished");
}

TEST(EpisodeWriterTest, AnEpisodeWithoutARowLeavesNothingBehind) {
  const RecordingDirectory directory;
  EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
  EXPECT_EQ(writer.finish(Metadata{}), "");
  EXPECT_EQ(directory.listing(), "");
}

TEST(EpisodeWriterTest, TwoWritersTakingTurnsInOneDirectoryKeepTheirRowsApart) {
  const RecordingDirectory directory;
  EpisodeWriter first(directory.path(), jointColumns(), Metadata{});
  EpisodeWriter second(directory.path(), jointColumns(), Metadata{});
  for (std::uint64_t k = 0; k < 300; ++k) {
    first.write(knownRow(k));
    second.write(knownRow(1000 + k));
  }
  const std::filesystem::path second_file = second.finish(Metadata{});
  const std::filesystem::path first_file = first.finish(Metadata{});
  expectKnownRows(readTable(first_file), 0, 300);
  expectKnownRows(readTable(second_file), 1000, 300);
}

TEST(EpisodeWriterTest, AFinalNameTakenMeanwhileIsNotOverwrittenButTheNextFreeOneIsUsed) {
  for (const char* intruder : {"demo_000001.csv", "demo_000001.json"}) {
    const RecordingDirectory directory;
    EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
    writer.write(knownRow(0));
    writeFile(directory / intruder, "of someone else");
    EXPECT_EQ(writer.finish(Metadata{}), directory / "demo_000002.csv");
    EXPECT_EQ(readFile(directory / intruder), "of someone else");
    EXPECT_EQ(directory.listing(), intruder + std::string(" demo_000002.csv demo_000002.json"));
    EXPECT_EQ(readSidecar(directory / "demo_000002.json").metadata.id, "demo_000002");
  }
}

TEST(EpisodeWriterTest, FinalFilesAreReadableByOwnerAndGroupOnly) {
  const RecordingDirectory directory;
  const mode_t mask = ::umask(0);
  {
    EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
    writer.write(knownRow(0));
    writer.finish(Metadata{});
  }
  ::umask(mask);
  for (const char* name : {"demo_000001.csv", "demo_000001.json"}) {
    struct stat status {};
    ASSERT_EQ(::stat((directory / name).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0640U) << name;
    EXPECT_LE(status.st_blocks * 512, 4096) << name << " keeps room that nothing will fill";
  }
}

TEST(EpisodeWriterTest, WhileItIsOpenAReaderSeesWholeRowsAndAWholeSidecarOnly) {
  const RecordingDirectory directory;
  EpisodeWriterOptions options;
  options.flush_interval = 0.001;
  options.sync_interval = 0.001;
  EpisodeWriter writer(EpisodeReservation(directory.path()), jointColumns(7), Metadata{}, options);
  const std::filesystem::path data = directory / "demo_000001.csv.part";
  const std::filesystem::path sidecar = directory / "demo_000001.json.part";
  std::uint64_t k = 0;
  std::size_t rows_seen = 0;
  const bool grew = eventually([&] {
    writer.write(knownRow(k++, 7));
    const std::string text = readFile(data);
    EXPECT_TRUE(text.empty() || text.back() == '\n');
    const std::string json = readFile(sidecar);
    if (!json.empty()) {
      const Sidecar read = parseSidecar(json, sidecar.string());
      EXPECT_EQ(read.metadata.status, "interrupted: not finished");
      rows_seen = read.metadata.rows;
    }
    return rows_seen > 100;
  });
  EXPECT_TRUE(grew) << "the sidecar speaks of " << rows_seen << " rows only";
  EXPECT_GT(writer.bytes(), 0U);
  EXPECT_TRUE(writer.bytesFree().has_value());
}

TEST(EpisodeWriterTest, TheLatestMetadataAreOnDiskBeforeTheEpisodeEnds) {
  const RecordingDirectory directory;
  EpisodeWriterOptions options;
  options.sync_interval = 0.01;
  EpisodeWriter writer(EpisodeReservation(directory.path()), jointColumns(), Metadata{}, options);
  Metadata metadata;
  metadata.counters["late_rows"] = 42;
  writer.update(metadata);
  EXPECT_TRUE(eventually([&] {
    const std::string json = readFile(directory / "demo_000001.json.part");
    return !json.empty() && parseSidecar(json, "sidecar").metadata.counters.count("late_rows") == 1;
  }));
}

}  // namespace
}  // namespace demo_logger
