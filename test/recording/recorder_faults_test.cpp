#include <gtest/gtest.h>
#include <sys/mount.h>

#include "demo_logger/recording/recorder.h"
#include "demo_logger/trajectory/error.h"
#include "test/recording/eventually.h"
#include "test/recording/recorder_fixture.h"

namespace demo_logger {
namespace {

TEST_F(RecorderTest, NoEpisodeBeginsOnADiskWithTooLittleRoom) {
  RecorderConfiguration demanding = configuration();
  demanding.minimum_free_space = std::uintmax_t{1} << 62U;
  make(demanding);
  const Reply reply = recorder_->start(at(0), "", "", "", "");
  EXPECT_FALSE(reply.success);
  EXPECT_EQ(reply.message.find("disk full: " + file("").parent_path().string() + " has "), 0U) << reply.message;
  EXPECT_NE(reply.message.find(" bytes free, an episode begins with at least 4611686018427387904. Make room or choose "
                               "another output directory."),
            std::string::npos)
      << reply.message;
  EXPECT_EQ(listing(), "");

  demanding.autostart = true;
  EXPECT_THROW(Recorder(demanding, {}), FileError) << "nobody would see why autostart does nothing";
}

TEST_F(RecorderTest, AnOutputDirectoryThatIsAFileIsRefusedAtOnce) {
  writeFile(file("").parent_path(), "");
  try {
    make(configuration());
    FAIL() << "expected a FileError";
  } catch (const FileError& error) {
    EXPECT_EQ(std::string(error.what()), file("").parent_path().string() +
                                             ": there is a file of that name, expected a directory for the "
                                             "recordings. Remove it or choose another output directory.");
  }
}

TEST_F(RecorderTest, AnEpisodeThatCannotBeginByItselfIsAFaultAndIsTriedAgain) {
  RecorderConfiguration autostart = configuration();
  autostart.autostart = true;
  make(autostart);
  std::filesystem::remove(file("").parent_path());
  writeFile(file("").parent_path(), "in the way");
  run(0.0, 1.0);
  EXPECT_EQ(recorder_->status().state, RecorderState::idle);
  ASSERT_FALSE(recorder_->status().faults.empty());
  EXPECT_NE(recorder_->status().faults[0].what.find("there is a file of that name"), std::string::npos);
  EXPECT_EQ(recorder_->status().faults[0].count, 1U) << "once a second, not with every joint state";
  std::filesystem::remove(file("").parent_path());
  run(1.0, 2.0);
  EXPECT_TRUE(recorder_->close(at(2.0)).success);
  EXPECT_EQ(secondsOf("demo_000001"), ticks(1, 2));
}

TEST_F(RecorderTest, AFullDiskIsInTheStatusWhileTheEpisodeGoesOnAndInTheSidecarAfterwards) {
  const std::filesystem::path disk = directory_ / "demos";
  std::filesystem::create_directory(disk);
  if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
    GTEST_SKIP() << "mounting a tmpfs of 256 KiB is not permitted here";
  }
  struct Unmount {
    std::filesystem::path disk;
    ~Unmount() { ::umount(disk.c_str()); }
  } unmount{disk};
  RecorderConfiguration impatient = configuration();
  impatient.writer.flush_interval = 0.001;
  impatient.writer.sync_interval = 0.01;
  impatient.writer.retry_interval = 0.01;
  make(impatient);
  recorder_->start(at(0), "", "", "", "");
  run(0.0, 1.0);
  EXPECT_TRUE(eventually([&] { return recorder_->status().minutes_left < 60.0; }))
      << "256 KiB are used up within minutes";
  run(1.0, 60.0);  // more than 300 KiB
  const auto isFull = [](const RecorderStatus& status) {
    for (const Fault& fault : status.faults) {
      if (fault.what.find("disk full: ") == 0) return true;
    }
    return false;
  };
  ASSERT_TRUE(eventually([&] { return isFull(recorder_->status()); }));
  EXPECT_EQ(recorder_->status().state, RecorderState::recording);
  EXPECT_TRUE(eventually([&] { return recorder_->status().minutes_left < 0.01; }));
  const Reply reply = recorder_->stop(at(60.0), "success", "");
  ASSERT_TRUE(reply.success) << reply.message;
  EXPECT_EQ(reply.message, "Saved demo_000001 with " + std::to_string(reply.rows) + " rows, " +
                               std::to_string(6000 - reply.rows) + " more found no room on the disk.");
  const std::vector<double> seconds = secondsOf("demo_000001");
  EXPECT_EQ(seconds.size(), reply.rows);
  EXPECT_EQ(seconds, ticks(0, static_cast<double>(seconds.size()) / 100.0)) << "a prefix of what happened";
  const Metadata metadata = saved("demo_000001");
  EXPECT_EQ(metadata.rows, seconds.size());
  EXPECT_EQ(metadata.counters.at("rows_not_written"), 6000 - seconds.size());
  EXPECT_EQ(metadata.status, "complete");
  EXPECT_EQ(metadata.outcome, "success");
  bool told = false;
  for (const Fault& fault : metadata.faults) {
    told = told || fault.what.find("disk full: " + (disk / "demo_000001.csv.part").string()) == 0;
  }
  EXPECT_TRUE(told);
}

}  // namespace
}  // namespace demo_logger
