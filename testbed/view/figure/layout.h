#pragma once

#include <optional>
#include <vector>

#include "testbed/runner/opened_run.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/view/figure/cells.h"
#include "testbed/view/figure/legend.h"
#include "testbed/view/figure/picture.h"
#include "testbed/view/panel/panel.h"
#include "testbed/view/panel/pattern_panel.h"
#include "testbed/view/panel/value_labels.h"

namespace geoprior {

/// What all panels of a block share: camera, colours, and their explanation.
struct BlockLook {
  ViewWindow window;
  PanelStyle style;
  OverlayColors colors;
  std::vector<LegendEntry> legend;
  std::optional<PatternWindow> pattern;  ///< absent: no pattern stands beside the sheet
  std::optional<LabelColumns> labels;    ///< absent: no names stand in the panels
};

/// Rows of one part under one look, with their bar or legend below.
struct FigureBlock {
  FigureView view;
  std::vector<FigureRow> rows;
  BlockLook look;
  bool has_own_classes = false;  ///< those of the view are the names that the array has
};

/// What a figure shows, from top to bottom: the row above that the view may ask for, the view's own
/// rows, and the row below. A further row of an input is left out when the run has no such input.
/// @throws Error  when there is nothing to draw, or naming what the run does not have
std::vector<FigureBlock> make_blocks(const OpenedRun& run, const FigureView& view);

/// Gives a block the look of another one of the same part in other states.
void take_look(FigureBlock& block, const FigureBlock& of);

/// In pixels.
struct FigureSize {
  int width = 0;
  int height = 0;
};

/// Of the picture that `draw_figure` draws of these blocks.
FigureSize figure_size(const std::vector<FigureBlock>& blocks);

/// Draws the blocks under each other, at the picture's usual width. Needs a Display.
Picture draw_figure(const std::vector<FigureBlock>& blocks);

/// Draws the panels of a block alone, edge to edge, each so many pixels wide: a line a row. Needs a
/// Display.
Picture draw_panels(const FigureBlock& block, int panel_width);

}  // namespace geoprior
