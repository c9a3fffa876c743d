// Lays out figure.png: rows of panels, headings, row labels, a scalar bar.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "experiments/view/display.h"
#include "experiments/view/figure_cells.h"
#include "experiments/view/section.h"
#include "experiments/view/view.h"
#include "experiments/view/view_window.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr int kPictureWidth = 2400;
constexpr int kMostPanelWidth = 900;
constexpr int kMostPanelHeight = 1100;
constexpr int kMargin = 20;
constexpr int kGap = 14;         ///< between panels
constexpr int kHeading = 64;     ///< height of a line of variant names
constexpr int kRowLabel = 58;    ///< width of the row labels at the left
constexpr int kBarHeight = 120;  ///< the scalar bar with its labels
const TextStyle kHeadingStyle{36, {20, 20, 20}, true, false};
const TextStyle kRowStyle{30, {60, 60, 60}, false, true};
const TextStyle kBarStyle{26, {40, 40, 40}, false, false};
const TextStyle kNoteStyle{28, {130, 130, 130}, false, false};

/// One line of panels as it is drawn: shaded, or cut.
struct DrawnRow {
  const FigureRow* row = nullptr;
  bool is_section = false;
  std::string label;
  bool has_headings = false;
};

struct Layout {
  int panel_width = 0;
  int panel_height = 0;
  int columns = 0;
  int left = 0;
  int width = 0;
  int height = 0;
};

std::vector<const Part*> all_parts(const std::vector<FigureRow>& rows, bool with_overlays) {
  std::vector<const Part*> parts;
  for (const FigureRow& row : rows) {
    for (const FigureCell& cell : row.cells) {
      if (cell.part) parts.push_back(&*cell.part);
      if (!with_overlays) continue;
      for (const Part& overlay : cell.overlays) parts.push_back(&overlay);
    }
  }
  return parts;
}

std::vector<DrawnRow> drawn_rows(const std::vector<FigureRow>& rows, bool with_sections) {
  std::vector<DrawnRow> out;
  for (const FigureRow& row : rows) {
    out.push_back({&row, false, row.label, row.has_headings});
    if (with_sections) out.push_back({&row, true, "Section, overlap in red", false});
  }
  return out;
}

Layout make_layout(const std::vector<DrawnRow>& rows, const ViewWindow& window, bool has_bar) {
  Layout layout;
  for (const DrawnRow& row : rows) {
    layout.columns = std::max(layout.columns, static_cast<int>(row.row->cells.size()));
  }
  layout.left = kMargin + kRowLabel;
  const int room = kPictureWidth - layout.left - kMargin - (layout.columns - 1) * kGap;
  const double aspect = window.width_m / window.height_m;
  const double width =
      std::min({1.0 * room / layout.columns, 1.0 * kMostPanelWidth, kMostPanelHeight * aspect});
  layout.panel_width = std::max(2, static_cast<int>(width));
  layout.panel_height = std::max(2, static_cast<int>(std::lround(width / aspect)));
  layout.width =
      layout.left + layout.columns * layout.panel_width + (layout.columns - 1) * kGap + kMargin;
  layout.height = 2 * kMargin + (has_bar ? kBarHeight : 0);
  for (const DrawnRow& row : rows) {
    layout.height += layout.panel_height + kGap + (row.has_headings ? kHeading : 0);
  }
  return layout;
}

/// The largest size of `style`, at most its own, at which the text fits.
TextStyle fitted(const std::string& text, TextStyle style, int room) {
  while (style.size_px > 12 && text_width(text, style) > room) --style.size_px;
  return style;
}

Picture draw_cell(const FigureCell& cell, bool is_section, const FigureView& view,
                  const ViewWindow& window, const std::optional<ColorScale>& scale,
                  const Layout& layout) {
  if (!cell.part) {
    Picture empty(layout.panel_width, layout.panel_height);
    draw_text(empty, "no frame", layout.panel_width / 2, layout.panel_height / 2, Align::center,
              kNoteStyle);
    return empty;
  }
  if (is_section) {
    const ViewWindow plane = section_window(window, *view.section);
    return draw_section(cut(*cell.part, plane), plane, layout.panel_width, layout.panel_height);
  }
  std::vector<const Part*> parts{&*cell.part};
  for (const Part& overlay : cell.overlays) parts.push_back(&overlay);
  return draw_panel(parts, window, scale, layout.panel_width, layout.panel_height);
}

/// Steps of 1, 2 or 5 times a power of ten: about five of them.
double tick_step(double range) {
  const double raw = range / 5;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power * 1.0000001) return factor * power;
  }
  return 10 * power;
}

std::string tick_label(double value, double step) {
  std::array<char, 32> text{};
  if (std::abs(value) < 1e-9 * step) value = 0;
  std::snprintf(text.data(), text.size(), "%.6g", std::round(value / step) * step);
  return text.data();
}

void draw_pointed_end(Picture& picture, int x, int y, int height, int sign, Rgb color) {
  const int length = height * 3 / 4;
  for (int i = 0; i < length; ++i) {
    const int half = height * (length - i) / (2 * length);
    picture.fill_rectangle(sign > 0 ? x + i : x - 1 - i, y + height / 2 - half, 1, 2 * half, color);
  }
}

Rgb to_rgb(const std::array<double, 3>& color) {
  Rgb out{};
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0)));
  }
  return out;
}

/// A horizontal bar with ticks below and "name [unit]" at its left; pointed ends where values go on
/// beyond it.
void draw_scalar_bar(Picture& picture, const ColorScale& scale, int top) {
  constexpr int kThickness = 28;
  const int length = std::min(1000, picture.width / 2);
  const int left = (picture.width - length) / 2 + picture.width / 12;
  for (int x = 0; x < length; ++x) {
    picture.fill_rectangle(left + x, top, 1, kThickness,
                           to_rgb(color_at((x + 0.5) / length, scale.diverging)));
  }
  if (scale.below) {
    draw_pointed_end(picture, left, top, kThickness, -1, to_rgb(color_at(0, scale.diverging)));
  }
  if (scale.above) {
    draw_pointed_end(picture, left + length, top, kThickness, 1,
                     to_rgb(color_at(1, scale.diverging)));
  }
  const double step = tick_step(scale.high - scale.low);
  for (double v = std::ceil(scale.low / step - 1e-9) * step; v <= scale.high + 1e-9 * step;
       v += step) {
    const int x =
        left + static_cast<int>(std::lround((v - scale.low) / (scale.high - scale.low) * length));
    picture.fill_rectangle(x - 1, top + kThickness, 2, 8, kBarStyle.color);
    draw_text(picture, tick_label(v, step), x, top + kThickness + 40, Align::center, kBarStyle);
  }
  std::string title = display_name(scale.array);
  if (!scale.unit.empty() && scale.unit != "1") title += " [" + scale.unit + "]";
  draw_text(picture, title, left - 40, top + kThickness - 4, Align::right, kBarStyle);
}

Picture draw_figure(const std::vector<FigureRow>& rows, const FigureView& view) {
  const ViewWindow window = fit_window(all_parts(rows, true), view);
  std::optional<ColorScale> scale;
  if (view.color_by) scale = make_color_scale(all_parts(rows, true), *view.color_by);
  const std::vector<DrawnRow> lines = drawn_rows(rows, view.section.has_value());
  const Layout layout = make_layout(lines, window, scale.has_value());
  Picture picture(layout.width, layout.height);
  int y = kMargin;
  for (const DrawnRow& line : lines) {
    if (line.has_headings) y += kHeading;
    int x = layout.left;
    for (const FigureCell& cell : line.row->cells) {
      if (line.has_headings) {
        draw_text(picture, cell.label, x + layout.panel_width / 2, y - 20, Align::center,
                  fitted(cell.label, kHeadingStyle, layout.panel_width));
      }
      picture.paste(draw_cell(cell, line.is_section, view, window, scale, layout), x, y);
      x += layout.panel_width + kGap;
    }
    draw_text(picture, line.label, kMargin + kRowLabel / 2, y + layout.panel_height / 2,
              Align::center, fitted(line.label, kRowStyle, layout.panel_height));
    y += layout.panel_height + kGap;
  }
  if (scale) draw_scalar_bar(picture, *scale, y + kGap);
  return picture;
}

}  // namespace

void render_run(const fs::path& run_folder, const FigureView& view) {
  const RunRecord record = read_run_file(run_folder / "run.h5");
  const std::vector<FigureRow> rows = collect_cells(record, run_folder, view);
  if (rows.empty() || all_parts(rows, false).empty()) {
    throw Error("the run has no frames to draw", run_folder.string());
  }
  const Display display;
  write_png(draw_figure(rows, view), run_folder / "figure.png");
}

}  // namespace geoprior
