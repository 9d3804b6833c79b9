#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {
namespace {

constexpr char kHeader[] = "time,q_joint0,q_joint1\n";

Metadata openMetadata() {
  Metadata metadata;
  metadata.id = "demo_000001";
  metadata.task = "pour";
  metadata.start_stamp = kStart;
  metadata.status = "interrupted: not finished";
  metadata.counters["late_rows"] = 3;
  return metadata;
}

TEST(RecoveryTest, CutsTheTornLastRowAndKeepsWhatTheSidecarKnew) {
  const RecordingDirectory directory;
  writeFile(directory / "demo_000001.csv.part", std::string(kHeader) + "0,1,2\n0.5,3,4\n1,5,");
  writeFile(directory / "demo_000001.json.part", sidecarText(openMetadata(), jointColumns()));
  writeFile(directory / "demo_000001.json.part.new", "{\"format\": \"demo_lo");

  const std::vector<Recovered> recovered = recover(directory.path());

  ASSERT_EQ(recovered.size(), 1U);
  EXPECT_EQ(recovered[0].file, directory / "demo_000001.csv");
  EXPECT_EQ(recovered[0].rows, 2U);
  EXPECT_EQ(recovered[0].dropped_bytes, 4U) << "the bytes of \"1,5,\"";
  EXPECT_EQ(directory.listing(), "demo_000001.csv demo_000001.json");
  EXPECT_EQ(readFile(directory / "demo_000001.csv"), std::string(kHeader) + "0,1,2\n0.5,3,4\n");
  const Metadata metadata = readSidecar(directory / "demo_000001.json").metadata;
  EXPECT_EQ(metadata.status, "interrupted: killed");
  EXPECT_EQ(metadata.rows, 2U);
  EXPECT_EQ(metadata.duration, 0.5);
  EXPECT_EQ(metadata.start_stamp, kStart);
  EXPECT_EQ(metadata.task, "pour");
  EXPECT_EQ(metadata.counters.at("late_rows"), 3U);
}

TEST(RecoveryTest, ALostOrBrokenSidecarIsRebuiltFromTheHeaderAndSaysSo) {
  for (const char* broken : {"", "{\"format\": \"demo_lo", "[]", "{\"format\": \"demo_logger/1\", \"columns\": []}"}) {
    const RecordingDirectory directory;
    writeFile(directory / "demo_000001.csv.part", std::string(kHeader) + "0,1,2\n0.25,3,4\n");
    if (*broken != '\0') {
      writeFile(directory / "demo_000001.json.part", broken);
    }
    ASSERT_EQ(recover(directory.path()).size(), 1U) << broken;
    const Sidecar sidecar = readSidecar(directory / "demo_000001.json");
    EXPECT_EQ(sidecar.metadata.id, "demo_000001");
    EXPECT_EQ(sidecar.metadata.rows, 2U);
    EXPECT_EQ(sidecar.metadata.duration, 0.25);
    EXPECT_EQ(sidecar.metadata.status, "interrupted: killed");
    ASSERT_EQ(sidecar.metadata.faults.size(), 1U);
    EXPECT_EQ(sidecar.metadata.faults[0].what.find("The sidecar was lost ("), 0U) << sidecar.metadata.faults[0].what;
    ASSERT_EQ(sidecar.columns.size(), 2U);
    EXPECT_EQ(sidecar.columns[0].unit, "rad");
    EXPECT_EQ(sidecar.columns[0].role, Role::state);
  }
}

TEST(RecoveryTest, PartsWithoutACompleteRowGoToDiscardedAndNeverOverOthers) {
  for (const std::string text : {"", "time,q_jo", kHeader, "time,q_joint0\n0,1"}) {
    const RecordingDirectory directory;
    std::filesystem::create_directory(directory / "discarded");
    writeFile(directory / "discarded/demo_000001.csv.part", "older");
    writeFile(directory / "demo_000001.csv.part", text);
    writeFile(directory / "demo_000001.json.part", "{}");
    EXPECT_TRUE(recover(directory.path()).empty());
    EXPECT_EQ(directory.listing(), "discarded");
    EXPECT_EQ(directory.listing("discarded"), "demo_000001.csv.part demo_000001_2.csv.part demo_000001_2.json.part");
    EXPECT_EQ(readFile(directory / "discarded/demo_000001.csv.part"), "older");
    EXPECT_EQ(readFile(directory / "discarded/demo_000001_2.csv.part"), text);
  }
}

TEST(RecoveryTest, WhatAPowerFailureLeavesBehindIsCutAtTheFirstDamagedRow) {
  for (const std::string& damage : {std::string("1,2\n"), std::string(4096, '\0'), std::string("0.5,1,2,3\n0.6,1,2\n"),
                                    std::string("0.5,1,x\n"), std::string("0.5,,2\n"), std::string(",1,2\n")}) {
    const RecordingDirectory directory;
    const std::string whole = std::string(kHeader) + "0,1,2\n0.25,NaN,-1e-300\n";
    writeFile(directory / "demo_000001.csv.part", whole + damage);
    ASSERT_EQ(recover(directory.path()).size(), 1U);
    EXPECT_EQ(readFile(directory / "demo_000001.csv"), whole) << damage;
  }
}

TEST(RecoveryTest, ALongRecordingIsReadInPieces) {
  const RecordingDirectory directory;
  std::string text = kHeader;
  for (int k = 0; k < 200000; ++k) {  // beyond 2 MiB
    text += std::to_string(k) + ".5,1,2\n";
  }
  writeFile(directory / "demo_000001.csv.part", text + "200000.5");
  const std::vector<Recovered> recovered = recover(directory.path());
  ASSERT_EQ(recovered.size(), 1U);
  EXPECT_EQ(recovered[0].rows, 200000U);
  EXPECT_EQ(readFile(directory / "demo_000001.csv"), text);
}

TEST(RecoveryTest, AnOpenEpisodeIsLeftAlone) {
  const RecordingDirectory directory;
  EpisodeWriter writer(directory.path(), jointColumns(), Metadata{});
  writer.write(knownRow(0));
  EXPECT_TRUE(recover(directory.path()).empty());
  EXPECT_EQ(writer.finish(Metadata{}), directory / "demo_000001.csv");
}

TEST(RecoveryTest, AKillBetweenTheTwoRenamesLeavesTheSidecarToBeRenamed) {
  const RecordingDirectory directory;
  writeFile(directory / "demo_000003.csv", std::string(kHeader) + "0,1,2\n");
  Metadata metadata = openMetadata();
  metadata.id = "demo_000003";  // the number had been taken, so that the data went to the third
  metadata.status = "complete";
  metadata.rows = 1;
  writeFile(directory / "demo_000001.json.part", sidecarText(metadata, jointColumns()));
  const std::vector<Recovered> recovered = recover(directory.path());
  ASSERT_EQ(recovered.size(), 1U);
  EXPECT_EQ(recovered[0].file, directory / "demo_000003.csv");
  EXPECT_EQ(directory.listing(), "demo_000003.csv demo_000003.json");
  EXPECT_EQ(readSidecar(directory / "demo_000003.json").metadata.status, "complete");
}

TEST(RecoveryTest, ASidecarNeverLeadsOutOfTheDirectory) {
  const RecordingDirectory directory;
  std::filesystem::create_directory(directory / "demos");
  writeFile(directory / "elsewhere.csv", kHeader);
  Metadata metadata = openMetadata();
  metadata.id = "../elsewhere";
  writeFile(directory / "demos/demo_000001.json.part", sidecarText(metadata, jointColumns()));
  EXPECT_TRUE(recover(directory / "demos").empty());
  EXPECT_EQ(directory.listing(), "demos elsewhere.csv");
  EXPECT_EQ(directory.listing("demos/discarded"), "demo_000001.json.part");
}

TEST(RecoveryTest, NothingIsOverwrittenByARecoveredEpisode) {
  const RecordingDirectory directory;
  writeFile(directory / "demo_000001.csv", "of someone else");
  writeFile(directory / "demo_000001.csv.part", std::string(kHeader) + "0,1,2\n");
  const std::vector<Recovered> recovered = recover(directory.path());
  ASSERT_EQ(recovered.size(), 1U);
  EXPECT_EQ(recovered[0].file, directory / "demo_000002.csv");
  EXPECT_EQ(readFile(directory / "demo_000001.csv"), "of someone else");
  EXPECT_EQ(readSidecar(directory / "demo_000002.json").metadata.id, "demo_000002");
}

TEST(RecoveryTest, ASymbolicLinkThatLooksLikeAPartIsNotTouched) {
  const RecordingDirectory directory;
  writeFile(directory / "victim", std::string(kHeader) + "0,1,2\n0.1,");
  std::filesystem::create_symlink("victim", directory / "demo_000001.csv.part");
  EXPECT_TRUE(recover(directory.path()).empty());
  EXPECT_EQ(readFile(directory / "victim"), std::string(kHeader) + "0,1,2\n0.1,");
}

TEST(RecoveryTest, ADirectoryThatIsNotThereYetHasNothingToRecover) {
  const RecordingDirectory directory;
  EXPECT_TRUE(recover(directory / "demos").empty());
}

}  // namespace
}  // namespace demo_logger
