#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// A file of rows of cells below a line that names the columns, as spreadsheets write it.
///
/// - Cells are separated by commas; by semicolons where that line has one outside of quotes, and a
///   number may then have a decimal comma; by tabs where it has neither.
/// - Blanks around cells do not count. A cell in double quotes may hold separators, `#`, line ends
///   and, doubled, quotes (RFC 4180).
/// - Outside of quotes `#` begins a comment. Names of columns are compared without regard to case,
///   and columns that nobody asks for are not read.
class CsvTable {
 public:
  /// What becomes of the columns that nobody asked for.
  enum class Others { left_out, read };

  struct Row {
    std::vector<std::string> cells;
    std::string place;  ///< "file:line"
  };

  /// @param required  columns that the file must name
  /// @param optional  that it may name
  /// @throws Error    naming file and line: unreadable, empty, a column that is missing or is there
  ///                  twice, a row with more cells than columns, quotes that are not closed
  CsvTable(const std::filesystem::path& file, const std::vector<std::string_view>& required,
           const std::vector<std::string_view>& optional, Others others = Others::left_out);

  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// The other columns that are read, in the order of the file; their names as they stand there.
  [[nodiscard]] const std::vector<std::string>& others() const { return others_; }
  /// The cell of a column, one of those named to the constructor, or of the others; absent when it
  /// is optional and the file has no such column, or the cell is empty.
  /// @throws Error  for a row that is too short, and an empty cell of a required column
  [[nodiscard]] std::optional<std::string> text(const Row& row, std::string_view column) const;
  /// The same as a number. @throws Error  also for a word that is no finite number
  [[nodiscard]] std::optional<double> number(const Row& row, std::string_view column) const;

 private:
  void read_header(const std::vector<std::string>& header, const std::string& place, Others others);
  void require_no_more_cells(const Row& row, std::size_t columns) const;

  std::vector<std::string> columns_;
  std::vector<std::string> others_;             ///< the last of `columns_`
  std::size_t required_;                        ///< of them
  std::vector<std::optional<std::size_t>> at_;  ///< of each column in a row
  std::vector<Row> rows_;
  char separator_ = ',';
};

}  // namespace geoprior
