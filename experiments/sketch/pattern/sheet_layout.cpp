#include "experiments/sketch/pattern/sheet_layout.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <string>

#include "core/error.h"
#include "experiments/sketch/pattern/notches.h"
#include "experiments/sketch/pattern/piece_drawing.h"
#include "experiments/sketch/pattern/sheet_text.h"
#include "models/sketch/pattern/piece_border.h"

namespace geoprior::sketch {
namespace {

constexpr double kSheetTitle = 6;    // height of the title (mm)
constexpr double kSheetNote = 3.5;   // height of the line below it (mm)
constexpr double kSheetFooter = 20;  // title, note and scale bar (mm)
constexpr double kBarText = 25;      // room for "100 mm" beside the bar (mm)

std::u32string widened_ascii(std::string_view ascii) { return {ascii.begin(), ascii.end()}; }

std::string millimetres_text(double x) {
  std::array<char, 32> buffer{};
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::general, 4);
  return std::string(buffer.data(), end.ptr) + " mm";
}

/// Rows from the bottom up, highest pieces first; gives the sheet's size.
void place_sheet_pieces(PatternSheet& sheet, const SheetOptions& options) {
  const double gap = options.gap_mm;
  double area = 0, widest = kScaleBar + kBarText;
  for (const SheetPiece& piece : sheet.pieces) {
    if (piece.refused) continue;
    area += (piece.size.x() + gap) * (piece.size.y() + gap);
    widest = std::max(widest, piece.size.x());
  }
  const double row = std::max({options.width_mm - 2 * gap, widest, std::sqrt(1.3 * area)});
  std::vector<std::size_t> order(sheet.pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sheet.pieces[a].size.y() > sheet.pieces[b].size.y();
  });
  double x = gap, y = kSheetFooter + 2 * gap, highest = 0, right = gap + kScaleBar + kBarText;
  for (const std::size_t k : order) {
    SheetPiece& piece = sheet.pieces[k];
    if (piece.refused) continue;
    if (x > gap && x + piece.size.x() > gap + row) {
      y += highest + gap;
      x = gap;
      highest = 0;
    }
    piece.place = {x, y};
    x += piece.size.x() + gap;
    highest = std::max(highest, piece.size.y());
    right = std::max(right, x - gap);
  }
  sheet.size = {std::max(right + gap, options.width_mm), y + highest + gap};
}

void draw_scale_bar(PatternSheet& sheet, const Eigen::Vector2d& at) {
  sheet.lines.push_back({SheetLayer::text, false, {at, at + Eigen::Vector2d(kScaleBar, 0)}});
  for (int i = 0; i <= 10; ++i) {
    const Eigen::Vector2d foot = at + Eigen::Vector2d(i * kScaleBar / 10, 0);
    sheet.lines.push_back(
        {SheetLayer::text, false, {foot, foot + Eigen::Vector2d(0, i % 5 == 0 ? 4 : 2)}});
  }
  const std::u32string length = widened_ascii(millimetres_text(kScaleBar));
  sheet.texts.push_back({at + Eigen::Vector2d(kScaleBar + 3, 2), 4, length, TextAnchor::left});
}

/// Begins at the left margin, set smaller where the sheet is too narrow for it.
void write_sheet_line(PatternSheet& sheet, const Eigen::Vector2d& left, double height,
                      const std::u32string& text) {
  if (text.empty()) return;
  const double width = helvetica_width(text);
  const double h = std::min(height, (sheet.size.x() - 2 * left.x()) / (1.15 * width));
  sheet.texts.push_back({left, h, text, TextAnchor::left});
}

std::string count_of_pieces(const PatternSheet& sheet) {
  const auto n = std::ssize(sheet.pieces);
  const auto refused = std::count_if(sheet.pieces.begin(), sheet.pieces.end(),
                                     [](const SheetPiece& piece) { return piece.refused; });
  const std::string all = std::to_string(n) + (n == 1 ? " piece" : " pieces");
  return refused == 0 ? all : std::to_string(n - refused) + " of " + all;
}

/// Places what is drawn, and writes and draws what is below it.
void finish_sheet(PatternSheet& sheet, const SheetOptions& options) {
  place_sheet_pieces(sheet, options);
  const Eigen::Vector2d corner(options.gap_mm, options.gap_mm);
  draw_scale_bar(sheet, corner);
  write_sheet_line(sheet, corner + Eigen::Vector2d(0, 15), kSheetTitle, sheet.title);
  write_sheet_line(sheet, corner + Eigen::Vector2d(0, 8), kSheetNote,
                   widened_ascii("Seam allowance " + millimetres_text(options.allowance_mm) +
                                 ", hem " + millimetres_text(options.hem_mm) + ", " +
                                 count_of_pieces(sheet) + ", true scale"));
}

/// The sheet of pieces that `draw(piece, notches)` gives.
template <class Draw>
PatternSheet sheet_of(const Pattern& pattern, const SheetOptions& options, const Draw& draw) {
  require_drawable(pattern);
  const std::vector<Notch> notches =
      paired_notches(pattern, {.spacing = options.notch_spacing_mm / 1000});
  PatternSheet sheet;
  sheet.title = label_text(options.title, 80);
  for (int k = 0; k < std::ssize(pattern.pieces); ++k) sheet.pieces.push_back(draw(k, notches));
  finish_sheet(sheet, options);
  return sheet;
}

}  // namespace

PatternSheet pattern_sheet(const Pattern& pattern, const SheetOptions& options) {
  return sheet_of(pattern, options, [&](int k, const std::vector<Notch>& notches) {
    return draw_piece(pattern, k, notches, options);
  });
}

PatternSheet judged_sheet(const Pattern& pattern, const SheetOptions& options, bool force,
                          std::vector<PieceVerdict>& verdicts) {
  return sheet_of(pattern, options, [&](int k, const std::vector<Notch>& notches) {
    PieceVerdict& verdict = verdicts[k];
    if (force) verdict.refused.clear();
    SheetPiece drawn;
    if (verdict.refused.empty()) {
      try {
        drawn = draw_piece(pattern, k, notches, options, label_text(short_verdict(verdict), 80));
      } catch (const Error& error) {
        verdict.refused = std::string("cannot be drawn: ") + error.what();
      }
    }
    drawn.refused = !verdict.refused.empty();
    drawn.name = pattern.pieces[k].name;
    drawn.label = label_text(drawn.name, 40);
    return drawn;
  });
}

}  // namespace geoprior::sketch
