#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "experiments/sketch/pattern/sheet.h"

namespace geoprior::sketch {

/// What a pattern is printed on.
enum class PaperFormat {
  sheet,   ///< one page as large as the pattern
  a4,      ///< 210 x 297 mm, upright
  letter,  ///< 215.9 x 279.4 mm, upright
};

/// Part of a pattern sheet on one page. Millimetres, right and up.
struct SheetPage {
  Eigen::Vector2d paper{0, 0};  ///< size of the page
  Eigen::AlignedBox2d window;   ///< what of the sheet it shows, in the sheet's coordinates
  Eigen::Vector2d place{0, 0};  ///< of the window's lower left corner on the page
  std::string label;  ///< "A1", "A2", … from the left, rows A, B, … from the top; or none
  std::vector<SheetLine> marks;  ///< in the sheet's coordinates, to join the pages
  std::vector<SheetText> texts;  ///< on the page

  /// A point of the sheet on the page.
  [[nodiscard]] Eigen::Vector2d on_page(const Eigen::Vector2d& p) const {
    return p - window.min() + place;
  }
};

struct TileOptions {
  PaperFormat paper = PaperFormat::sheet;
  double margin_mm = 10;   ///< that the printer leaves blank
  double overlap_mm = 10;  ///< of neighbouring pages
};

/// The sheet as one page as large as it is.
SheetPage whole_sheet(const PatternSheet& sheet);

/// Divides a sheet into pages that overlap. Every page shows a frame around what it prints and, in
/// each strip that it shares with a neighbour, two crosses that come to lie upon the neighbour's.
///
/// @return        rows from the top, each from the left; the sheet itself for PaperFormat::sheet
/// @throws Error  when margins and overlap leave nothing of the paper, or the pages are too many
std::vector<SheetPage> sheet_pages(const PatternSheet& sheet, const TileOptions& options);

/// How many pages of a window of length `window` cover `length` when neighbours overlap.
int tile_count(double length, double window, double overlap);

}  // namespace geoprior::sketch
