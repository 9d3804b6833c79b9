#include "data_file.h"

#include <cerrno>
#include <utility>

namespace demo_logger {

DataFile::DataFile(FileSystem& file_system, FileDescriptor descriptor)
    : file_system_(file_system), descriptor_(std::move(descriptor)) {}

std::size_t DataFile::append(std::string_view lines) {
  std::size_t done = 0;
  error_ = 0;
  while (done < lines.size() && error_ == 0) {
    const ssize_t written = file_system_.write(descriptor_.get(), lines.data() + done, lines.size() - done,
                                               size_ + static_cast<off_t>(done));
    if (written > 0) {
      done += static_cast<std::size_t>(written);
    } else if (written != -EINTR) {
      error_ = written == 0 ? ENOSPC : static_cast<int>(-written);
    }
  }
  if (error_ != 0) {
    const std::size_t last_line_feed = done == 0 ? std::string_view::npos : lines.rfind('\n', done - 1);
    const std::size_t whole = last_line_feed == std::string_view::npos ? 0 : last_line_feed + 1;
    if (whole != done) {
      // Should this fail too, the next append overwrites the torn line all the same: it is given at this offset.
      file_system_.truncate(descriptor_.get(), size_ + static_cast<off_t>(whole));
    }
    done = whole;
  }
  size_ += static_cast<off_t>(done);
  return done;
}

}  // namespace demo_logger
