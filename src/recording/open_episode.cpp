#include "open_episode.h"

#include <utility>

#include "demo_logger/formats/column_names.h"

namespace demo_logger {

OpenEpisode::OpenEpisode(EpisodeReservation reservation, Metadata what_is_said, const EpisodeWriterOptions& options,
                         const DerivedColumnsList& derived)
    : metadata(std::move(what_is_said)), options_(options), derived_(derived), reservation_(std::move(reservation)) {
  metadata.id = id();
}

void OpenEpisode::open(const std::vector<Column>& recorded, const std::map<std::string, std::string>& original_names) {
  std::vector<Column> columns = recorded;
  for (const auto& derived : derived_) {
    const std::vector<Column> more = derived->open(columns);
    columns.insert(columns.end(), more.begin(), more.end());
  }
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const Column& column : columns) {
    names.push_back(column.name);
  }
  PortableNames portable = makePortable(names);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i].name = portable.names[i];
  }
  metadata.original_names = original_names;
  metadata.original_names.merge(portable.original_names);
  writer_ = std::make_unique<EpisodeWriter>(std::move(*reservation_), std::move(columns), metadata, options_);
  reservation_.reset();
}

void OpenEpisode::write(const Row& row) {
  complete_row_ = row;
  for (const auto& derived : derived_) {
    derived->append(complete_row_);
  }
  writer_->write(complete_row_);
}

std::vector<Fault> OpenEpisode::faults() const {
  std::vector<Fault> faults;
  if (!writer_) return faults;
  for (const auto& derived : derived_) {
    const std::vector<Fault> more = derived->faults();
    faults.insert(faults.end(), more.begin(), more.end());
  }
  return faults;
}

const std::string& OpenEpisode::id() const { return writer_ ? writer_->id() : reservation_->id(); }

std::filesystem::path OpenEpisode::file() const { return writer_ ? writer_->file() : reservation_->file(); }

void OpenEpisode::save(const Metadata& everything) {
  if (writer_) {
    writer_->update(everything);
  }
}

}  // namespace demo_logger
