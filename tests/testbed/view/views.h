// Views that the tests of pictures have in common.
#pragma once

#include "testbed/figure_view.h"
#include "testbed/view/view_window.h"

namespace geoprior {

/// Looks along -z at the plane z = 1/2, four by four metres.
inline ViewWindow front_window() {
  ViewWindow window;
  window.center = {0, 0, 0.5};
  window.width_m = 4;
  window.height_m = 4;
  return window;
}

/// Boxes from the side, where they are flat: panels of few pixels, which are quickly drawn.
inline FigureView side_view() {
  FigureView view;
  view.direction = {0, -1, 0};
  view.up = {0, 0, 1};
  return view;
}

inline constexpr double kFlat = 0.05;  ///< height of such boxes (m)

}  // namespace geoprior
