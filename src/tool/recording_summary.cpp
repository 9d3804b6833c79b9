#include "src/tool/recording_summary.h"

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

using nlohmann::ordered_json;

ordered_json toJson(const StreamMetadata& stream) {
  return {{"name", stream.name},   {"topic", stream.topic},     {"type", stream.type},
          {"align", stream.align}, {"stamped", stream.stamped}, {"received", stream.received},
          {"used", stream.used},   {"late", stream.late},       {"dropped", stream.dropped}};
}

std::ostringstream classicStream() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  return text;
}

std::string milliseconds(double seconds) { return print(1000.0 * seconds, 1) + " ms"; }

std::string describeCounts(const StreamMetadata& stream) {
  std::string text = std::to_string(stream.received) + " received";
  for (const auto& [what, count] : {std::make_pair(" late", stream.late), std::make_pair(" dropped", stream.dropped)}) {
    text += count > 0 ? ", " + std::to_string(count) + what : "";
  }
  return text + (stream.stamped ? "" : ", without stamps");
}

std::string joinColumns(const std::vector<std::string>& columns) {
  std::string text;
  for (const std::string& column : columns) {
    text += " " + column;
  }
  return text;
}

}  // namespace

RecordingSummary summarise(const std::filesystem::path& csv, const LoadedDemonstration& loaded) {
  RecordingSummary summary;
  summary.file = csv;
  summary.bytes = std::filesystem::file_size(csv);
  summary.has_sidecar = std::filesystem::exists(sidecarPath(csv));
  summary.figures = check(loaded.demonstration).summary;
  summary.metadata = loaded.demonstration.metadata;
  summary.notes = loaded.notes;
  for (const Column& column : loaded.demonstration.columns) {
    summary.columns.push_back(column.name);
  }
  return summary;
}

ordered_json toJson(const RecordingSummary& summary) {
  const Metadata& metadata = summary.metadata;
  const CheckSummary& figures = summary.figures;
  ordered_json ages = ordered_json::object();
  for (const auto& [column, age] : figures.ages) {
    ages[column] = {{"min", age.min}, {"median", age.median}, {"max", age.max}};
  }
  ordered_json streams = ordered_json::array();
  for (const StreamMetadata& stream : metadata.streams) {
    streams.push_back(toJson(stream));
  }
  ordered_json faults = ordered_json::array();
  for (const Fault& fault : metadata.faults) {
    faults.push_back({{"what", fault.what}, {"count", fault.count}});
  }
  ordered_json files = {summary.file.string()};
  if (summary.has_sidecar) {
    files.push_back(sidecarPath(summary.file).string());
  }
  return {{"file", summary.file.string()},
          {"files", files},
          {"rows", figures.rows},
          {"duration", figures.duration},
          {"rate", figures.mean_rate},
          {"largest_gap", figures.largest_gap},
          {"largest_gap_at", figures.largest_gap_at},
          {"channel", metadata.channel},
          {"task", metadata.task},
          {"operator", metadata.operator_name},
          {"outcome", metadata.outcome},
          {"status", metadata.status},
          {"ages", ages},
          {"streams", streams},
          {"faults", faults},
          {"columns", summary.columns},
          {"notes", summary.notes}};
}

std::string toText(const RecordingSummary& summary) {
  const Metadata& metadata = summary.metadata;
  const CheckSummary& figures = summary.figures;
  std::ostringstream text = classicStream();
  text << summary.file.string() << '\n'
       << "  " << figures.rows << " rows in " << print(figures.duration, 3) << " s: " << print(figures.mean_rate, 1)
       << " Hz, largest gap " << milliseconds(figures.largest_gap) << " at " << print(figures.largest_gap_at, 3)
       << " s\n";
  if (summary.has_sidecar) {
    text << "  channel " << metadata.channel << (metadata.task.empty() ? "" : ", task " + metadata.task) << ", outcome "
         << metadata.outcome << ", " << metadata.status << '\n';
  }
  for (const auto& [column, age] : figures.ages) {
    text << "  " << column << ": median " << milliseconds(age.median) << ", largest " << milliseconds(age.max) << '\n';
  }
  for (const StreamMetadata& stream : metadata.streams) {
    text << "  stream " << stream.name << " from " << stream.topic << " (" << stream.type
         << "): " << describeCounts(stream) << '\n';
  }
  for (const Fault& fault : metadata.faults) {
    text << "  fault: " << fault.what << (fault.count == 1 ? "" : " (" + std::to_string(fault.count) + " times)")
         << '\n';
  }
  text << "  columns: time" << joinColumns(summary.columns) << '\n'
       << "  files: " << summary.file.filename().string() << " (" << print(static_cast<double>(summary.bytes) / 1e6, 2)
       << " MB)" << (summary.has_sidecar ? ", " + sidecarPath(summary.file).filename().string() : "") << '\n';
  for (const std::string& note : summary.notes) {
    text << "  note: " << note << '\n';
  }
  return text.str();
}

}  // namespace demo_logger
