#include "publish.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>

#include "demo_logger/trajectory/error.h"
#include "episode_name.h"

namespace demo_logger {

std::filesystem::path publish(FileSystem& file_system, const std::filesystem::path& directory, const std::string& id,
                              SidecarFile& sidecar, const std::function<std::string(const std::string& id)>& text) {
  std::filesystem::path data = partFiles(directory, id).data;
  std::uint64_t number = 0;
  const auto nextId = [&] {
    number = std::max(number + 1, nextEpisodeNumber(directory));  // also where the directory cannot be listed
    return episodeId(number);
  };
  for (std::string final_id = id;; final_id = nextId()) {
    const EpisodeFiles finals = finalFiles(directory, final_id);
    if (file_system.exists(finals.data) || file_system.exists(finals.sidecar)) {
      continue;
    }
    sidecar.replaceForGood(text(final_id));
    int result = file_system.rename(data, finals.data);
    if (result == -EEXIST) {
      continue;
    }
    if (result != 0) {
      throw FileError(data.string() + " cannot be renamed to " + finals.data.filename().string() + ": " +
                      errorText(result) +
                      (result == -ENOENT ? ". Was it moved or removed while it was recorded?"
                                         : ". Its rows are whole; `demo_tool recover` will finish it."));
    }
    data = finals.data;
    sidecar.giveReserveBack();
    // A sidecar without a word in it says less than none.
    result =
        sidecar.hasText() ? file_system.rename(sidecar.file(), finals.sidecar) : file_system.remove(sidecar.file());
    if (result == -EEXIST) {
      continue;
    }
    if (result != 0) {
      throw FileError(sidecar.file().string() + " cannot be renamed to " + finals.sidecar.filename().string() + ": " +
                      errorText(result) + ". The rows are in " + data.string() + "; `demo_tool recover` will add it.");
    }
    file_system.syncDirectory(directory);
    return data;
  }
}

}  // namespace demo_logger
