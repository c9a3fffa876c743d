#pragma once

#include <vector>

#include "core/connectivity.h"
#include "models/sketch/surface/visual_hull.h"

namespace geoprior::sketch {

struct DrawnRidge {
  Edge edge{};   ///< lower vertex first
  int view = 0;  ///< that shows it as a corner, of VisualHull::views
};

/// Edges of a hull along which an outward corner of a silhouette goes on into the depth of its
/// view: both of their ends lie on one corner there. (In inward ones two parts meet, an arm and a
/// body: how sharply they do in the depth nothing says.) Such ridges were drawn, where those
/// between the faces of two views follow from how a hull is made: those of a box seen from three
/// sides are all drawn, those of a vase from two none. A round section touches a corner in one
/// point and has no such edge.
///
/// @param hull  with its vertices' places
/// @return      ascending by edges, each once
std::vector<DrawnRidge> drawn_ridges(const VisualHull& hull);
std::vector<Edge> edges_of(const std::vector<DrawnRidge>& ridges);

}  // namespace geoprior::sketch
