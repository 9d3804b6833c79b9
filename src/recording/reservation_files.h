#pragma once

#include <filesystem>
#include <string>

#include "demo_logger/recording/episode_reservation.h"
#include "file_system.h"

namespace demo_logger {

/// What a reservation holds, and hands over to the writer. Removes the files unless both descriptors were moved away.
struct EpisodeReservation::Files {
  FileSystem& file_system;
  std::filesystem::path directory;
  std::string id;
  FileDescriptor data;
  FileDescriptor sidecar;

  ~Files();
};

}  // namespace demo_logger
