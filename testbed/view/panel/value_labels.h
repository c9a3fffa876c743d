#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "testbed/view/figure/picture.h"
#include "testbed/view/panel/content.h"
#include "testbed/view/panel/seen_names.h"

namespace geoprior {

/// Names beside what a panel shows, as in a plate of an atlas: in a column at either side, each
/// with a thin line to its thing. The same in all panels of a row.
struct LabelColumns {
  std::string array;               ///< the named array whose values are written
  std::vector<std::string> names;  ///< all that may be written: the longest decides the size
  double share = 0;                ///< of the panel's width, that a column takes
};

/// Columns of names as large as a figure's other texts, or at most three tenths of the panel each,
/// and the window made wider by them.
/// @param most_width_px   of the panel, as the figure has room for it
/// @param most_height_px  likewise
LabelColumns make_label_columns(const std::string& array, std::vector<std::string> names,
                                int most_width_px, int most_height_px, ViewWindow& window);

/// A name and where it stands.
struct PlacedLabel {
  std::string text;
  Eigen::Vector2d thing = Eigen::Vector2d::Zero();  ///< pixels
  bool right = false;                               ///< in the right column
  double y = 0;                                     ///< middle of the text
  double size = 0;                                  ///< pixels that are seen of the thing
};

/// Where names stand: at the side that their thing is nearer to, at its height, but at least
/// `line_height` apart and inside the picture; those moves have the least sum of squares. Lines do
/// not cross within a column: names that would cross change places. What a column cannot hold goes
/// to the other one, the least seen nowhere.
/// @param column_px  width of a column, from the picture's border to the beginning of its lines
std::vector<PlacedLabel> place_labels(const std::vector<SeenName>& seen, int width_px,
                                      int height_px, double column_px, double line_height);

/// Draws the names over a panel that was drawn.
void draw_value_labels(Picture& picture, const std::vector<SeenName>& seen,
                       const LabelColumns& columns);

}  // namespace geoprior
