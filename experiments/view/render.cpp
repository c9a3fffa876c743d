// Lays out figure.png: rows of panels, headings, row labels, a scalar bar or a legend.

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "experiments/view/display.h"
#include "experiments/view/figure_cells.h"
#include "experiments/view/legend.h"
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
      for (const NamedPart& overlay : cell.overlays) parts.push_back(&overlay.part);
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

/// All but the height of the scalar bar or the legend.
Layout make_layout(const std::vector<DrawnRow>& rows, const ViewWindow& window) {
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
  layout.height = 2 * kMargin;
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
                  const ViewWindow& window, const PanelStyle& style, const OverlayColors& colors,
                  const Layout& layout) {
  if (!cell.part) {
    Picture empty(layout.panel_width, layout.panel_height);
    draw_text(empty, cell.note, layout.panel_width / 2, layout.panel_height / 2, Align::center,
              kNoteStyle);
    return empty;
  }
  if (is_section) {
    const ViewWindow plane = section_window(window, *view.section);
    return draw_section(cut(*cell.part, plane), plane, layout.panel_width, layout.panel_height);
  }
  PanelParts parts;
  parts.parts = {&*cell.part};
  for (const NamedPart& overlay : cell.overlays) {
    parts.overlays.push_back({&overlay.part, colors.at(overlay.name)});
  }
  if (cell.obstacles) parts.obstacles = {&*cell.obstacles};
  return draw_panel(parts, window, style, layout.panel_width, layout.panel_height);
}

PanelStyle::Material panel_material(FigureView::Material material) {
  switch (material) {
    case FigureView::Material::paper:
      return PanelStyle::Material::paper;
    case FigureView::Material::water:
      return PanelStyle::Material::water;
    case FigureView::Material::clay:
      break;
  }
  return PanelStyle::Material::clay;
}

PanelStyle panel_style(const std::vector<FigureRow>& rows, const FigureView& view) {
  PanelStyle style;
  style.flat = view.shading == FigureView::Shading::flat;
  style.edges = view.edges;
  style.material = panel_material(view.material);
  if (view.color_by) {
    const std::vector<const Part*> parts = all_parts(rows, false);
    style.scale = view.classes.empty() ? make_color_scale(all_parts(rows, true), *view.color_by)
                                       : make_class_scale(parts, *view.color_by, view.classes);
  }
  return style;
}

Picture draw_figure(const std::vector<FigureRow>& rows, const FigureView& view) {
  const ViewWindow window = fit_window(all_parts(rows, true), view);
  const PanelStyle style = panel_style(rows, view);
  const OverlayColors colors = overlay_colors(rows, view.overlays);
  const std::vector<LegendEntry> legend = legend_entries(rows, view);
  const bool has_bar = style.scale && style.scale->classes.empty();
  const std::vector<DrawnRow> lines = drawn_rows(rows, view.section.has_value());
  Layout layout = make_layout(lines, window);
  layout.height += has_bar ? kBarHeight : legend_height(legend, layout.width);
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
      picture.paste(draw_cell(cell, line.is_section, view, window, style, colors, layout), x, y);
      x += layout.panel_width + kGap;
    }
    draw_text(picture, line.label, kMargin + kRowLabel / 2, y + layout.panel_height / 2,
              Align::center, fitted(line.label, kRowStyle, layout.panel_height));
    y += layout.panel_height + kGap;
  }
  if (has_bar) {
    draw_scalar_bar(picture, *style.scale, y + kGap);
  } else {
    draw_legend(picture, legend, y + kGap);
  }
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
