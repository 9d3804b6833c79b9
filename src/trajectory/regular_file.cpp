#include "demo_logger/trajectory/regular_file.h"

#include <system_error>

#include "demo_logger/trajectory/error.h"

namespace demo_logger {

void requireRegularFile(const std::filesystem::path& file, const std::string& expected) {
  const auto refuse = [&](const char* kind) {
    throw FileError(file.string() + ": is " + kind + ", expected " + expected);
  };
  std::error_code status;
  switch (std::filesystem::status(file, status).type()) {
    case std::filesystem::file_type::directory:
      return refuse("a directory");
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return refuse("a device");
    case std::filesystem::file_type::fifo:
      return refuse("a pipe");
    case std::filesystem::file_type::socket:
      return refuse("a socket");
    default:
      return;
  }
}

}  // namespace demo_logger
