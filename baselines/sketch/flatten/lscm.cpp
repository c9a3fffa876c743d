#include "baselines/sketch/flatten/lscm.h"

#include <vector>

#include "models/sketch/flatten/conformal_energy.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/pattern/piece_borders.h"

namespace geoprior::sketch {

namespace {

/// Weights of thinner triangles are those of this cotangent, which only keeps the matrix finite.
constexpr double kLargestLscmCotangent = 1e6;

}  // namespace

std::array<int, 2> farthest_pair(const TriMesh& mesh, std::span<const int> vertices) {
  std::array<int, 2> pair{vertices.front(), vertices.back()};
  double farthest = -1;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (std::size_t j = i + 1; j < vertices.size(); ++j) {
      const double distance = (mesh.V.row(vertices[i]) - mesh.V.row(vertices[j])).squaredNorm();
      if (distance <= farthest) continue;
      farthest = distance;
      pair = {vertices[i], vertices[j]};
    }
  }
  return pair;
}

Eigen::MatrixX2d flatten_lscm(const TriMesh& disc) {
  const std::vector<int> border = disc_border(disc, "least squares conformal map");
  const std::vector<FlatTriangle> triangles = flat_triangles(disc, kLargestLscmCotangent);
  const std::array<int, 2> pins = farthest_pair(disc, border);
  const double distance = (disc.V.row(pins[0]) - disc.V.row(pins[1])).norm();
  Eigen::VectorXcd z = pinned_conformal_map(
      conformal_energy(disc.F, triangles, disc.vertex_count()), pins, {Complex(0), distance});
  scale_to_area(triangles, disc.F, z);
  return to_points(z);
}

}  // namespace geoprior::sketch
