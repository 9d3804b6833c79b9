#include <algorithm>
#include <cerrno>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "demo_logger/formats/column_conventions.h"
#include "demo_logger/formats/sidecar.h"
#include "demo_logger/recording/episode_writer.h"
#include "demo_logger/trajectory/error.h"
#include "discarded.h"
#include "episode_name.h"
#include "file_system.h"
#include "publish.h"
#include "sidecar_file.h"
#include "whole_rows.h"

namespace demo_logger {

namespace {

constexpr char kKilled[] = "interrupted: killed";
constexpr std::size_t kLongestSidecar = 64 * 1024 * 1024;

/// Ids of everything in `directory` that ends in .part, in their order.
std::set<std::string> idsOfParts(const std::filesystem::path& directory) {
  std::set<std::string> ids;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (const std::optional<std::uint64_t> number = episodeNumber(name);
        number && entry->path().extension() == ".part") {
      ids.insert(episodeId(*number));
    }
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw FileError(directory.string() + " cannot be searched for unfinished recordings: " + error.message() + ".");
  }
  return ids;
}

/// A part that is there and that no one else holds, held by us.
FileDescriptor holdPart(FileSystem& file_system, const std::filesystem::path& part) {
  FileDescriptor descriptor(file_system, file_system.open(part));
  const int opened = descriptor.get();
  if (opened == -EACCES || opened == -EPERM || opened == -EROFS) {
    throw FileError(part.string() + " cannot be finished: " + errorText(opened) + ". Is it another user's recording?");
  }
  // A symbolic link or a pipe was put there by someone else; what has been renamed since it was opened is finished.
  if (!descriptor || file_system.lock(opened) != 0 || !isSameFile(opened, part)) {
    return {};
  }
  return descriptor;
}

/// The sidecar as it was last saved, or, where that is lost, what the CSV itself says.
Sidecar rememberedSidecar(const FileDescriptor& descriptor, const std::filesystem::path& file, const WholeRows& rows) {
  std::string reason = "it is missing";
  if (descriptor) {
    try {
      Sidecar sidecar = parseSidecar(readText(descriptor.get(), file.string(), kLongestSidecar), file.string());
      const bool fits = std::equal(sidecar.columns.begin(), sidecar.columns.end(), rows.names.begin(), rows.names.end(),
                                   [](const Column& column, const std::string& name) { return column.name == name; });
      if (fits) {
        return sidecar;
      }
      reason = "its columns are not those of the data";
    } catch (const FileError& error) {
      reason = error.what();
    }
  }
  Sidecar sidecar;
  sidecar.columns = describeColumns(rows.names);
  sidecar.metadata.faults.push_back(Fault{
      0, "The sidecar was lost (" + reason + "): columns follow from their names, the stamp of the start is unknown.",
      1});
  return sidecar;
}

/// Killed between the two renames: the data has its name, the sidecar tells which.
void finishSidecar(FileSystem& file_system, const std::filesystem::path& directory, const std::filesystem::path& part,
                   const FileDescriptor& descriptor, std::vector<Recovered>& recovered) {
  try {
    const Sidecar sidecar = parseSidecar(readText(descriptor.get(), part.string(), kLongestSidecar), part.string());
    requirePlainId(sidecar.metadata.id);
    const EpisodeFiles finals = finalFiles(directory, sidecar.metadata.id);
    if (file_system.exists(finals.data) && file_system.rename(part, finals.sidecar) == 0) {
      recovered.push_back({finals.data, sidecar.metadata.rows, 0});
      return;
    }
  } catch (const FileError&) {
    // Not a whole sidecar: of no episode that we know.
  }
  moveToDiscarded(file_system, directory, {part});
}

void recoverEpisode(FileSystem& file_system, const std::filesystem::path& directory, const std::string& id,
                    std::vector<Recovered>& recovered) {
  const EpisodeFiles parts = partFiles(directory, id);
  FileDescriptor data = holdPart(file_system, parts.data);
  if (!data && file_system.exists(parts.data)) {
    return;
  }
  FileDescriptor sidecar_part = holdPart(file_system, parts.sidecar);
  if (!sidecar_part && file_system.exists(parts.sidecar)) {
    return;
  }
  std::filesystem::path half_written = parts.sidecar;
  half_written += ".new";
  if (!data) {
    if (sidecar_part) {
      finishSidecar(file_system, directory, parts.sidecar, sidecar_part, recovered);
    }
    return;
  }
  file_system.remove(half_written);
  const WholeRows rows = findWholeRows(data.get(), parts.data.string());
  if (rows.rows == 0) {
    moveToDiscarded(file_system, directory, {parts.data, parts.sidecar});
    return;
  }
  int result = file_system.truncate(data.get(), rows.bytes);
  if (result == 0) {
    result = file_system.syncData(data.get());
  }
  if (result != 0) {
    throw FileError(parts.data.string() + " cannot be cut back to its last complete row: " + errorText(result) + ".");
  }

  Sidecar remembered = rememberedSidecar(sidecar_part, parts.sidecar, rows);
  if (!sidecar_part) {
    sidecar_part = FileDescriptor(file_system, file_system.create(parts.sidecar));
    if (!sidecar_part) {
      throw FileError(parts.sidecar.string() + " cannot be created: " + errorText(sidecar_part.get()) + ".");
    }
    file_system.lock(sidecar_part.get());
  }
  Metadata& metadata = remembered.metadata;
  metadata.status = kKilled;
  metadata.rows = rows.rows;
  metadata.duration = rows.last_time;
  SidecarFile sidecar(file_system, parts.sidecar, std::move(sidecar_part));
  const std::filesystem::path file = publish(file_system, directory, id, sidecar, [&](const std::string& final_id) {
    metadata.id = final_id;
    return sidecarText(metadata, remembered.columns);
  });
  recovered.push_back({file, rows.rows, static_cast<std::uint64_t>(rows.file_bytes - rows.bytes)});
}

}  // namespace

std::vector<Recovered> recover(const std::filesystem::path& directory) {
  std::vector<Recovered> recovered;
  std::optional<FileError> first_error;
  for (const std::string& id : idsOfParts(directory)) {
    try {
      recoverEpisode(operatingSystem(), directory, id, recovered);
    } catch (const FileError& error) {
      // The others are finished all the same.
      first_error = first_error ? first_error : std::make_optional(error);
    }
  }
  if (first_error) {
    throw FileError(*first_error);
  }
  return recovered;
}

}  // namespace demo_logger
