#pragma once

#include <optional>

#include "models/sketch/drawing/drawing.h"

namespace geoprior::sketch {

/// Within which share of the diagonal ends of borders of one view should be joined, where the
/// method's default is wrong for the drawing.
///
/// Ends that do not belong together pull the borders away from where they were drawn. So a half or
/// a quarter of the default is taken where with it the borders lie nearer to the drawing by a
/// factor of 4 (root mean square), and as many points are matched with their mirror images: a
/// drawing whose ends need to be joined loses such matches. A drawing that is off everywhere, by an
/// unsteady hand, keeps the default.
/// @return  absent: the default
std::optional<double> chosen_snap(const View& view);

}  // namespace geoprior::sketch
