#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/mesh.h"
#include "core/options.h"

namespace geoprior::sketch {

/// How the axis of the cone that fits a triangle and its neighbours is chosen.
enum class ConeFit {
  literal,       ///< equation 2.1 of the thesis as it stands
  guarded,       ///< the same among axes that are no nearer to the mean normal than an angle
  great_circle,  ///< cylinders only: the axis is orthogonal to the normals
};

struct DevelopableRotationOptions {
  ConeFit fit = ConeFit::guarded;
  double guard_deg = 30;
  int rings = 1;
  double relaxation = 1.5;
};
void describe(OptionVisitor& v, DevelopableRotationOptions& options);

/// Rotations that make a surface more developable (thesis 2.1.2, equation 2.1): the normals of a
/// triangle and its neighbours are fitted by those of a cone, and the triangle is turned so that
/// its own normal has the cone's angle.
///
/// With n_j the normals and n their mean, the axis A minimises sum ((n_j - n) . A)^2. Taken
/// literally this diverges: n_j - n lies, to first order, in the plane orthogonal to n, so wherever
/// the normals are spread evenly A is n itself, the "cone" is a needle about n, and turning the
/// normals to its angle drives them apart. `guarded` takes the best axis that is at least
/// `guard_deg` away from n. Every triangle is turned while its neighbours are: going half as far
/// again (`relaxation`) takes about two thirds of the iterations, twice as far no longer settles.
/// Patches that are flat (second eigenvalue below 1e-10) are left alone.
class DevelopableRotation {
 public:
  DevelopableRotation(const Eigen::MatrixX3i& F, int vertex_count,
                      const DevelopableRotationOptions& options);

  /// @param normals  of the triangles, unit
  /// @return         a rotation a triangle
  [[nodiscard]] std::vector<Eigen::Matrix3d> rotations(const Eigen::MatrixX3d& normals) const;

 private:
  [[nodiscard]] Eigen::Matrix3d rotation(int triangle, const Eigen::MatrixX3d& normals) const;

  DevelopableRotationOptions options_;
  std::vector<int> begin_, neighbour_;  ///< of each triangle, itself among them
};

}  // namespace geoprior::sketch
