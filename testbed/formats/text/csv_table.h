#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace geoprior {

/// A file of rows of comma-separated cells below a line that names the columns. Blanks around cells
/// do not count, `#` begins a comment, and columns that nobody asks for are not read.
class CsvTable {
 public:
  struct Row {
    std::vector<std::string> cells;
    std::string place;  ///< "file:line"
  };

  /// @param required  columns that the file must name
  /// @param optional  that it may name
  /// @throws Error    naming file and line: unreadable, empty, a column that is missing or is there
  ///                  twice
  CsvTable(const std::filesystem::path& file, const std::vector<std::string_view>& required,
           const std::vector<std::string_view>& optional);

  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// The cell of a column, one of those named to the constructor; absent when the file has no such
  /// column. @throws Error  for a row that is too short
  [[nodiscard]] std::optional<std::string> text(const Row& row, std::string_view column) const;
  /// The same as a number. @throws Error  also for a word that is no finite number
  [[nodiscard]] std::optional<double> number(const Row& row, std::string_view column) const;

 private:
  void read_header(const std::vector<std::string>& header, const std::string& place,
                   std::size_t required);

  std::vector<std::string> columns_;
  std::vector<std::optional<std::size_t>> at_;  ///< of each column in a row
  std::vector<Row> rows_;
};

}  // namespace geoprior
