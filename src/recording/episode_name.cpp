#include "episode_name.h"

#include <algorithm>
#include <cctype>
#include <system_error>

#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/quotation.h"

namespace demo_logger {

namespace {

constexpr char kPrefix[] = "demo_";
constexpr std::size_t kPrefixLength = sizeof(kPrefix) - 1;
constexpr std::size_t kDigits = 6;
constexpr std::size_t kMostDigits = 18;  // what surely fits into 64 bits

bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool isPlain(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; }

std::uint64_t highestNumberIn(const std::filesystem::path& directory) {
  std::uint64_t highest = 0;
  std::error_code error;  // a directory that cannot be read is found out when a file is created in it
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    highest = std::max(highest, episodeNumber(entry->path().filename().string()).value_or(0));
  }
  return highest;
}

}  // namespace

EpisodeFiles finalFiles(const std::filesystem::path& directory, const std::string& id) {
  return {directory / (id + ".csv"), directory / (id + ".json")};
}

EpisodeFiles partFiles(const std::filesystem::path& directory, const std::string& id) {
  return {directory / (id + ".csv.part"), directory / (id + ".json.part")};
}

std::filesystem::path discardedDirectory(const std::filesystem::path& directory) { return directory / "discarded"; }

std::string episodeId(std::uint64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < kDigits) {
    digits.insert(0, kDigits - digits.size(), '0');
  }
  return kPrefix + digits;
}

std::optional<std::uint64_t> episodeNumber(const std::string& file_name) {
  if (file_name.compare(0, kPrefixLength, kPrefix) != 0) {
    return std::nullopt;
  }
  const auto first = file_name.begin() + kPrefixLength;
  const auto last = std::find_if_not(first, file_name.end(), isDigit);
  const auto digits = static_cast<std::size_t>(last - first);
  if (digits < kDigits || digits > kMostDigits || (last != file_name.end() && *last != '.')) {
    return std::nullopt;
  }
  return std::stoull(std::string(first, last));
}

std::uint64_t nextEpisodeNumber(const std::filesystem::path& directory) {
  return std::max(highestNumberIn(directory), highestNumberIn(discardedDirectory(directory))) + 1;
}

void requirePlainId(const std::string& id) {
  if (id.empty() || !std::all_of(id.begin(), id.end(), isPlain)) {
    throw FileError(inQuotes(id) + " is not the id of an episode; expected letters, digits, _ and - alone, as in " +
                    episodeId(1) + ".");
  }
}

}  // namespace demo_logger
