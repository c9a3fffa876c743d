#include "metrics/spacing/plane_spectrum.h"

#include <cmath>

namespace geoprior {

bool fills_rectangle(const TriMesh& surface) {
  if (surface.vertex_count() == 0) return false;
  const Eigen::RowVector3d size = surface.V.colwise().maxCoeff() - surface.V.colwise().minCoeff();
  if (size.z() > 1e-9 * size.norm()) return false;
  const double area = triangle_areas(surface.V, surface.F).sum();
  return std::abs(area - size.x() * size.y()) <= 1e-6 * area;
}

RadialSpectrum plane_spectrum(const TriMesh& surface, std::span<const SurfacePoint> places,
                              double unit) {
  Eigen::MatrixX2d points(places.size(), 2);
  for (std::size_t i = 0; i < places.size(); ++i) {
    points.row(i) = position_of(places[i], surface.V, surface.F).head<2>();
  }
  const Eigen::Vector2d low = surface.V.leftCols<2>().colwise().minCoeff();
  const Eigen::Vector2d high = surface.V.leftCols<2>().colwise().maxCoeff();
  // A place on the border may be off by round-off.
  points = points.cwiseMax(low.transpose().replicate(points.rows(), 1))
               .cwiseMin(high.transpose().replicate(points.rows(), 1));
  return radial_spectrum(points, low, high, unit);
}

}  // namespace geoprior
