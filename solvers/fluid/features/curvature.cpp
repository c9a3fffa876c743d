#include "solvers/fluid/features/curvature.h"

#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/numerics/jacobi_svd.h"
#include "core/parallel.h"

#define CGAL_EIGEN3_ENABLED 1

namespace geoprior::fluid {
namespace {

constexpr std::size_t kBlock = 1024;
/// Cotangents are clamped to ± this: the slivers of contouring weigh no more than angles of 3
/// degrees. Chosen: noise on contoured spheres stays below half of s_lo = 0.04.
constexpr double kLargestCotangent = 20;
constexpr std::array<std::string_view, 2> kKindNames{"cotangent", "jet"};

/// Cotangents at the three corners of a triangle, clamped, and its area.
struct Cotangents {
  std::array<double, 3> cot{};
  double area = 0;
};

Cotangents cotangents(const SurfaceGraph& g, const std::array<int, 3>& t) {
  const Eigen::Vector3d& a = g.x[t[0]];
  const Eigen::Vector3d& b = g.x[t[1]];
  const Eigen::Vector3d& c = g.x[t[2]];
  const Eigen::Vector3d ab = b - a, bc = c - b, ca = a - c;
  const double twice = ab.cross(bc).norm();
  Cotangents result;
  result.area = 0.5 * twice;
  const std::array<double, 3> dot{-ab.dot(ca), -bc.dot(ab), -ca.dot(bc)};
  for (std::size_t k = 0; k < 3; ++k) {
    // A triangle without area has angles 0 and pi: the limit says so and the area adds nothing.
    result.cot[k] = std::abs(dot[k]) < kLargestCotangent * twice
                        ? dot[k] / twice
                        : std::copysign(kLargestCotangent, dot[k]);
  }
  return result;
}

/// Share of a triangle in the mixed area of its corner k (Meyer et al. 2003, figure 4).
double mixed_area(const Cotangents& t, std::size_t k, double to_next, double to_last) {
  if (t.cot[k] < 0) return t.area / 2;
  if (t.cot[(k + 1) % 3] < 0 || t.cot[(k + 2) % 3] < 0) return t.area / 4;
  return (to_next * t.cot[(k + 2) % 3] + to_last * t.cot[(k + 1) % 3]) / 8;
}

void shape_at(const SurfaceGraph& g, const std::vector<Cotangents>& cot, std::size_t v,
              SurfaceShape& shape) {
  Eigen::Vector3d bend = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  double area = 0;
  for (const int c : g.corners(static_cast<int>(v))) {
    const std::size_t t = c / 3, k = c % 3;
    const auto& vertices = g.triangle[t];
    const Eigen::Vector3d next = g.x[vertices[(k + 1) % 3]] - g.x[v];
    const Eigen::Vector3d last = g.x[vertices[(k + 2) % 3]] - g.x[v];
    const double to_next = next.squaredNorm(), to_last = last.squaredNorm();
    bend -= cot[t].cot[(k + 2) % 3] * next + cot[t].cot[(k + 1) % 3] * last;
    area += mixed_area(cot[t], k, to_next, to_last);
    normal += next.cross(last);  // by area: the normals of slivers are noise
  }
  const double length = normal.norm();
  shape.normal[v] = length > 0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::Zero();
  shape.area[v] = area;
  shape.curvature[v] = area > 0 && g.border[v] == 0 ? shape.normal[v].dot(bend) / (4 * area) : 0;
}

/// H_i <- the mean, by area, of H_i (weight one half) and of its ring (one half). Border vertices
/// know no H and stay out.
void smooth(const SurfaceGraph& g, const std::vector<double>& area, std::vector<double>& H) {
  std::vector<double> smoothed(H.size());
  parallel_blocks(H.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (g.border[v] != 0) continue;
      const std::span<const int> ring = g.neighbours(static_cast<int>(v));
      const auto valence = static_cast<double>(ring.size());
      double sum = valence * area[v] * H[v], weight = valence * area[v];
      for (const int n : ring) {
        if (g.border[n] != 0) continue;
        sum += area[n] * H[n];
        weight += area[n];
      }
      smoothed[v] = weight > 0 ? sum / weight : 0;
    }
  });
  H.swap(smoothed);
}

}  // namespace

void describe(OptionVisitor& v, CurvatureOptions& o) {
  describe_choice(v, "kind", o.kind, kKindNames,
                  {.doc = "estimator of the mean curvature: the cotangent formula, or a quadric "
                          "through two rings"});
  v.value("smoothing", o.smoothing,
          {.doc = "passes that smooth H over the neighbours of each vertex", .min = 0, .max = 100});
}

SurfaceShape surface_shape(const SurfaceGraph& g, const CurvatureOptions& options) {
  std::vector<Cotangents> cot(g.triangle.size());
  parallel_blocks(cot.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) cot[t] = cotangents(g, g.triangle[t]);
  });
  SurfaceShape shape;
  shape.curvature.resize(g.x.size());
  shape.area.resize(g.x.size());
  shape.normal.resize(g.x.size());
  parallel_blocks(g.x.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) shape_at(g, cot, v, shape);
  });
  if (options.kind == CurvatureKind::jet) shape.curvature = jet_curvature(g, shape.normal);
  for (int pass = 0; pass < options.smoothing; ++pass) smooth(g, shape.area, shape.curvature);
  return shape;
}

Eigen::VectorXd mean_curvature(const TriMesh& mesh, const CurvatureOptions& options) {
  const SurfaceShape shape = surface_shape(surface_graph(mesh), options);
  return Eigen::Map<const Eigen::VectorXd>(shape.curvature.data(), shape.curvature.size());
}

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
    const Eigen::Vector3d& x = g.x[i];
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

}  // namespace geoprior::fluid
