#include "metrics/developability/panels.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/error.h"
#include "metrics/developability/developability.h"

namespace geoprior {

double panel_area(const TriMesh& mesh, std::span<const int> triangles) {
  double area = 0;
  for (const int t : triangles) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a, v = mesh.V.row(mesh.F(t, 2)) - a;
    area += u.cross(v).norm() / 2;
  }
  return area;
}

PanelImages panel_images(const TriMesh& mesh, std::span<const std::vector<int>> panels) {
  if (panels.empty()) throw Error("no panels", "Gauss image", "at least one");
  PanelImages sum;
  double whole = 0;
  for (const std::vector<int>& triangles : panels) {
    const GaussImage image = gauss_image(mesh, triangles);
    const double area = panel_area(mesh, triangles);
    sum.great_circle_thinness += area * image.great_circle_thinness;
    sum.small_circle_thinness += area * image.small_circle_thinness;
    sum.circle_rms += area * std::min(image.great_circle_rms, image.small_circle_rms);
    whole += area;
  }
  return {sum.great_circle_thinness / whole, sum.small_circle_thinness / whole,
          sum.circle_rms / whole};
}

}  // namespace geoprior
