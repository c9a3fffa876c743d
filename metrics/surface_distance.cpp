#include "metrics/surface_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Triangles triangles_of(const TriMesh& mesh, const char* which) {
  if (!mesh.V.allFinite()) {
    throw Error("coordinate is not finite", std::string("surface ") + which, "finite numbers");
  }
  Triangles triangles;
  triangles.reserve(static_cast<std::size_t>(mesh.F.rows()));
  const auto point = [&](int v) {
    return Kernel::Point_3(mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2));
  };
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Kernel::Triangle_3 triangle(point(mesh.F(t, 0)), point(mesh.F(t, 1)),
                                      point(mesh.F(t, 2)));
    if (!triangle.is_degenerate()) triangles.push_back(triangle);
  }
  if (triangles.empty()) {
    throw Error("no triangle with an area", std::string("surface ") + which, "at least one");
  }
  return triangles;
}

/// Pieces along an edge when a triangle is cut into similar ones with edges of at most `spacing`.
int cuts(const Kernel::Triangle_3& t, double spacing) {
  const double longest2 =
      std::max({CGAL::squared_distance(t[0], t[1]), CGAL::squared_distance(t[1], t[2]),
                CGAL::squared_distance(t[2], t[0])});
  return std::max(1, static_cast<int>(std::ceil(std::sqrt(longest2) / spacing)));
}

/// Calls `visit(centre)` for the n * n pieces of a triangle.
template <class Visit>
void visit_pieces(const Kernel::Triangle_3& t, int n, const Visit& visit) {
  // Weights in thirds of a piece add up to 3 n; those of a centre all leave the same rest by 3: 1
  // in upright pieces, 2 in the others.
  for (int i = 1; i < 3 * n; ++i) {
    if (i % 3 == 0) continue;
    for (int j = i % 3; i + j < 3 * n; j += 3) {
      visit(CGAL::barycenter(t[0], static_cast<double>(i), t[1], static_cast<double>(j), t[2],
                             static_cast<double>(3 * n - i - j)));
    }
  }
}

/// The vertices of the mesh, and the centres of the pieces.
std::vector<Kernel::Point_3> samples_of(const TriMesh& mesh, const Triangles& triangles,
                                        double spacing) {
  std::vector<Kernel::Point_3> samples;
  std::vector<bool> used(static_cast<std::size_t>(mesh.V.rows()), false);
  for (const int v : mesh.F.reshaped()) used[static_cast<std::size_t>(v)] = true;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    if (!used[static_cast<std::size_t>(v)]) continue;
    samples.emplace_back(mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2));
  }
  for (const Kernel::Triangle_3& t : triangles) {
    visit_pieces(t, cuts(t, spacing), [&](const Kernel::Point_3& p) { samples.push_back(p); });
  }
  return samples;
}

/// Largest squared distance of the samples from the triangles of `tree`, if larger than `so_far`.
///
/// A sample within the largest distance so far cannot change it, and that is quick to find out: a
/// ball about it meets any triangle. The stride visits far-apart samples first, so that the largest
/// distance grows early.
double largest_distance2(const std::vector<Kernel::Point_3>& samples, const Tree& tree,
                         double so_far) {
  const std::size_t n = samples.size();
  std::size_t stride = std::max<std::size_t>(1, static_cast<std::size_t>(0.382 * double(n)));
  while (std::gcd(stride, n) != 1) ++stride;
  for (std::size_t k = 0, i = 0; k < n; ++k, i = (i + stride) % n) {
    if (so_far > 0 && tree.do_intersect(Kernel::Sphere_3(samples[i], so_far))) continue;
    so_far = std::max(so_far, tree.squared_distance(samples[i]));
  }
  return so_far;
}

}  // namespace

double hausdorff_distance(const TriMesh& a, const TriMesh& b, double spacing) {
  if (!(spacing > 0)) throw Error("spacing is not positive", "hausdorff distance", "above 0");
  const Triangles first = triangles_of(a, "a");
  const Triangles second = triangles_of(b, "b");
  const Tree first_tree(first.begin(), first.end());
  const Tree second_tree(second.begin(), second.end());
  const double forth = largest_distance2(samples_of(a, first, spacing), second_tree, 0);
  return std::sqrt(largest_distance2(samples_of(b, second, spacing), first_tree, forth));
}

SurfaceDeviation surface_deviation(const TriMesh& a, const TriMesh& b, double spacing) {
  if (!(spacing > 0)) throw Error("spacing is not positive", "surface deviation", "above 0");
  const Triangles from = triangles_of(a, "a");
  const Triangles to = triangles_of(b, "b");
  const Tree tree(to.begin(), to.end());
  SurfaceDeviation result;
  double area = 0, squares = 0;
  for (const Kernel::Triangle_3& t : from) {
    const int n = cuts(t, spacing);
    const double weight = std::sqrt(t.squared_area()) / (static_cast<double>(n) * n);
    visit_pieces(t, n, [&](const Kernel::Point_3& p) {
      const double d2 = tree.squared_distance(p);
      area += weight;
      squares += weight * d2;
      result.mean += weight * std::sqrt(d2);
      result.max = std::max(result.max, std::sqrt(d2));
    });
  }
  result.rms = std::sqrt(squares / area);
  result.mean /= area;
  return result;
}

}  // namespace geoprior
