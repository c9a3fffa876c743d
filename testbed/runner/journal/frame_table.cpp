#include "testbed/runner/journal/frame_table.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "core/error.h"

namespace geoprior {

namespace {

std::vector<std::string> split_header(const std::string& line, const std::string& where) {
  std::vector<std::string> names;
  std::size_t i = 0;
  while (i < line.size()) {
    if (line[i] != '"') throw Error("the first line is no line of quoted names", where);
    std::string& name = names.emplace_back();
    for (++i; i < line.size(); ++i) {
      if (line[i] == '"') {
        if (i + 1 >= line.size() || line[i + 1] != '"') break;
        ++i;
      }
      name += line[i];
    }
    i += 2;  // the closing quote and the comma
  }
  return names;
}

}  // namespace

std::string quoted_cell(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\n' || c == '\r') throw Error("a cell has a line break: " + text);
    if (c == '"') out += c;
    out += c;
  }
  return out + "\"";
}

std::string table_to_csv(const FrameTable& table) {
  const std::size_t columns = table.rows.cols();
  if (columns != table.columns.size() && table.rows.rows() > 0) {
    throw Error("a table has " + std::to_string(columns) + " columns and " +
                std::to_string(table.columns.size()) + " names");
  }
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (c > 0) text += ',';
    text += quoted_cell(table.columns[c]);
  }
  text += '\n';
  for (Eigen::Index row = 0; row < table.rows.rows(); ++row) {
    for (Eigen::Index c = 0; c < table.rows.cols(); ++c) {
      char number[40];
      const double x = table.rows(row, c);
      std::snprintf(number, sizeof number, "%.17g", std::isnan(x) ? std::fabs(x) : x);
      if (c > 0) text += ',';
      text += number;
    }
    text += '\n';
  }
  return text;
}

FrameTable table_from_csv(const std::string& text, const std::string& where) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  FrameTable table;
  table.columns = split_header(line, where);
  const std::size_t columns = table.columns.size();
  std::vector<double> values;
  std::size_t rows = 0;
  for (; std::getline(in, line); ++rows) {
    const char* at = line.c_str();
    for (std::size_t c = 0; c < columns; ++c) {
      char* end = nullptr;
      values.push_back(std::strtod(at, &end));
      if (end == at || *end != (c + 1 < columns ? ',' : '\0')) {
        throw Error(
            "line " + std::to_string(rows + 2) + " has no " + std::to_string(columns) + " numbers",
            where);
      }
      at = end + 1;
    }
  }
  table.rows =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          values.data(), rows, columns);
  return table;
}

}  // namespace geoprior
