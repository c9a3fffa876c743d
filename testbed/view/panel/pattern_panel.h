#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/view/figure/picture.h"
#include "testbed/view/panel/plane_curves.h"

namespace geoprior {

/// The rectangle of the plane that holds the patterns of all sheets of a block.
struct PatternWindow {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double width_m = 1;
  double height_m = 1;
};

/// @param sheets  those without a point array "pattern" [m] (2) do not count
/// @throws Error  when none has it, listing the arrays there are
PatternWindow fit_pattern(const std::vector<const Part*>& sheets);

/// Whether the sheet has a flat pattern: a point array "pattern".
bool has_pattern(const Part& sheet);

/// Edges of a single triangle, where they lie in the pattern. The two lips of a cut are among them.
std::vector<CurveSegment> pattern_border(const Part& sheet);

/// Where the points of an overlay lie in the pattern: by their own array "pattern", or as the
/// vertices of the sheet that they coincide with.
/// @param name    of the overlay, for the error
/// @throws Error  when a point has neither
Eigen::MatrixX2d places_in_pattern(const Part& overlay, const std::string& name, const Part& sheet);

/// Lines are thin and pale. Lines with a point array "time" are paths: in full colour where they
/// were drawn in time, as dark as the border where they were there from the start (time 0).
struct PatternOverlay {
  std::string name;
  const Part* part = nullptr;  ///< of lines or points
  std::array<double, 3> color{0, 0, 0};
};

/// The flat pattern of a sheet: paper with its border, and overlays where they lie in it.
/// @param expected  a curve over them, dashed; empty: none
/// @throws Error  when an overlay is neither of lines nor of points, or as places_in_pattern does
Picture draw_pattern(const Part& sheet, const std::vector<PatternOverlay>& overlays,
                     const std::vector<Eigen::Vector2d>& expected, const PlaneView& view,
                     int width_px, int height_px);

}  // namespace geoprior
