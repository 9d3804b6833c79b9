#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace demo_logger {

/// What a part file holds that can be trusted: everything up to the first line that is not a complete row. A process
/// that was killed leaves a torn last line, a power failure may leave zero bytes.
struct WholeRows {
  std::vector<std::string> names;  // of the header, without `time`; empty where the header itself is not whole
  std::uint64_t rows = 0;
  double last_time = 0.0;  // [s]
  off_t bytes = 0;         // header and rows
  off_t file_bytes = 0;
};

/// Reads the file once, with little memory whatever its length. Throws FileError, naming it `file`.
WholeRows findWholeRows(int descriptor, const std::string& file);

/// The whole content; throws FileError above `limit` bytes.
std::string readText(int descriptor, const std::string& file, std::size_t limit);

}  // namespace demo_logger
