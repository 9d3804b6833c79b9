#include "line_reader.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/regular_file.h"

namespace demo_logger {
namespace {

constexpr std::size_t kFirstBufferSize = 256U << 10U;  // bytes

FileError unreadable(const std::filesystem::path& file, int error) {
  return FileError(file.string() + ": cannot be read (" + std::generic_category().message(error) +
                   "); expected a CSV file that exists and may be read.");
}

int openTable(const std::filesystem::path& file) {
  std::error_code status;
  const bool is_directory = std::filesystem::is_directory(file, status);
  requireRegularFile(file, std::string("a CSV file.") + (is_directory ? " Name one of the files in it." : ""));
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    throw unreadable(file, errno);
  }
  return descriptor;
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& file) : file_(file), descriptor_(openTable(file)) {
  buffer_.resize(kFirstBufferSize);
}

LineReader::~LineReader() { close(descriptor_); }

LineReader::Outcome LineReader::next(std::size_t limit, std::string_view& line) {
  std::size_t searched = 0;
  while (true) {
    const char* start = buffer_.data() + begin_;
    const std::size_t available = end_ - begin_;
    const void* line_feed = std::memchr(start + searched, '\n', available - searched);
    const std::size_t length =
        line_feed == nullptr ? available : static_cast<std::size_t>(static_cast<const char*>(line_feed) - start);
    if (length > limit) {
      return Outcome::too_long;
    }
    if (line_feed != nullptr || (at_end_of_file_ && length > 0)) {
      line = {start, length};
      ended_with_line_feed_ = line_feed != nullptr;
      begin_ += length + (ended_with_line_feed_ ? 1 : 0);
      return Outcome::line;
    }
    if (at_end_of_file_) {
      return Outcome::end;
    }
    searched = available;
    at_end_of_file_ = !fill();
  }
}

// Reads on behind what has not been given yet; false at the end of the file.
bool LineReader::fill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ == buffer_.size()) {
    buffer_.resize(2 * buffer_.size());
  }
  while (true) {
    const ssize_t count = read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
    if (count >= 0) {
      end_ += static_cast<std::size_t>(count);
      return count > 0;
    }
    if (errno != EINTR) {
      throw unreadable(file_, errno);
    }
  }
}

}  // namespace demo_logger
