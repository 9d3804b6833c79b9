#include "demo_logger/recording/episode_label.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/recording_directory.h"

namespace demo_logger {
namespace {

std::filesystem::path record(const std::filesystem::path& directory) {
  Metadata metadata;
  metadata.task = "pour";
  metadata.notes = "first try";
  EpisodeWriter writer(directory, jointColumns(), metadata);
  writer.write(knownRow(0));
  return sidecarPath(writer.finish(metadata));
}

TEST(EpisodeLabelTest, ChangesWhatIsGivenAndKeepsEverythingElse) {
  const RecordingDirectory directory;
  const std::filesystem::path sidecar = record(directory.path());
  auto before = nlohmann::ordered_json::parse(readFile(sidecar));
  before["of_the_lab"] = {{"camera", {1, 2, 3}}};
  before["robot"]["serial"] = "XK-12";
  writeFile(sidecar, before.dump());

  labelEpisode(directory.path(), "demo_000001", {"failure", "", "Zoë", ""});

  auto expected = before;
  expected["outcome"] = "failure";
  expected["operator"] = "Zoë";
  EXPECT_EQ(nlohmann::ordered_json::parse(readFile(sidecar)), expected);
  EXPECT_EQ(directory.listing(), "demo_000001.csv demo_000001.json");
}

TEST(EpisodeLabelTest, NamesTheOutcomesThatAreAllowed) {
  const RecordingDirectory directory;
  record(directory.path());
  try {
    labelEpisode(directory.path(), "demo_000001", {"great", "", "", ""});
    FAIL() << "expected a ConfigurationError";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(), "outcome is \"great\", expected success, failure or unknown.");
  }
}

TEST(EpisodeLabelTest, TextOfOthersStaysTextAndNeverBecomesAPath) {
  const RecordingDirectory directory;
  const std::filesystem::path sidecar = record(directory.path());
  const std::string notes = "../../etc/passwd; $(rm -rf /) \"quoted\"\n\xff";
  labelEpisode(directory.path(), "demo_000001", {"", notes, notes, notes});
  const Metadata metadata = readSidecar(sidecar).metadata;
  EXPECT_EQ(metadata.notes, "../../etc/passwd; $(rm -rf /) \"quoted\"\n\xef\xbf\xbd") << "what is no UTF-8 is replaced";
  EXPECT_THROW(labelEpisode(directory.path(), "../demo_000001", {"success", "", "", ""}), FileError);
}

TEST(EpisodeLabelTest, ABrokenSidecarIsNamedAndLeftAsItIs) {
  const RecordingDirectory directory;
  const std::filesystem::path sidecar = record(directory.path());
  writeFile(sidecar, "{\"format\":");
  try {
    labelEpisode(directory.path(), "demo_000001", {"success", "", "", ""});
    FAIL() << "expected a FileError";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()).find(sidecar.string()), 0U) << error.what();
  }
  EXPECT_EQ(readFile(sidecar), "{\"format\":");
}

}  // namespace
}  // namespace demo_logger
