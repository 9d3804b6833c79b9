#include "demo_logger/formats/demonstration_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "test/formats/temporary_folder.h"

namespace demo_logger {
namespace {

Demonstration makeDemonstration() {
  Demonstration demonstration;
  demonstration.columns = {{"q_elbow", "rad", Role::state, Interpolation::linear, "joint_states/position/elbow"},
                           {"u_vx", "m/s", Role::control, Interpolation::hold, "teleop_cmd/linear/x"}};
  demonstration.time = {0.0, 0.01, 0.02};
  demonstration.values.resize(3, 2);
  demonstration.values << 0.1, 1.0, 0.2, std::numeric_limits<double>::quiet_NaN(), 0.3, -1.0;
  demonstration.metadata.id = "demo_000001";
  demonstration.metadata.task = "reach";
  return demonstration;
}

std::string errorOfReading(const std::filesystem::path& file) {
  try {
    readDemonstration(file);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

std::string errorOfWriting(const std::filesystem::path& file, const Demonstration& demonstration) {
  try {
    writeDemonstration(file, demonstration);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DemonstrationFileTest, WritesTheDataAndItsSidecar) {
  const TemporaryFolder folder;
  const auto csv = folder.path() / "demo_000001.csv";
  writeDemonstration(csv, makeDemonstration());
  EXPECT_EQ(TemporaryFolder::read(csv), "time,q_elbow,u_vx\n0,0.1,1\n0.01,0.2,NaN\n0.02,0.3,-1\n");
  const Sidecar sidecar = readSidecar(folder.path() / "demo_000001.json");
  EXPECT_EQ(sidecar.metadata.rows, 3U);
  EXPECT_DOUBLE_EQ(sidecar.metadata.duration, 0.02);
  EXPECT_EQ(sidecar.metadata.task, "reach");
  EXPECT_EQ(folder.entries(), 2U) << "no temporary file is left";
}

TEST(DemonstrationFileTest, FilesBelongToTheirOwnerAndGroupOnly) {
  const TemporaryFolder folder;
  umask(022);
  writeDemonstration(folder.path() / "a.csv", makeDemonstration());
  struct stat status = {};
  ASSERT_EQ(stat((folder.path() / "a.csv").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(DemonstrationFileTest, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  const auto csv = folder.path() / "a.csv";
  const Demonstration demonstration = makeDemonstration();
  writeDemonstration(csv, demonstration);
  const LoadedDemonstration loaded = readDemonstration(csv);
  EXPECT_TRUE(loaded.notes.empty());
  EXPECT_EQ(loaded.demonstration.time, demonstration.time);
  ASSERT_EQ(loaded.demonstration.columns.size(), 2U);
  EXPECT_EQ(loaded.demonstration.columns[0].source, "joint_states/position/elbow");
  EXPECT_EQ(loaded.demonstration.columns[1].role, Role::control);
  EXPECT_EQ(loaded.demonstration.values(2, 1), -1.0);
  EXPECT_TRUE(std::isnan(loaded.demonstration.values(1, 1)));
  EXPECT_EQ(loaded.demonstration.metadata.id, "demo_000001");
}

TEST(DemonstrationFileTest, EveryFiniteBitPatternSurvivesTheFile) {
  std::mt19937_64 generator(7);
  Demonstration demonstration;
  demonstration.values.resize(20'000, 5);
  for (int i = 0; i < 5; ++i) {
    demonstration.columns.push_back({"c" + std::to_string(i), "", {}, {}, ""});
  }
  for (Eigen::Index row = 0; row < demonstration.values.rows(); ++row) {
    demonstration.time.push_back(static_cast<double>(row) * 1e-3);
    for (Eigen::Index column = 0; column < 5; ++column) {
      std::uint64_t bits = generator();
      if (column == 4) {
        bits &= 0x800FFFFFFFFFFFFFU;  // no exponent: a subnormal number
      }
      double value = 0.0;
      std::memcpy(&value, &bits, sizeof(value));
      demonstration.values(row, column) = std::isfinite(value) ? value : 0.0;
    }
  }
  const TemporaryFolder folder;
  writeDemonstration(folder.path() / "bits.csv", demonstration);
  const Demonstration back = readDemonstration(folder.path() / "bits.csv").demonstration;
  ASSERT_EQ(back.values.size(), demonstration.values.size());
  EXPECT_EQ(std::memcmp(back.values.data(), demonstration.values.data(), sizeof(double) * back.values.size()), 0);
  EXPECT_EQ(std::memcmp(back.time.data(), demonstration.time.data(), sizeof(double) * back.time.size()), 0);
}

TEST(DemonstrationFileTest, WithoutASidecarTheNamesSpeakAndTheNotesSaySo) {
  const TemporaryFolder folder;
  const auto csv = folder.write("bare.csv", "time,q_elbow,u_vx,u_age\n0,1,2,0.1\n1,2,3,NaN\n");
  const LoadedDemonstration loaded = readDemonstration(csv);
  EXPECT_EQ(loaded.demonstration.columns[0].unit, "rad");
  EXPECT_EQ(loaded.demonstration.columns[1].role, Role::control);
  EXPECT_EQ(loaded.demonstration.columns[2].interpolation, Interpolation::none);
  EXPECT_EQ(loaded.demonstration.metadata.rows, 2U);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_EQ(loaded.notes[0], (folder.path() / "bare.json").string() +
                                 ": is not there; units, roles and interpolation follow from the columns' names.");
}

TEST(DemonstrationFileTest, ASidecarOfFormatAndNamesIsEnough) {
  const TemporaryFolder folder;
  const auto csv = folder.write("bare.csv", "time,q_elbow\n0,1\n");
  folder.write("bare.json", R"({"format": "demo_logger/1", "columns": [{"name": "time"}, {"name": "q_elbow"}]})");
  const LoadedDemonstration loaded = readDemonstration(csv);
  EXPECT_EQ(loaded.demonstration.columns[0].unit, "rad");
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_NE(loaded.notes[0].find("follows from the names"), std::string::npos);
}

TEST(DemonstrationFileTest, DataAndSidecarThatDisagreeAreTold) {
  const TemporaryFolder folder;
  const auto csv = folder.write("a.csv", "time,q_a,q_b\n0,1,2\n");
  const std::string json = folder
                               .write("a.json", R"({"format": "demo_logger/1", "rows": 5, "columns": [
        {"name": "q_a", "unit": "m", "role": "state", "interpolation": "linear"},
        {"name": "q_c", "unit": "m", "role": "state", "interpolation": "linear"}]})")
                               .string();
  const LoadedDemonstration loaded = readDemonstration(csv);
  EXPECT_EQ(loaded.demonstration.columns[0].unit, "m") << "the sidecar knows better than the name";
  EXPECT_EQ(loaded.demonstration.metadata.rows, 1U);
  EXPECT_EQ(loaded.notes,
            (std::vector<std::string>{
                json + ": does not list 1 of 2 columns (q_b first); their units, roles and interpolation follow from "
                       "their names.",
                json + ": lists a column q_c that the CSV does not have.",
                json + ": says 5 rows, the CSV has 1. Do the two files belong together?"}));
}

TEST(DemonstrationFileTest, NamesOfOthersAreMadePortableWithTheirOriginalsKept) {
  const TemporaryFolder folder;
  const auto csv = folder.write("other.csv", "time,arm/q [rad]\n0,1\n");
  const LoadedDemonstration loaded = readDemonstration(csv);
  EXPECT_EQ(loaded.demonstration.columns[0].name, "arm_q__rad_");
  EXPECT_EQ(loaded.demonstration.metadata.original_names.at("arm_q__rad_"), "arm/q [rad]");
  EXPECT_EQ(loaded.notes.back(), csv.string() + ": column \"arm/q [rad]\" is called arm_q__rad_ from here on.");
}

TEST(DemonstrationFileTest, WritingMakesNamesPortableToo) {
  const TemporaryFolder folder;
  Demonstration demonstration = makeDemonstration();
  demonstration.columns[0].name = "q/elbow";
  writeDemonstration(folder.path() / "a.csv", demonstration);
  const Sidecar sidecar = readSidecar(folder.path() / "a.json");
  EXPECT_EQ(sidecar.columns[0].name, "q_elbow");
  EXPECT_EQ(sidecar.metadata.original_names.at("q_elbow"), "q/elbow");
}

TEST(DemonstrationFileTest, InfinitiesAreWrittenAsNaNAndCounted) {
  const TemporaryFolder folder;
  Demonstration demonstration = makeDemonstration();
  demonstration.values(0, 0) = std::numeric_limits<double>::infinity();
  writeDemonstration(folder.path() / "a.csv", demonstration);
  const Demonstration back = readDemonstration(folder.path() / "a.csv").demonstration;
  EXPECT_TRUE(std::isnan(back.values(0, 0)));
  EXPECT_EQ(back.metadata.counters.at("infinities_written_as_nan"), 1U);
}

TEST(DemonstrationFileTest, NeverOverwritesUnlessAsked) {
  const TemporaryFolder folder;
  const auto csv = folder.write("a.csv", "mine");
  EXPECT_EQ(errorOfWriting(csv, makeDemonstration()),
            csv.string() + ": exists already and is not overwritten; choose another name or ask to overwrite.");
  EXPECT_EQ(TemporaryFolder::read(csv), "mine");
  EXPECT_EQ(folder.entries(), 1U);
  writeDemonstration(csv, makeDemonstration(), /*overwrite=*/true);
  EXPECT_EQ(readDemonstration(csv).demonstration.time.size(), 3U);
}

TEST(DemonstrationFileTest, ASidecarInTheWayLeavesNoDataBehind) {
  const TemporaryFolder folder;
  folder.write("a.json", "mine");
  EXPECT_EQ(errorOfWriting(folder.path() / "a.csv", makeDemonstration()),
            (folder.path() / "a.json").string() +
                ": exists already and is not overwritten; choose another name or ask to overwrite.");
  EXPECT_EQ(folder.entries(), 1U) << "no CSV, no temporary file";
}

TEST(DemonstrationFileTest, ASymbolicLinkIsNotFollowed) {
  const TemporaryFolder folder;
  const auto target = folder.write("target", "precious");
  std::filesystem::create_symlink(target, folder.path() / "a.csv");
  EXPECT_NE(errorOfWriting(folder.path() / "a.csv", makeDemonstration()), "no error");
  writeDemonstration(folder.path() / "a.csv", makeDemonstration(), /*overwrite=*/true);
  EXPECT_EQ(TemporaryFolder::read(target), "precious") << "the link was replaced, not what it points to";
}

TEST(DemonstrationFileTest, AFolderThatIsNotThereIsNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(errorOfWriting(folder.path() / "none" / "a.csv", makeDemonstration()),
            (folder.path() / "none" / "a.csv").string() +
                ": cannot be created (No such file or directory); expected an existing folder with the right to write "
                "in it.");
}

TEST(DemonstrationFileTest, ADemonstrationThatContradictsItselfIsNotWritten) {
  const TemporaryFolder folder;
  const auto csv = folder.path() / "a.csv";
  Demonstration demonstration = makeDemonstration();
  demonstration.time.pop_back();
  EXPECT_EQ(errorOfWriting(csv, demonstration),
            csv.string() +
                ": is not written: the demonstration has 3 x 2 values, expected 2 x 2 as it has times and "
                "columns.");
  demonstration = makeDemonstration();
  demonstration.time[2] = 0.005;
  EXPECT_EQ(errorOfWriting(csv, demonstration),
            csv.string() +
                ": is not written: time 0.005 s of row 3 is not finite or does not follow the one before; "
                "times must strictly increase.");
  EXPECT_EQ(errorOfWriting(csv, Demonstration()),
            csv.string() + ": is not written: the demonstration has no rows, expected at least one.");
  EXPECT_EQ(errorOfWriting(folder.path() / "a.json", makeDemonstration()),
            (folder.path() / "a.json").string() +
                ": is not written: the name ends in .json like its sidecar's; expected a name that ends in .csv.");
  EXPECT_EQ(folder.entries(), 0U);
}

TEST(DemonstrationFileTest, TheSidecarIsNotTheDemonstration) {
  EXPECT_EQ(errorOfReading("demo_000001.json"),
            "demo_000001.json: is a sidecar, expected the CSV beside it. Name that file.");
}

TEST(DemonstrationFileTest, ABrokenSidecarIsNotIgnored) {
  const TemporaryFolder folder;
  const auto csv = folder.write("a.csv", "time,q\n0,1\n");
  folder.write("a.json", "{");
  EXPECT_EQ(errorOfReading(csv),
            (folder.path() / "a.json").string() + ":1: is not valid JSON because it ends too early. Was the file cut?");
}

}  // namespace
}  // namespace demo_logger
