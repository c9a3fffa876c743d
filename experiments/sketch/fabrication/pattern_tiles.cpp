#include "experiments/sketch/fabrication/pattern_tiles.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

constexpr double kLargestPage = 5080;  // mm: 14400 points, the most that PDF 1.4 allows
constexpr int kMostPages = 2000;
constexpr double kCrossSize = 0.35;  // half a registration cross, of the overlap

/// A, B, … Z, AA, AB, …
std::string tile_row_letters(int row) {
  std::string letters;
  for (int k = row; k >= 0; k = k / 26 - 1) {
    letters.insert(letters.begin(), static_cast<char>('A' + k % 26));
  }
  return letters;
}

/// Rows and columns of pages over a sheet.
struct TileGrid {
  Eigen::Vector2d paper, window, step;
  double overlap;
  int rows, columns;

  /// Row 0 ends at the sheet's upper edge.
  [[nodiscard]] Eigen::AlignedBox2d window_of(int row, int column, double top) const {
    const Eigen::Vector2d corner(column * step.x(), top - window.y() - row * step.y());
    return {corner, Eigen::Vector2d(corner + window)};
  }
};

TileGrid tile_grid(const PatternSheet& sheet, const TileOptions& options) {
  TileGrid grid;
  grid.paper =
      options.paper == PaperFormat::a4 ? Eigen::Vector2d(210, 297) : Eigen::Vector2d(215.9, 279.4);
  grid.overlap = options.overlap_mm;
  grid.window = grid.paper.array() - 2 * options.margin_mm;
  grid.step = grid.window.array() - grid.overlap;
  if (!(options.margin_mm >= 0 && grid.overlap >= 0 && grid.step.minCoeff() >= 20)) {
    throw Error("margins and overlap leave too little of the paper", "tiles",
                "20 mm or more, and neither negative");
  }
  grid.columns = tile_count(sheet.size.x(), grid.window.x(), grid.overlap);
  grid.rows = tile_count(sheet.size.y(), grid.window.y(), grid.overlap);
  if (static_cast<double>(grid.rows) * grid.columns > kMostPages) {
    throw Error("the pattern needs " + std::to_string(grid.rows) + " x " +
                    std::to_string(grid.columns) + " pages",
                "tiles", "at most " + std::to_string(kMostPages));
  }
  return grid;
}

void add_tile_cross(const Eigen::Vector2d& at, double size, std::vector<SheetLine>& marks) {
  for (const Eigen::Vector2d& arm : {Eigen::Vector2d(size, 0), Eigen::Vector2d(0, size)}) {
    marks.push_back({SheetLayer::text, false, {at - arm, at + arm}});
  }
}

/// The frame, and crosses in the middle of the strips that are shared with neighbours.
std::vector<SheetLine> tile_marks(const TileGrid& grid, const Eigen::AlignedBox2d& window, int row,
                                  int column) {
  const Eigen::Vector2d a = window.min(), c = window.max();
  std::vector<SheetLine> marks{{SheetLayer::text, true, {a, {c.x(), a.y()}, c, {a.x(), c.y()}}}};
  const double half = grid.overlap / 2, size = kCrossSize * grid.overlap;
  for (const double share : {0.25, 0.75}) {
    const double x = a.x() + share * grid.window.x(), y = a.y() + share * grid.window.y();
    if (column > 0) add_tile_cross({a.x() + half, y}, size, marks);
    if (column + 1 < grid.columns) add_tile_cross({c.x() - half, y}, size, marks);
    if (row + 1 < grid.rows) add_tile_cross({x, a.y() + half}, size, marks);
    if (row > 0) add_tile_cross({x, c.y() - half}, size, marks);
  }
  return marks;
}

/// In the lower margin, or just inside of it when there is hardly one.
SheetText tile_page_label(const SheetPage& page, const PatternSheet& sheet, int number, int count) {
  const std::string text =
      page.label + "   page " + std::to_string(number) + " of " + std::to_string(count);
  std::u32string line(text.begin(), text.end());
  if (!sheet.title.empty()) line += U"   " + sheet.title.substr(0, 40);
  const double height = 3.5;
  return {{page.place.x(), page.place.y() >= 6 ? page.place.y() / 2 : page.place.y() + 4},
          height,
          line,
          TextAnchor::left};
}

}  // namespace

int tile_count(double length, double window, double overlap) {
  // A page for less than a thousandth of a millimetre would be blank.
  const double pages = std::ceil((length - overlap - 1e-3) / (window - overlap));
  return static_cast<int>(std::clamp(pages, 1.0, 1e6));
}

SheetPage whole_sheet(const PatternSheet& sheet) {
  SheetPage page;
  page.paper = sheet.size;
  page.window = {Eigen::Vector2d(0, 0), sheet.size};
  return page;
}

std::vector<SheetPage> sheet_pages(const PatternSheet& sheet, const TileOptions& options) {
  if (options.paper == PaperFormat::sheet) {
    if (sheet.size.maxCoeff() > kLargestPage) {
      throw Error(
          "the sheet is longer than " + std::to_string(static_cast<int>(kLargestPage)) + " mm",
          "page", "paper a4 or letter");
    }
    return {whole_sheet(sheet)};
  }
  const TileGrid grid = tile_grid(sheet, options);
  std::vector<SheetPage> pages;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      SheetPage page;
      page.paper = grid.paper;
      page.window = grid.window_of(row, column, sheet.size.y());
      page.place.setConstant(options.margin_mm);
      page.label = tile_row_letters(row) + std::to_string(column + 1);
      page.marks = tile_marks(grid, page.window, row, column);
      page.texts.push_back(tile_page_label(page, sheet, static_cast<int>(pages.size()) + 1,
                                           grid.rows * grid.columns));
      pages.push_back(std::move(page));
    }
  }
  return pages;
}

}  // namespace geoprior::sketch
