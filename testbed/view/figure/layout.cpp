// Lays out a figure: rows of panels, headings, row labels, a scalar bar or a legend.

#include "testbed/view/figure/layout.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/runner/inputs/run_reference.h"
#include "testbed/runner/process/stop.h"
#include "testbed/runner/run_folder.h"
#include "testbed/view/figure/named_values.h"
#include "testbed/view/panel/drawable.h"
#include "testbed/view/panel/section.h"
#include "testbed/view/view_window.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;

constexpr int kPictureWidth = 2400;
constexpr int kMostPanelWidth = 900;
constexpr int kMostPanelHeight = 1100;
constexpr int kFigureMargin = 20;
constexpr int kPanelGap = 14;                  ///< between panels
constexpr int kPatternGap = 24;                ///< between a sheet and its pattern
constexpr int kPatternMargin = kPanelGap / 2;  ///< about a pattern, for points on its border
constexpr int kColumnGap = 60;                 ///< between a pattern and the next sheet
constexpr int kHeading = 64;                   ///< height of a line of variant names
constexpr int kRowLabel = 58;                  ///< width of the row labels at the left
constexpr int kBarHeight = 120;                ///< the scalar bar with its labels
const TextStyle kHeadingStyle{36, {20, 20, 20}, true, false};
const TextStyle kRowStyle{30, {60, 60, 60}, false, true};
const TextStyle kNoteStyle{28, {130, 130, 130}, false, false};

/// How a panel shows its cell: as the view says, in plain material, or cut.
enum class Showing { as_viewed, plain, section };

struct DrawnPanel {
  const FigureCell* cell = nullptr;
  Showing showing = Showing::as_viewed;
  std::string heading;
};

/// One line of panels as it is drawn.
struct DrawnRow {
  std::vector<DrawnPanel> panels;
  std::string label;
  bool has_headings = false;
};

/// Where a flat pattern stands: at the right of a panel and of those of the same cell under it, a
/// margin higher than they are on either side.
struct PatternPlace {
  int width = 0;
  int height = 0;
  double pixels_per_metre = 1;
};

struct Layout {
  int panel_width = 0;
  int panel_height = 0;
  std::optional<PatternPlace> pattern;
  int columns = 0;
  int column_width = 0;
  int column_gap = kPanelGap;
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

DrawnRow drawn_row(const FigureRow& row, Showing showing, const std::string& label) {
  DrawnRow out{{}, label, showing == Showing::as_viewed && row.has_headings};
  for (const FigureCell& cell : row.cells) out.panels.push_back({&cell, showing, cell.label});
  return out;
}

/// Plain panels are under the others; beside them where these are a single column without patterns.
std::vector<DrawnRow> drawn_rows(const FigureBlock& block) {
  const std::vector<FigureRow>& rows = block.rows;
  const bool one_column = !block.look.pattern &&
                          std::all_of(rows.begin(), rows.end(),
                                      [](const FigureRow& row) { return row.cells.size() == 1; });
  std::vector<DrawnRow> out;
  for (const FigureRow& row : rows) {
    out.push_back(drawn_row(row, Showing::as_viewed, row.label));
    if (block.view.plain && one_column) {
      out.back().panels.push_back({&row.cells.front(), Showing::plain, "Plain"});
    } else if (block.view.plain) {
      out.push_back(
          drawn_row(row, Showing::plain, row.label.empty() ? "Plain" : row.label + ", plain"));
    }
    if (block.view.section) {
      out.push_back(drawn_row(row, Showing::section, "Section, overlap in red"));
    }
  }
  return out;
}

/// Cases and frames are rows of one picture.
void require_picture(double width, double height) {
  constexpr double kBytesPerPixel = 6;  // in memory, and while it is encoded
  require_memory(width * height * kBytesPerPixel, width * height, "pixels of a figure",
                 "figure_view");
}

/// Lines of panels that one cell has, under each other.
int lines_of_cell(const FigureView& view) {
  return 1 + (view.plain ? 1 : 0) + (view.section ? 1 : 0);
}

/// Width of the panels in columns of `room` pixels: a pattern at the scale of its sheet, or as high
/// as the panels of its cell, takes its part.
double panel_room(const FigureBlock& block, double room) {
  if (!block.look.pattern) return room;
  const ViewWindow& window = block.look.window;
  const PatternWindow& pattern = *block.look.pattern;
  const double scale =
      std::min(1.0, lines_of_cell(block.view) * window.height_m / pattern.height_m);
  return (room - kPatternGap - 2 * kPatternMargin) / (1 + scale * pattern.width_m / window.width_m);
}

PatternPlace pattern_place(const FigureBlock& block, const Layout& layout) {
  const PatternWindow& pattern = *block.look.pattern;
  const int lines = lines_of_cell(block.view);
  const int beside = lines * layout.panel_height + (lines - 1) * kPanelGap;
  const double scale =
      std::min(layout.panel_width / block.look.window.width_m, beside / pattern.height_m);
  const int width = static_cast<int>(pattern.width_m * scale);
  return {width + 2 * kPatternMargin, beside + 2 * kPatternMargin, scale};
}

/// Of a panel that shows the block's window.
int panel_height(const FigureBlock& block, double width) {
  const double aspect = block.look.window.width_m / block.look.window.height_m;
  return std::max(2, static_cast<int>(std::lround(width / aspect)));
}

/// All but the height of the scalar bar or the legend.
Layout make_layout(const std::vector<DrawnRow>& rows, const FigureBlock& block) {
  Layout layout;
  for (const DrawnRow& row : rows) {
    layout.columns = std::max(layout.columns, static_cast<int>(row.panels.size()));
  }
  layout.left = kFigureMargin + kRowLabel;
  if (block.look.pattern) layout.column_gap = kColumnGap;
  const int gaps = (layout.columns - 1) * layout.column_gap;
  const int room = kPictureWidth - layout.left - kFigureMargin - gaps;
  const double aspect = block.look.window.width_m / block.look.window.height_m;
  const double width = std::min({panel_room(block, 1.0 * room / layout.columns),
                                 1.0 * kMostPanelWidth, kMostPanelHeight * aspect});
  layout.panel_width = std::max(2, static_cast<int>(width));
  layout.panel_height = panel_height(block, width);
  layout.column_width = layout.panel_width;
  if (block.look.pattern) {
    layout.pattern = pattern_place(block, layout);
    layout.column_width += kPatternGap + layout.pattern->width;
  }
  layout.width = layout.left + layout.columns * layout.column_width + gaps + kFigureMargin;
  require_picture(layout.width,
                  static_cast<double>(rows.size()) * (layout.panel_height + kPanelGap + kHeading));
  layout.height = 2 * kFigureMargin;
  for (const DrawnRow& row : rows) {
    layout.height += layout.panel_height + kPanelGap + (row.has_headings ? kHeading : 0);
  }
  return layout;
}

/// The largest size of `style`, at most its own, at which the text fits.
TextStyle fitted(const std::string& text, TextStyle style, int room) {
  while (style.size_px > 12 && text_width(text, style) > room) --style.size_px;
  return style;
}

/// The look of the panels beside those that are coloured: a part with normals of its own is smooth.
PanelStyle plain_style(const PanelStyle& style, const Part& part) {
  PanelStyle plain;
  plain.material = style.material;
  plain.flat = !has_normals(part);
  plain.raking = true;
  return plain;
}

Picture draw_cell(const DrawnPanel& panel, const FigureView& view, const BlockLook& look,
                  const Layout& layout) {
  const FigureCell& cell = *panel.cell;
  if (!cell.part) {
    Picture empty(layout.panel_width, layout.panel_height);
    draw_text(empty, cell.note, layout.panel_width / 2, layout.panel_height / 2, Align::center,
              kNoteStyle);
    return empty;
  }
  if (panel.showing == Showing::section) {
    const ViewWindow plane = section_window(look.window, *view.section);
    return draw_section(cut(*cell.part, plane), plane, layout.panel_width, layout.panel_height);
  }
  PanelParts parts;
  parts.parts = {&*cell.part};
  if (cell.obstacles) parts.obstacles = {&*cell.obstacles};
  if (panel.showing == Showing::plain) {
    if (cell.plain) parts.parts = {&*cell.plain};
    return draw_panel(parts, look.window, plain_style(look.style, *parts.parts.front()),
                      layout.panel_width, layout.panel_height);
  }
  for (const NamedPart& overlay : cell.overlays) {
    parts.overlays.push_back(
        {&overlay.part, look.colors.at(overlay.name), overlay.name == kFibres});
  }
  Picture picture =
      draw_panel(parts, look.window, look.style, layout.panel_width, layout.panel_height);
  if (look.labels) {
    draw_value_labels(
        picture,
        seen_names(parts, look.window, look.labels->array, layout.panel_width, layout.panel_height),
        *look.labels);
  }
  return picture;
}

/// White where the sheet has no pattern, or is not there.
Picture draw_pattern_of(const FigureCell& cell, const FigureBlock& block,
                        const PatternPlace& place) {
  if (!cell.part || !has_pattern(*cell.part)) return {place.width, place.height};
  std::vector<PatternOverlay> overlays;
  for (const std::string& name : block.view.pattern) {
    for (const NamedPart& overlay : cell.overlays) {
      if (overlay.name != name) continue;
      overlays.push_back({name, &overlay.part, block.look.colors.at(name)});
    }
  }
  std::vector<Eigen::Vector2d> expected;
  if (block.view.expected) {
    for (const PlanePoint& p : block.view.expected->points) expected.emplace_back(p.u, p.v);
  }
  return draw_pattern(*cell.part, overlays, expected,
                      {block.look.pattern->center, place.pixels_per_metre}, place.width,
                      place.height);
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
  if (!view.color_by) return style;
  const std::vector<const Part*> parts = all_parts(rows, false);
  const bool on_water = style.material == PanelStyle::Material::water;
  if (view.identities) {
    style.scale = make_identity_scale(parts, *view.color_by, on_water);
  } else if (!view.classes.empty()) {
    style.scale = make_class_scale(parts, *view.color_by, view.classes, on_water);
  } else {
    style.scale = make_color_scale(all_parts(rows, true), *view.color_by);
  }
  return style;
}

bool has_bar(const BlockLook& look) {
  return look.style.scale && look.style.scale->palette.empty();
}

/// Makes room for the names at both sides of the window, as wide as the panels may become.
LabelColumns label_columns(const std::vector<FigureRow>& rows, const FigureView& view,
                           ViewWindow& window) {
  std::size_t columns = 1;
  for (const FigureRow& row : rows) columns = std::max(columns, row.cells.size());
  const int most_width =
      std::min(kMostPanelWidth, kPictureWidth / static_cast<int>(columns) - kPanelGap);
  return make_label_columns(view.labels, label_names(rows, view.labels), most_width,
                            kMostPanelHeight, window);
}

BlockLook make_look(const std::vector<FigureRow>& rows, const FigureView& view) {
  BlockLook look;
  look.window = fit_window(all_parts(rows, true), view);
  if (!view.labels.empty()) look.labels = label_columns(rows, view, look.window);
  look.style = panel_style(rows, view);
  look.colors = overlay_colors(rows, view.overlays);
  look.legend = legend_entries(rows, view);
  if (!view.pattern.empty()) look.pattern = fit_pattern(all_parts(rows, false));
  return look;
}

FigureBlock make_block(const OpenedRun& run, const FigureView& view, std::size_t most_columns) {
  FigureBlock block{view, collect_cells(run, view, most_columns), {}};
  if (block.rows.empty() || all_parts(block.rows, false).empty()) {
    throw Error("the run has no frames to draw", run.folder().string());
  }
  if (view.color_by && view.classes.empty() && !view.identities) {
    block.view.classes = unite_names(block.rows, *view.color_by);
    block.has_own_classes = !block.view.classes.empty();
  }
  block.look = make_look(block.rows, block.view);
  return block;
}

FigureView further_view(const FigureView& view, const FurtherRow& row) {
  FigureView further = view;
  further.part = row.part;
  further.label = row.label;
  further.color_by = row.color_by;
  further.classes = row.classes;
  further.labels = row.labels;
  further.identities = false;
  further.direction = row.direction;
  further.up = row.up;
  further.height_m = row.height_m;
  further.overlays = row.overlays;
  further.pattern.clear();
  further.expected.reset();
  if (!row.variants.empty()) further.variants = row.variants;
  if (!row.parameters.empty()) {
    further.at_parameter.reset();
    further.parameters = row.parameters;
  }
  further.target.reset();
  if (row.target.size() == 3) further.target = {row.target[0], row.target[1], row.target[2]};
  further.section.reset();
  further.plain = false;
  further.above.reset();
  further.below.reset();
  return further;
}

/// The same in all blocks, whose columns stand over each other.
std::size_t most_columns(const FigureView& view) {
  const auto has_labels = [](const std::optional<FurtherRow>& row) {
    return row && !row->labels.empty();
  };
  const bool labelled = !view.labels.empty() || has_labels(view.above) || has_labels(view.below);
  return labelled ? kMostLabelledColumns : kMostColumns;
}

std::optional<FigureBlock> make_further_block(const OpenedRun& run, const FigureView& view,
                                              const FurtherRow& row) {
  FigureView further = further_view(view, row);
  if (!row.input) {
    FigureBlock block = make_block(run, further, most_columns(view));
    for (FigureRow& cells : block.rows) cells.has_headings &= row.variants.empty();
    return block;
  }
  const std::vector<StoredFile>& inputs = run.record().inputs;
  const auto input = std::find_if(inputs.begin(), inputs.end(),
                                  [&](const auto& i) { return i.name == *row.input; });
  if (input == inputs.end()) return std::nullopt;
  const RunReference reference = parse_run_reference(input->name);
  const fs::path source = find_run_of_content(reference.experiment_id, input->sha256);
  further.variants = {reference.variant};
  further.cases = {reference.case_name};
  return make_block(OpenedRun(source, run.unverified()), further, most_columns(view));
}

int block_height(const FigureBlock& block, const Layout& layout) {
  return layout.height +
         (has_bar(block.look) ? kBarHeight : legend_height(block.look.legend, layout.width));
}

void draw_block(Picture& picture, const FigureBlock& block, const Layout& layout, int y) {
  for (const DrawnRow& line : drawn_rows(block)) {
    if (line.has_headings) y += kHeading;
    int x = layout.left;
    for (const DrawnPanel& panel : line.panels) {
      throw_if_stopped();
      if (line.has_headings) {
        draw_text(picture, panel.heading, x + layout.column_width / 2, y - 20, Align::center,
                  fitted(panel.heading, kHeadingStyle, layout.column_width));
      }
      picture.paste(draw_cell(panel, block.view, block.look, layout), x, y);
      if (layout.pattern && panel.showing == Showing::as_viewed) {
        picture.paste(draw_pattern_of(*panel.cell, block, *layout.pattern),
                      x + layout.panel_width + kPatternGap, y - kPatternMargin);
      }
      x += layout.column_width + layout.column_gap;
    }
    draw_text(picture, line.label, kFigureMargin + kRowLabel / 2, y + layout.panel_height / 2,
              Align::center, fitted(line.label, kRowStyle, layout.panel_height));
    y += layout.panel_height + kPanelGap;
  }
  if (has_bar(block.look)) {
    draw_scalar_bar(picture, *block.look.style.scale, y + kPanelGap);
  } else {
    draw_legend(picture, block.look.legend, y + kPanelGap);
  }
}

}  // namespace

std::vector<FigureBlock> make_blocks(const OpenedRun& run, const FigureView& view) {
  std::vector<FigureBlock> blocks;
  const auto add_further = [&](const std::optional<FurtherRow>& row) {
    if (!row) return;
    if (auto block = make_further_block(run, view, *row)) blocks.push_back(*std::move(block));
  };
  add_further(view.above);
  blocks.push_back(make_block(run, view, most_columns(view)));
  add_further(view.below);
  if (blocks.size() == 1) return blocks;
  const FigureRow* named = nullptr;  // the last row whose cells have their names over them
  for (FigureBlock& block : blocks) {
    FigureRow& first = block.rows.front();
    if (!first.has_headings) continue;
    if (named != nullptr && same_labels(*named, first)) first.has_headings = false;
    named = &block.rows.back();
  }
  for (FigureBlock& block : blocks) {
    const std::string name =
        block.view.label.empty() ? display_name(block.view.part) : block.view.label;
    for (FigureRow& row : block.rows)
      row.label = name + (row.label.empty() ? "" : ", ") + row.label;
  }
  return blocks;
}

void take_look(FigureBlock& block, const FigureBlock& of) {
  block.look = of.look;
  if (of.has_own_classes)
    block.view.classes = unite_names(block.rows, *block.view.color_by, of.view.classes);
}

FigureSize figure_size(const std::vector<FigureBlock>& blocks) {
  FigureSize size;
  for (const FigureBlock& block : blocks) {
    const Layout layout = make_layout(drawn_rows(block), block);
    size.width = std::max(size.width, layout.width);
    size.height += block_height(block, layout);
  }
  return size;
}

Picture draw_figure(const std::vector<FigureBlock>& blocks) {
  const FigureSize size = figure_size(blocks);
  Picture picture(size.width, size.height);
  int y = kFigureMargin;
  for (const FigureBlock& block : blocks) {
    const Layout layout = make_layout(drawn_rows(block), block);
    draw_block(picture, block, layout, y);
    y += block_height(block, layout);
  }
  return picture;
}

Picture draw_panels(const FigureBlock& block, int panel_width) {
  Layout layout;
  for (const FigureRow& row : block.rows) {
    layout.columns = std::max(layout.columns, static_cast<int>(row.cells.size()));
  }
  layout.panel_width = panel_width;
  layout.panel_height = panel_height(block, panel_width);
  const double height = 1.0 * layout.panel_height * static_cast<double>(block.rows.size());
  require_picture(1.0 * panel_width * layout.columns, height);
  Picture picture(panel_width * layout.columns, static_cast<int>(height));
  for (int r = 0; r < std::ssize(block.rows); ++r) {
    const std::vector<FigureCell>& cells = block.rows[r].cells;
    for (int c = 0; c < std::ssize(cells); ++c) {
      throw_if_stopped();
      const DrawnPanel panel{&cells[c], Showing::as_viewed, {}};
      picture.paste(draw_cell(panel, block.view, block.look, layout), c * panel_width,
                    r * layout.panel_height);
    }
  }
  return picture;
}

}  // namespace geoprior
