#include "demo_logger/formats/demonstration_file.h"

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/formats/column_conventions.h"
#include "demo_logger/formats/column_names.h"
#include "demo_logger/formats/csv_reader.h"
#include "demo_logger/formats/csv_writer.h"
#include "demo_logger/formats/sidecar.h"
#include "demo_logger/trajectory/error.h"
#include "demo_logger/trajectory/print.h"

namespace demo_logger {
namespace {

constexpr std::size_t kWriteBlock = 1U << 20U;  // bytes

std::string noteOfExtraColumn(const std::string& sidecar, const std::string& name) {
  return sidecar + ": lists a column " + name + " that the CSV does not have.";
}

std::string noteOfNewName(const std::filesystem::path& csv, const std::string& original, const std::string& name) {
  return csv.string() + ": column \"" + original + "\" is called " + name + " from here on.";
}

// The columns as named in the CSV, described by the sidecar where it lists them, by their names otherwise.
std::vector<Column> describe(const std::vector<std::string>& names, const std::vector<Column>& listed,
                             const std::string& sidecar, std::vector<std::string>& notes) {
  std::map<std::string, Column> by_name;
  for (const Column& column : listed) {
    by_name[column.name] = column;
  }
  std::vector<Column> columns = describeColumns(names);
  std::vector<std::string> concluded;
  for (Column& column : columns) {
    if (const auto entry = by_name.extract(column.name)) {
      column = entry.mapped();
    } else {
      concluded.push_back(column.name);
    }
  }
  if (!concluded.empty()) {
    notes.push_back(sidecar + ": does not list " + std::to_string(concluded.size()) + " of " +
                    std::to_string(names.size()) + " columns (" + concluded.front() +
                    " first); their units, roles and interpolation follow from their names.");
  }
  for (const auto& [name, column] : by_name) {
    notes.push_back(noteOfExtraColumn(sidecar, name));
  }
  return columns;
}

void readRows(CsvReader& reader, Demonstration& demonstration) {
  const std::size_t time = reader.find("time").value();
  std::vector<double> row;
  std::vector<double> values;
  while (reader.next(row)) {
    demonstration.time.push_back(row[time]);
    row.erase(row.begin() + static_cast<std::ptrdiff_t>(time));
    values.insert(values.end(), row.begin(), row.end());
  }
  demonstration.values =
      Eigen::Map<Demonstration::Values>(values.data(), static_cast<Eigen::Index>(demonstration.time.size()),
                                        static_cast<Eigen::Index>(reader.names().size() - 1));
}

void checkConsistency(const std::filesystem::path& csv, const Demonstration& demonstration) {
  const auto refuse = [&csv](const std::string& sentence) {
    throw FileError(csv.string() + ": is not written: " + sentence);
  };
  if (sidecarPath(csv) == csv) {
    refuse("the name ends in .json like its sidecar's; expected a name that ends in .csv.");
  }
  const auto rows = static_cast<std::size_t>(demonstration.values.rows());
  const auto columns = static_cast<std::size_t>(demonstration.values.cols());
  if (demonstration.time.empty()) {
    refuse("the demonstration has no rows, expected at least one.");
  }
  if (rows != demonstration.time.size() || columns != demonstration.columns.size()) {
    refuse("the demonstration has " + std::to_string(rows) + " x " + std::to_string(columns) + " values, expected " +
           std::to_string(demonstration.time.size()) + " x " + std::to_string(demonstration.columns.size()) +
           " as it has times and columns.");
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const double time = demonstration.time[i];
    if (!std::isfinite(time) || (i > 0 && time <= demonstration.time[i - 1])) {
      refuse("time " + printExactly(time) + " s of row " + std::to_string(i + 1) +
             " is not finite or does not follow the one before; times must strictly increase.");
    }
  }
}

std::size_t writeRows(AtomicFile& file, const Demonstration& demonstration, const std::vector<Column>& columns) {
  std::string text = csvHeader(columns);
  std::size_t infinities = 0;
  for (std::size_t i = 0; i < demonstration.time.size(); ++i) {
    infinities += appendRow(text, demonstration.time[i], demonstration.values.row(static_cast<Eigen::Index>(i)).data(),
                            columns.size());
    if (text.size() > kWriteBlock) {
      file.write(text);
      text.clear();
    }
  }
  file.write(text);
  return infinities;
}

}  // namespace

LoadedDemonstration readDemonstration(const std::filesystem::path& csv) {
  if (csv.extension() == ".json") {
    throw FileError(csv.string() + ": is a sidecar, expected the CSV beside it. Name that file.");
  }
  LoadedDemonstration loaded;
  Demonstration& demonstration = loaded.demonstration;
  CsvReader reader(csv);

  std::vector<std::string> names = reader.names();
  names.erase(names.begin() + static_cast<std::ptrdiff_t>(reader.find("time").value()));
  const PortableNames portable = makePortable(names);

  const std::filesystem::path sidecar_path = sidecarPath(csv);
  std::optional<std::uint64_t> stated_rows;
  if (std::filesystem::exists(sidecar_path)) {
    Sidecar sidecar = readSidecar(sidecar_path);
    demonstration.metadata = std::move(sidecar.metadata);
    loaded.notes = std::move(sidecar.notes);
    demonstration.columns = describe(portable.names, sidecar.columns, sidecar_path.string(), loaded.notes);
    stated_rows = demonstration.metadata.rows;
  } else {
    demonstration.columns = describeColumns(portable.names);
    loaded.notes.push_back(sidecar_path.string() +
                           ": is not there; units, roles and interpolation follow from the columns' names.");
  }
  for (const auto& [name, original] : portable.original_names) {
    demonstration.metadata.original_names[name] = original;
    loaded.notes.push_back(noteOfNewName(csv, original, name));
  }

  readRows(reader, demonstration);
  loaded.notes.insert(loaded.notes.end(), reader.notes().begin(), reader.notes().end());
  demonstration.metadata.rows = demonstration.time.size();
  demonstration.metadata.duration = demonstration.time.back() - demonstration.time.front();
  if (stated_rows.value_or(0) != 0 && *stated_rows != demonstration.metadata.rows) {
    loaded.notes.push_back(sidecar_path.string() + ": says " + std::to_string(*stated_rows) + " rows, the CSV has " +
                           std::to_string(demonstration.metadata.rows) + ". Do the two files belong together?");
  }
  return loaded;
}

void writeDemonstration(AtomicFiles& files, const std::filesystem::path& csv, const Demonstration& demonstration,
                        bool overwrite) {
  checkConsistency(csv, demonstration);
  std::vector<std::string> names;
  for (const Column& column : demonstration.columns) {
    names.push_back(column.name);
  }
  PortableNames portable = makePortable(names);
  std::vector<Column> columns = demonstration.columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i].name = portable.names[i];
  }

  const std::size_t infinities = writeRows(files.add(csv, overwrite), demonstration, columns);

  Metadata metadata = demonstration.metadata;
  metadata.original_names.merge(portable.original_names);
  metadata.rows = demonstration.time.size();
  metadata.duration = demonstration.time.back() - demonstration.time.front();
  if (infinities > 0) {
    metadata.counters["infinities_written_as_nan"] += infinities;
  }
  files.add(sidecarPath(csv), overwrite).write(sidecarText(metadata, columns));
}

void writeDemonstration(const std::filesystem::path& csv, const Demonstration& demonstration, bool overwrite) {
  AtomicFiles files;
  writeDemonstration(files, csv, demonstration, overwrite);
  files.commit();
}

}  // namespace demo_logger
