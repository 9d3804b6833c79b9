#include "src/tool/plain_table.h"

#include "demo_logger/formats/atomic_file.h"
#include "demo_logger/formats/column_conventions.h"
#include "demo_logger/formats/csv_reader.h"
#include "demo_logger/formats/csv_writer.h"

namespace demo_logger {
namespace {

CsvReader openTable(const std::filesystem::path& file) {
  return CsvReader(file, CsvExpectation{{}, false, {"status"}});
}

}  // namespace

bool isPlainTable(const std::filesystem::path& file) {
  if (file.extension() == ".json") return false;
  CsvReader reader = openTable(file);
  if (!reader.find("time")) return true;
  const auto status = reader.find("status");
  std::vector<double> row;
  return status && reader.next(row) && !reader.word(*status).empty();
}

PlainTable readPlainTable(const std::filesystem::path& file) {
  CsvReader reader = openTable(file);
  PlainTable table;
  Demonstration& numbers = table.numbers.demonstration;
  numbers.columns = describeColumns(reader.names());
  const auto status = reader.find("status");
  std::vector<double> row, values;
  while (reader.next(row)) {
    values.insert(values.end(), row.begin(), row.end());
    table.status.push_back(status ? reader.word(*status) : "");
  }
  const auto columns = static_cast<Eigen::Index>(numbers.columns.size());
  numbers.values =
      Eigen::Map<Demonstration::Values>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
  table.numbers.notes = reader.notes();
  return table;
}

std::string textOf(const Demonstration& numbers, const std::vector<std::string>& status) {
  std::string text;
  for (const Column& column : numbers.columns) text += (text.empty() ? "" : ",") + column.name;
  text += '\n';
  for (Eigen::Index row = 0; row < numbers.values.rows(); ++row) {
    for (Eigen::Index column = 0; column < numbers.values.cols(); ++column) {
      if (column > 0) text += ',';
      const std::string& word = status[static_cast<std::size_t>(row)];
      if (numbers.columns[static_cast<std::size_t>(column)].name == "status" && !word.empty()) {
        text += word;
      } else {
        appendNumber(text, numbers.values(row, column));
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace demo_logger
