#include "testbed/formats/text/csv_table.h"

#include <algorithm>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/text/lines.h"

namespace geoprior {
namespace {

/// Words between commas, without blanks around them; none for a line without words.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  line = line.substr(0, line.find('#'));
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    std::string cell(line.substr(begin, end - begin));
    const std::size_t first = cell.find_first_not_of(" \t\r");
    const std::size_t last = cell.find_last_not_of(" \t\r");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    begin = end + 1;
  }
  if (cells.size() == 1 && cells[0].empty()) cells.clear();
  return cells;
}

/// "x, y, z and, if need be, weight, type".
std::string known(const std::vector<std::string>& columns, std::size_t required) {
  std::string text;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (k > 0) text += k == required ? " and, if need be, " : ", ";
    text += columns[k];
  }
  return text;
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file, const std::vector<std::string_view>& required,
                   const std::vector<std::string_view>& optional)
    : columns_(required.begin(), required.end()) {
  columns_.insert(columns_.end(), optional.begin(), optional.end());
  const std::string text = read_whole_file(file);
  TextLines lines(text, file.string());
  while (lines.next()) {
    std::vector<std::string> cells = cells_of(lines.line());
    if (cells.empty()) continue;
    if (at_.empty()) {
      read_header(cells, lines.place(), required.size());
    } else {
      rows_.push_back({std::move(cells), lines.place()});
    }
  }
  if (at_.empty()) throw Error("is empty", file.string(), "a line of columns, then rows");
}

void CsvTable::read_header(const std::vector<std::string>& header, const std::string& place,
                           std::size_t required) {
  at_.resize(columns_.size());
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto named = std::find(columns_.begin(), columns_.end(), header[i]);
    if (named == columns_.end()) continue;
    std::optional<std::size_t>& at = at_[named - columns_.begin()];
    if (at) throw Error("names the column '" + header[i] + "' twice", place, "each once");
    at = i;
  }
  for (std::size_t k = 0; k < required; ++k) {
    if (at_[k]) continue;
    throw Error("names no column '" + columns_[k] + "'", place, known(columns_, required));
  }
}

std::optional<std::string> CsvTable::text(const Row& row, std::string_view column) const {
  const auto named = std::find(columns_.begin(), columns_.end(), column);
  if (named == columns_.end()) {
    throw Error("column '" + std::string(column) + "' was not asked for", row.place);
  }
  const std::optional<std::size_t> at = at_[named - columns_.begin()];
  if (!at) return {};
  if (*at >= row.cells.size()) {
    throw Error("has no " + *named, row.place, "a row as long as the first");
  }
  return row.cells[*at];
}

std::optional<double> CsvTable::number(const Row& row, std::string_view column) const {
  const std::optional<std::string> cell = text(row, column);
  if (!cell) return {};
  const std::optional<double> x = finite_number(*cell);
  if (!x) throw Error("'" + *cell + "' is no finite number", row.place, std::string(column));
  return x;
}

}  // namespace geoprior
