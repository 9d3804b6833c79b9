#include "demo_logger/recording/episode_label.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/quotation.h"
#include "demo_logger/trajectory/regular_file.h"
#include "episode_name.h"
#include "file_system.h"
#include "sidecar_edit.h"

namespace demo_logger {

namespace {

constexpr std::array<std::string_view, 4> kChannels = {"teleoperation", "kinesthetic", "vr", "unknown"};
constexpr std::array<std::string_view, 3> kOutcomes = {"success", "failure", "unknown"};

template <std::size_t count>
void requireOneOf(const std::array<std::string_view, count>& allowed, const std::string& what,
                  const std::string& value) {
  if (std::find(allowed.begin(), allowed.end(), value) != allowed.end()) {
    return;
  }
  std::string list;
  for (std::size_t i = 0; i < count; ++i) {
    list += (i == 0 ? "" : i + 1 < count ? ", " : " or ") + std::string(allowed[i]);
  }
  throw ConfigurationError(what + " is " + inQuotes(value) + ", expected " + list + ".");
}

}  // namespace

void requireChannel(const std::string& channel) { requireOneOf(kChannels, "channel", channel); }

void requireOutcome(const std::string& outcome) { requireOneOf(kOutcomes, "outcome", outcome); }

void requireFinishedEpisode(const std::filesystem::path& directory, const std::string& id) {
  requirePlainId(id);
  FileSystem& file_system = operatingSystem();
  if (file_system.exists(finalFiles(directory, id).data)) {
    return;
  }
  throw FileError(
      directory.string() + " has no finished episode " + id + ", expected a file " + id + ".csv" +
      (file_system.exists(partFiles(directory, id).data) ? "; it is still open as " + id + ".csv.part." : "."));
}

void setSidecarTexts(const std::filesystem::path& sidecar, const std::map<std::string, std::string>& texts) {
  requireRegularFile(sidecar, "the JSON file where the label is kept.");
  std::ifstream stream(sidecar, std::ios::binary);
  if (!stream) {
    throw FileError(sidecar.string() + " cannot be read; it is where the label is kept.");
  }
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  parseSidecar(text, sidecar.string());  // says what is wrong with it, if anything is
  auto json = nlohmann::ordered_json::parse(text);
  for (const auto& [key, value] : texts) {
    json[key] = value;
  }
  writeFileAtomically(sidecar, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n",
                      /*overwrite=*/true);
}

void labelEpisode(const std::filesystem::path& directory, const std::string& id, const EpisodeLabel& label) {
  if (!label.outcome.empty()) {
    requireOutcome(label.outcome);
  }
  requireFinishedEpisode(directory, id);
  std::map<std::string, std::string> texts = {
      {"outcome", label.outcome}, {"task", label.task}, {"operator", label.operator_name}, {"notes", label.notes}};
  for (auto text = texts.begin(); text != texts.end();) {
    text = text->second.empty() ? texts.erase(text) : std::next(text);
  }
  if (!texts.empty()) {
    setSidecarTexts(finalFiles(directory, id).sidecar, texts);
  }
}

}  // namespace demo_logger
