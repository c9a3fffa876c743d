#include "solvers/paper/meshing/refinement.h"

#include <algorithm>

#include "core/geometry/planar.h"
#include "models/paper/shell/shape_gradients.h"
#include "solvers/paper/shell/green_strain.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Edges of a place that is there, over those asked for, up to which it serves.
constexpr double kAsFine = 1.2;

/// Largest principal Green strain of a triangle, in modulus.
double strain_of(const ShellState& state, int t, double area) {
  const auto gradient = shape_gradients(state.mesh, t, area);
  Eigen::Matrix<double, 3, 2> F = Eigen::Matrix<double, 3, 2>::Zero();
  for (int k = 0; k < 3; ++k) {
    F += state.x.row(state.mesh.triangles(t, k)).transpose() * gradient[k].transpose();
  }
  return largest_principal(green_strain(F));
}

}  // namespace

std::vector<FinePlace> strained_places(const ShellState& state, double strain, double shortest,
                                       const std::vector<FinePlace>& there) {
  std::vector<FinePlace> places;
  for (int t = 0; t < state.mesh.triangle_count(); ++t) {
    const auto p = [&](int k) -> Vector2d {
      return state.mesh.pattern.row(state.mesh.triangles(t, k)).transpose();
    };
    const double area = cross(p(1) - p(0), p(2) - p(0)) / 2;
    if (!(strain_of(state, t, area) > strain)) continue;
    const double longest =
        std::max({(p(1) - p(0)).norm(), (p(2) - p(1)).norm(), (p(0) - p(2)).norm()});
    const FinePlace place{(p(0) + p(1) + p(2)) / 3, longest / 2};
    const auto as_fine = [&](const FinePlace& other) {
      return other.edge <= kAsFine * place.edge &&
             (other.centre - place.centre).norm() < other.edge;
    };
    if (place.edge < shortest || std::any_of(there.begin(), there.end(), as_fine) ||
        std::any_of(places.begin(), places.end(), as_fine)) {
      continue;
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace geoprior::paper
