#pragma once

#include <limits>
#include <vector>

#include "models/details/mesh.h"

namespace geoprior::details {

/// How many details per area each face of the surface had at rest: what the baselines restore.
///
/// The density of a detail is that of the triangles of M_d within three edges (triangles with
/// ghosts left out); a face takes that of the nearest detail. Faces farther than three mean edges
/// from any detail are bare: density 0, and no method puts details there. Scaled so that the
/// densities times the areas at rest sum to the number of details.
class RestDensity {
 public:
  explicit RestDensity(const DetailMesh& original);

  [[nodiscard]] double at(int face) const { return density_[face]; }
  /// 1 / sqrt(density) (m); infinity on a bare face.
  [[nodiscard]] double spacing(int face) const;
  /// Area now over area at rest.
  [[nodiscard]] static double stretch(int face, const DetailMesh& now);
  /// Details that the surface asks for now: the sum over faces of density x area.
  [[nodiscard]] double expected(const DetailMesh& now) const;
  /// Spacing of the mean density over what is not bare (m).
  [[nodiscard]] double mean_spacing() const { return mean_spacing_; }

 private:
  static constexpr double kBareAfter = 3;
  void spread(const DetailMesh& original, const std::vector<double>& of_site);
  void normalise(const DetailMesh& original);

  std::vector<double> density_;  ///< per face (1/m^2)
  double mean_spacing_ = 0;
};

/// A detail of weight 0 and target 1 that takes type and tangent direction of the nearest corner of
/// triangle `t` that is a detail. `at` is its place.
Detail newborn_like_neighbour(const DetailMesh& details, int t, const Eigen::Vector3d& barycentric,
                              const SurfacePoint& at);

/// Circumradius of a triangle of M_d from its lengths (m); infinity for one of no area.
double circumradius(const IntrinsicTriangulation& mesh, int t);

}  // namespace geoprior::details
