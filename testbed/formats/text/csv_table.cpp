#include "testbed/formats/text/csv_table.h"

#include <algorithm>

#include "core/error.h"
#include "testbed/formats/text/letters.h"
#include "testbed/formats/text/lines.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior {
namespace {

constexpr std::string_view kCellBlank = " \t";

/// Goes through the rows of a text, quotes and comments understood.
class CsvScan {
 public:
  CsvScan(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// Semicolon, comma or tab: the first of them that stands outside of quotes in the first line
  /// with words.
  [[nodiscard]] char separator() const {
    bool semicolon = false, comma = false, tab = false, quoted = false, words = false;
    for (std::size_t at = 0; at < text_.size(); ++at) {
      const char c = text_[at];
      if (c == '"') quoted = !quoted;
      if (quoted) continue;
      if (c == '#') at = std::min(text_.find('\n', at), text_.size()) - 1;
      if (c == '\n' && words) break;
      semicolon = semicolon || c == ';';
      comma = comma || c == ',';
      tab = tab || (c == '\t' && words);
      words = words || (c != '#' && c != '\n' && kCellBlank.find(c) == std::string_view::npos);
    }
    if (semicolon) return ';';
    return comma || !tab ? ',' : '\t';
  }

  /// The cells of the next row, empty for a line without words; false at the end.
  bool next(char separator, std::vector<std::string>& cells) {
    cells.clear();
    if (at_ >= text_.size()) return false;
    row_line_ = line_;
    do {
      cells.push_back(cell(separator));
    } while (ended_by(separator));
    at_ = std::min(text_.find('\n', at_), text_.size());  // behind a comment
    if (at_ < text_.size()) {
      ++at_;
      ++line_;
    }
    if (cells.size() == 1 && cells[0].empty()) cells.clear();
    return true;
  }
  [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(row_line_); }

 private:
  [[nodiscard]] bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }

  bool ended_by(char separator) {
    if (!next_is(separator)) return false;
    ++at_;
    return true;
  }

  std::string cell(char separator) {
    skip_blanks(separator);
    if (!next_is('"')) return bare(separator);
    std::string text = quoted();
    skip_blanks(separator);
    const bool ends = at_ >= text_.size() || next_is(separator) || next_is('\n') || next_is('#');
    if (!ends) throw Error("has a cell that goes on behind its quotes", place(), "\"a \"\" b\"");
    return text;
  }

  void skip_blanks(char separator) {
    while (at_ < text_.size() && kCellBlank.find(text_[at_]) != std::string_view::npos &&
           text_[at_] != separator)
      ++at_;
  }

  std::string bare(char separator) {
    const char ends[] = {separator, '\n', '#'};
    const std::size_t end = std::min(text_.find_first_of({ends, sizeof ends}, at_), text_.size());
    const std::string_view text = text_.substr(at_, end - at_);
    at_ = end;
    return std::string(text.substr(0, text.find_last_not_of(kCellBlank) + 1));
  }

  std::string quoted() {
    std::string text;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"' && text_.substr(at_ + 1, 1) != "\"") {
        ++at_;
        return text;
      }
      if (text_[at_] == '"') ++at_;
      if (text_[at_] == '\n') ++line_;
      text.push_back(text_[at_]);
    }
    throw Error("has quotes that are not closed", place());
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1, row_line_ = 1;
};

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
                   const std::vector<std::string_view>& optional, Others others)
    : columns_(required.begin(), required.end()), required_(required.size()) {
  columns_.insert(columns_.end(), optional.begin(), optional.end());
  const std::string text = read_text_file(file);
  const std::string name = file.string();
  CsvScan scan(text, name);
  separator_ = scan.separator();
  std::size_t width = 0;
  std::vector<std::string> cells;
  while (scan.next(separator_, cells)) {
    if (cells.empty()) continue;
    if (at_.empty()) {
      read_header(cells, scan.place(), others);
      width = cells.size();
      continue;
    }
    rows_.push_back({cells, scan.place()});
    require_no_more_cells(rows_.back(), width);
  }
  if (at_.empty()) throw Error("is empty", name, "a line of columns, then rows");
}

void CsvTable::read_header(const std::vector<std::string>& header, const std::string& place,
                           Others others) {
  at_.resize(columns_.size());
  for (std::size_t i = 0; i < header.size(); ++i) {
    const auto named = std::find_if(columns_.begin(), columns_.end(), [&](const auto& column) {
      return lower(column) == lower(header[i]);
    });
    if (named == columns_.end()) {
      if (others == Others::left_out || header[i].empty()) continue;
      columns_.push_back(header[i]);
      others_.push_back(header[i]);
      at_.emplace_back(i);
      continue;
    }
    std::optional<std::size_t>& at = at_[named - columns_.begin()];
    if (at) throw Error("names the column '" + header[i] + "' twice", place, "each once");
    at = i;
  }
  for (std::size_t k = 0; k < required_; ++k) {
    if (at_[k]) continue;
    throw Error("names no column '" + columns_[k] + "'", place, known(columns_, required_));
  }
}

/// More cells than columns are numbers with decimal commas between commas, as often as not.
void CsvTable::require_no_more_cells(const Row& row, std::size_t columns) const {
  std::size_t cells = row.cells.size();
  while (cells > columns && row.cells[cells - 1].empty()) --cells;
  if (cells <= columns) return;
  throw Error(
      "has " + std::to_string(cells) + " cells below " + std::to_string(columns) + " columns",
      row.place,
      separator_ == ',' ? "a cell a column; numbers with decimal commas need ';' between "
                          "columns, also in the first line"
                        : "a cell a column");
}

std::optional<std::string> CsvTable::text(const Row& row, std::string_view column) const {
  const auto named = std::find(columns_.begin(), columns_.end(), column);
  if (named == columns_.end()) {
    throw Error("column '" + std::string(column) + "' was not asked for", row.place);
  }
  const std::size_t k = named - columns_.begin();
  if (!at_[k]) return {};
  if (*at_[k] >= row.cells.size()) {
    throw Error("has no " + *named, row.place, "a row as long as the first");
  }
  const std::string& cell = row.cells[*at_[k]];
  if (!cell.empty()) return cell;
  if (k < required_) throw Error("has no " + *named, row.place, "no empty cell in this column");
  return {};
}

std::optional<double> CsvTable::number(const Row& row, std::string_view column) const {
  const std::optional<std::string> cell = text(row, column);
  if (!cell) return {};
  std::string word = *cell;
  if (separator_ == ';' && word.find('.') == std::string::npos) {
    std::replace(word.begin(), word.end(), ',', '.');
  }
  const std::optional<double> x = finite_number(word);
  if (!x) {
    throw Error("'" + *cell + "' is no finite number",
                row.place + ": column '" + std::string(column) + "'");
  }
  return x;
}

}  // namespace geoprior
