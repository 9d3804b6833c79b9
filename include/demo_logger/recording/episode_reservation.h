#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace demo_logger {

class FileSystem;

/// The next free number in a directory, taken for an episode that has no row yet: empty demo_000001.csv.part and
/// .json.part, created exclusively, mode 0640, under flock. No other recorder, in this process or another, gets it.
class EpisodeReservation {
 public:
  /// Creates the directory where needed. Throws FileError. `file_system` outlives the reservation (nullptr: the real
  /// one).
  explicit EpisodeReservation(const std::filesystem::path& directory, FileSystem* file_system = nullptr);
  /// Gives the number back, unless an EpisodeWriter has taken it over: both files are removed.
  ~EpisodeReservation();
  EpisodeReservation(EpisodeReservation&&) noexcept;
  EpisodeReservation& operator=(EpisodeReservation&&) noexcept;

  const std::string& id() const;       // "demo_000001"
  std::filesystem::path file() const;  // the final name of the CSV

 private:
  friend class EpisodeWriter;
  struct Files;
  std::unique_ptr<Files> files_;
};

}  // namespace demo_logger
