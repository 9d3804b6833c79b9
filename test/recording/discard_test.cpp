#include <gtest/gtest.h>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {
namespace {

void record(const std::filesystem::path& directory) {
  EpisodeWriter writer(directory, jointColumns(), Metadata{});
  writer.write(knownRow(0));
  writer.finish(Metadata{});
}

std::string messageOf(const std::filesystem::path& directory, const std::string& id) {
  try {
    discardEpisode(directory, id);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

TEST(DiscardTest, MovesBothFilesAsideAndTheNumberIsNotUsedAgain) {
  const RecordingDirectory directory;
  record(directory.path());
  EXPECT_EQ(discardEpisode(directory.path(), "demo_000001"), directory / "discarded/demo_000001.csv");
  EXPECT_EQ(directory.listing(), "discarded");
  EXPECT_EQ(directory.listing("discarded"), "demo_000001.csv demo_000001.json");
  record(directory.path());
  EXPECT_EQ(directory.listing(), "demo_000002.csv demo_000002.json discarded");
}

TEST(DiscardTest, NeverGoesOverWhatWasDiscardedBefore) {
  for (const char* older : {"demo_000001.csv", "demo_000001.json"}) {
    const RecordingDirectory directory;
    record(directory.path());
    std::filesystem::create_directory(directory / "discarded");
    writeFile(directory / "discarded" / older, "older");
    EXPECT_EQ(discardEpisode(directory.path(), "demo_000001"), directory / "discarded/demo_000001_2.csv");
    EXPECT_EQ(readFile(directory / "discarded" / older), "older");
    EXPECT_EQ(readSidecar(directory / "discarded/demo_000001_2.json").metadata.id, "demo_000001_2");
  }
}

TEST(DiscardTest, TakesAnEpisodeWithoutASidecarToo) {
  const RecordingDirectory directory;
  writeFile(directory / "demo_000005.csv", "time,q_a\n0,1\n");
  EXPECT_EQ(discardEpisode(directory.path(), "demo_000005"), directory / "discarded/demo_000005.csv");
}

TEST(DiscardTest, RefusesWhatIsNotAnId) {
  const RecordingDirectory directory;
  std::filesystem::create_directory(directory / "demos");
  writeFile(directory / "x.csv", "");
  EXPECT_EQ(messageOf(directory / "demos", "../x"),
            "\"../x\" is not the id of an episode; expected letters, digits, _ and - alone, as in demo_000001.");
  EXPECT_EQ(messageOf(directory / "demos", ""),
            "\"\" is not the id of an episode; expected letters, digits, _ and - alone, as in demo_000001.");
  EXPECT_TRUE(std::filesystem::exists(directory / "x.csv"));
}

TEST(DiscardTest, SaysWhichFileItExpectedAndWhetherTheEpisodeIsStillOpen) {
  const RecordingDirectory directory;
  EXPECT_EQ(messageOf(directory.path(), "demo_000001"), directory.path().string() +
                                                            " has no finished episode demo_000001, expected a file "
                                                            "demo_000001.csv.");
  const EpisodeReservation open(directory.path());
  EXPECT_EQ(messageOf(directory.path(), "demo_000001"),
            directory.path().string() +
                " has no finished episode demo_000001, expected a file demo_000001.csv; it is still open as "
                "demo_000001.csv.part.");
}

}  // namespace
}  // namespace demo_logger
