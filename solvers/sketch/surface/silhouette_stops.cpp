#include "solvers/sketch/surface/silhouette_stops.h"

#include <cmath>

namespace geoprior::sketch {

SilhouetteStops::SilhouetteStops(const VisualHull& hull, std::size_t view)
    : hull_(hull.mesh.V),
      view_(hull.views[view]),
      places_(hull.places[view]),
      spacing_(hull.spacing),
      held_(Eigen::VectorXd::Zero(hull.mesh.V.rows())) {}

void SilhouetteStops::hold(const Eigen::MatrixX3d& X, CoordinatePins& pins) {
  constexpr double kOutside = 0.15, kInside = 1e-6;  // edges
  for (int v = 0; v < X.rows(); ++v) {
    const Eigen::Vector2d q = view_.project(X.row(v).transpose());
    const Outline::Nearest at = view_.outline.nearest(q);
    const bool at_its_place = has_place_near(v, at.arc_length);
    if (at.distance > kOutside * spacing_) held_[v] = 1;
    if (!at_its_place && at.distance < -kInside * spacing_) held_[v] = 0;
    if (held_[v] == 0) continue;
    if (at_its_place) {
      const Eigen::Vector2d place = view_.project(hull_.row(v).transpose());
      for (int k = 0; k < 2; ++k) set(v, k, place[k], pins);
    } else {
      const int k = std::abs(at.normal.x()) >= std::abs(at.normal.y()) ? 0 : 1;
      const double slope = at.normal[1 - k] / at.normal[k];
      set(v, k, at.point[k] - slope * (q[1 - k] - at.point[1 - k]), pins);
    }
  }
}

bool SilhouetteStops::has_place_near(int vertex, double arc_length) const {
  return places_[vertex] && std::abs(std::remainder(places_[vertex]->arc_length - arc_length,
                                                    view_.outline.length())) < spacing_;
}

void SilhouetteStops::set(int vertex, int k, double value, CoordinatePins& pins) const {
  const ViewAxis axis = view_axis(view_.frame, k);
  pins.set(vertex, axis.axis, axis.sign * value);
}

}  // namespace geoprior::sketch
