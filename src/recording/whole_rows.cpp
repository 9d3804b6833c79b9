#include "whole_rows.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>

#include "demo_logger/formats/column_names.h"
#include "demo_logger/trajectory/error.h"
#include "file_system.h"

namespace demo_logger {

namespace {

constexpr std::size_t kChunkBytes = 1024 * 1024;
constexpr std::size_t kLongestLine = 16 * 1024 * 1024;  // far beyond any row; what is longer is no CSV of ours

std::size_t readChunk(int descriptor, const std::string& file, char* bytes, std::size_t size, off_t offset) {
  ssize_t count = 0;
  do {
    count = ::pread(descriptor, bytes, size, offset);
  } while (count < 0 && errno == EINTR);
  if (count < 0) {
    throw FileError(file + " cannot be read: " + errorText(errno) + ".");
  }
  return static_cast<std::size_t>(count);
}

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> result;
  for (std::size_t start = 0;;) {
    const std::size_t comma = line.find(',', start);
    result.push_back(line.substr(start, comma - start));
    if (comma == std::string_view::npos) {
      return result;
    }
    start = comma + 1;
  }
}

bool readNumber(std::string_view text, double& value) {
  const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

/// Takes one line without its line feed; false where it is not what must come next.
bool accept(std::string_view line, WholeRows& whole) {
  const std::vector<std::string_view> parts = cells(line);
  if (whole.bytes == 0) {
    const bool is_header = parts.front() == "time" && std::all_of(parts.begin(), parts.end(), isPortable);
    whole.names.assign(parts.begin() + (is_header ? 1 : static_cast<std::ptrdiff_t>(parts.size())), parts.end());
    return is_header;
  }
  double number = 0.0;
  if (parts.size() != whole.names.size() + 1 ||
      !std::all_of(parts.begin() + 1, parts.end(), [&](std::string_view cell) { return readNumber(cell, number); }) ||
      !readNumber(parts.front(), number)) {
    return false;
  }
  whole.last_time = number;
  ++whole.rows;
  return true;
}

}  // namespace

WholeRows findWholeRows(int descriptor, const std::string& file) {
  WholeRows whole;
  std::string buffer;  // what has been read behind whole.bytes
  whole.file_bytes = ::lseek(descriptor, 0, SEEK_END);
  bool trusted = true;
  while (trusted && buffer.size() < kLongestLine) {
    const std::size_t known = buffer.size();
    buffer.resize(known + kChunkBytes);
    const std::size_t count =
        readChunk(descriptor, file, buffer.data() + known, kChunkBytes, whole.bytes + static_cast<off_t>(known));
    buffer.resize(known + count);
    if (count == 0) {
      break;
    }
    std::size_t start = 0;
    for (std::size_t end = buffer.find('\n', known); trusted && end != std::string::npos;
         end = buffer.find('\n', start)) {
      trusted = accept(std::string_view(buffer).substr(start, end - start), whole);
      if (trusted) {
        whole.bytes += static_cast<off_t>(end + 1 - start);
        start = end + 1;
      }
    }
    buffer.erase(0, start);
  }
  return whole;
}

std::string readText(int descriptor, const std::string& file, std::size_t limit) {
  std::string text;
  for (;;) {
    const std::size_t known = text.size();
    text.resize(known + kChunkBytes);
    const std::size_t count = readChunk(descriptor, file, text.data() + known, kChunkBytes, static_cast<off_t>(known));
    text.resize(known + count);
    if (count == 0) {
      return text;
    }
    if (text.size() > limit) {
      throw FileError(file + " has more than " + std::to_string(limit) + " bytes, which no sidecar has.");
    }
  }
}

}  // namespace demo_logger
