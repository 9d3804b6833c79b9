#include <system_error>

#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "file_system.h"

namespace demo_logger {

std::uintmax_t freeSpace(const std::filesystem::path& directory) {
  std::error_code ignored;
  std::filesystem::path existing = std::filesystem::absolute(directory);
  while (!std::filesystem::exists(existing, ignored) && existing.has_relative_path()) {
    existing = existing.parent_path();
  }
  const std::int64_t bytes = operatingSystem().freeSpace(existing);
  if (bytes < 0) {
    throw FileError(directory.string() + ": the space left cannot be told: " + errorText(static_cast<int>(bytes)) +
                    ".");
  }
  return static_cast<std::uintmax_t>(bytes);
}

}  // namespace demo_logger
