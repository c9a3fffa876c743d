#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "testbed/view/figure/cells.h"
#include "testbed/view/figure/colors.h"
#include "testbed/view/figure/picture.h"

namespace geoprior {

/// A horizontal bar with ticks below and "name [unit]" at its left; pointed ends where values go on
/// beyond it.
void draw_scalar_bar(Picture& picture, const ColorScale& scale, int top);

/// A line of the legend: a class of the surface, or an overlay.
struct LegendEntry {
  enum class Mark { area, line, dashes, ball };
  std::string label;
  std::array<double, 3> color{0, 0, 0};
  Mark mark = Mark::area;
};

using OverlayColors = std::map<std::string, std::array<double, 3>>;

/// Of the curve that theory says.
inline constexpr std::array<double, 3> kExpectedColor{0.08, 0.08, 0.08};

/// Colours of the overlays that some panel has: ink for lines, red for points, others for further
/// ones of a kind; those of paper for what is of paper.
OverlayColors overlay_colors(const std::vector<FigureRow>& rows,
                             const std::vector<std::string>& overlays);

/// The classes of the view, the overlays that some panel has, the expected curve. Empty for a view
/// without classes. Of an array that has names of its own, only those that some panel shows.
std::vector<LegendEntry> legend_entries(const std::vector<FigureRow>& rows, const FigureView& view);

/// The entries in lines that fit a picture of that width (pixels), in order.
std::vector<std::vector<LegendEntry>> legend_lines(const std::vector<LegendEntry>& entries,
                                                   int width);

/// Pixels that the lines of the legend take; 0 without entries.
int legend_height(const std::vector<LegendEntry>& entries, int width);

/// Draws the legend in centred lines below the row of pixels `top`.
void draw_legend(Picture& picture, const std::vector<LegendEntry>& entries, int top);

}  // namespace geoprior
