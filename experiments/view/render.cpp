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

/// Rows of one part, under one camera and one colour range, with their bar or legend.
struct Block {
  FigureView view;
  std::vector<FigureRow> rows;
  std::vector<DrawnRow> lines;
  ViewWindow window;
  PanelStyle style;
  OverlayColors colors;
  std::vector<LegendEntry> legend;
  Layout layout;

  [[nodiscard]] bool has_bar() const { return style.scale && style.scale->classes.empty(); }
};

Block make_block(const RunRecord& record, const fs::path& folder, const FigureView& view) {
  Block block;
  block.view = view;
  block.rows = collect_cells(record, folder, view);
  if (block.rows.empty() || all_parts(block.rows, false).empty()) {
    throw Error("the run has no frames to draw", folder.string());
  }
  return block;
}

/// After the rows are where they stay.
void lay_out(Block& block) {
  block.window = fit_window(all_parts(block.rows, true), block.view);
  block.style = panel_style(block.rows, block.view);
  block.colors = overlay_colors(block.rows, block.view.overlays);
  block.legend = legend_entries(block.rows, block.view);
  block.lines = drawn_rows(block.rows, block.view.section.has_value());
  block.layout = make_layout(block.lines, block.window);
  block.layout.height +=
      block.has_bar() ? kBarHeight : legend_height(block.legend, block.layout.width);
}

FigureView view_above(const FigureView& view) {
  FigureView above = view;
  above.part = view.above->part;
  above.color_by = view.above->color_by;
  above.classes = view.above->classes;
  above.direction = view.above->direction;
  above.up = view.above->up;
  above.height_m = view.above->height_m;
  above.target.reset();
  above.section.reset();
  above.overlays.clear();
  above.above.reset();
  return above;
}

/// Whether two rows name their cells alike.
bool same_headings(const FigureRow& a, const FigureRow& b) {
  return std::equal(
      a.cells.begin(), a.cells.end(), b.cells.begin(), b.cells.end(),
      [](const FigureCell& one, const FigureCell& other) { return one.label == other.label; });
}

/// What is drawn, from top to bottom. With two blocks every row says what it shows.
std::vector<Block> make_blocks(const RunRecord& record, const fs::path& folder,
                               const FigureView& view) {
  std::vector<Block> blocks;
  if (view.above) blocks.push_back(make_block(record, folder, view_above(view)));
  blocks.push_back(make_block(record, folder, view));
  if (view.above && same_headings(blocks.front().rows.back(), blocks.back().rows.front())) {
    blocks.back().rows.front().has_headings = false;
  }
  for (Block& block : blocks) {
    for (FigureRow& row : block.rows) {
      if (blocks.size() == 1) continue;
      row.label = display_name(block.view.part) + (row.label.empty() ? "" : ", ") + row.label;
    }
    lay_out(block);
  }
  return blocks;
}

void draw_block(Picture& picture, const Block& block, int y) {
  const Layout& layout = block.layout;
  for (const DrawnRow& line : block.lines) {
    if (line.has_headings) y += kHeading;
    int x = layout.left;
    for (const FigureCell& cell : line.row->cells) {
      if (line.has_headings) {
        draw_text(picture, cell.label, x + layout.panel_width / 2, y - 20, Align::center,
                  fitted(cell.label, kHeadingStyle, layout.panel_width));
      }
      picture.paste(draw_cell(cell, line.is_section, block.view, block.window, block.style,
                              block.colors, layout),
                    x, y);
      x += layout.panel_width + kGap;
    }
    draw_text(picture, line.label, kMargin + kRowLabel / 2, y + layout.panel_height / 2,
              Align::center, fitted(line.label, kRowStyle, layout.panel_height));
    y += layout.panel_height + kGap;
  }
  if (block.has_bar()) {
    draw_scalar_bar(picture, *block.style.scale, y + kGap);
  } else {
    draw_legend(picture, block.legend, y + kGap);
  }
}

Picture draw_figure(const std::vector<Block>& blocks) {
  int width = 0;
  int height = 0;
  for (const Block& block : blocks) {
    width = std::max(width, block.layout.width);
    height += block.layout.height;
  }
  Picture picture(width, height);
  int y = kMargin;
  for (const Block& block : blocks) {
    draw_block(picture, block, y);
    y += block.layout.height;
  }
  return picture;
}

}  // namespace

void render_run(const fs::path& run_folder, const FigureView& view) {
  const RunRecord record = read_run_file(run_folder / "run.h5");
  const std::vector<Block> blocks = make_blocks(record, run_folder, view);
  const Display display;
  write_png(draw_figure(blocks), run_folder / "figure.png");
}

}  // namespace geoprior
