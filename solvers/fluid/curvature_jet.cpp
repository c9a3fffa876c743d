#define CGAL_EIGEN3_ENABLED 1

#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "solvers/fluid/curvature.h"

namespace geoprior {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Fit = CGAL::Monge_via_jet_fitting<Kernel, Kernel>;

constexpr std::size_t kFewestPoints = 6;  // coefficients of a quadric
constexpr std::size_t kMostRings = 4;

/// The vertex, then its rings until they are two and at least `kFewestPoints` + 1 points.
void collect(const SurfaceGraph& g, int v, std::vector<int>& points) {
  points.assign(1, v);
  std::size_t begin = 0;
  for (std::size_t ring = 0; ring < kMostRings; ++ring) {
    if (ring >= 2 && points.size() > kFewestPoints) return;
    const std::size_t end = points.size();
    for (; begin < end; ++begin) {
      for (const int n : g.neighbours(points[begin])) {
        if (std::find(points.begin(), points.end(), n) == points.end()) points.push_back(n);
      }
    }
  }
}

double fitted(const SurfaceGraph& g, const std::vector<int>& indices, const Eigen::Vector3d& n,
              std::vector<Kernel::Point_3>& points) {
  if (indices.size() <= kFewestPoints || n.isZero()) return 0;
  points.clear();
  for (const int i : indices) {
    const Eigen::Vector3d& x = g.x[static_cast<std::size_t>(i)];
    points.emplace_back(x.x(), x.y(), x.z());
  }
  Fit fit;
  Fit::Monge_form form = fit(points.begin(), points.end(), 2, 2);
  form.comply_wrt_given_normal(Kernel::Vector_3(n.x(), n.y(), n.z()));
  // The form is z = (k1 x^2 + k2 y^2) / 2 along the normal: crests bend away from it.
  const double H = -(form.principal_curvatures(0) + form.principal_curvatures(1)) / 2;
  return std::isfinite(H) ? H : 0;
}

}  // namespace

std::vector<double> jet_curvature(const SurfaceGraph& g,
                                  const std::vector<Eigen::Vector3d>& normals) {
  std::vector<double> H(g.x.size(), 0.0);
  parallel_blocks(H.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<int> indices;
    std::vector<Kernel::Point_3> points;
    for (std::size_t v = begin; v < end; ++v) {
      if (g.border[v] != 0) continue;
      collect(g, static_cast<int>(v), indices);
      H[v] = fitted(g, indices, normals[v], points);
    }
  });
  return H;
}

}  // namespace geoprior
