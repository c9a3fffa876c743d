#include "metrics/surface_distance.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

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
  triangles.reserve(mesh.F.rows());
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
  std::vector<bool> used(mesh.V.rows(), false);
  for (const int v : mesh.F.reshaped()) used[v] = true;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    if (!used[v]) continue;
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

/// Triangles of a surface, to be found again by their exact corners, in any order.
class CommonTriangles {
 public:
  explicit CommonTriangles(const Triangles& triangles) {
    for (const Kernel::Triangle_3& t : triangles) corners_.push_back(corners_of(t));
    std::sort(corners_.begin(), corners_.end());
  }
  [[nodiscard]] bool contains(const Kernel::Triangle_3& t) const {
    return std::binary_search(corners_.begin(), corners_.end(), corners_of(t));
  }

 private:
  using Corners = std::array<std::array<double, 3>, 3>;
  static Corners corners_of(const Kernel::Triangle_3& t) {
    Corners corners;
    for (int k = 0; k < 3; ++k) corners[std::size_t(k)] = {t[k].x(), t[k].y(), t[k].z()};
    std::sort(corners.begin(), corners.end());
    return corners;
  }
  std::vector<Corners> corners_;
};

/// Sums over pieces, weighted by area.
struct PieceSums {
  double area = 0, distances = 0, squares = 0, largest2 = 0;

  void add(const Kernel::Triangle_3& t, double spacing, const Tree& tree) {
    const int n = cuts(t, spacing);
    const double weight = std::sqrt(t.squared_area()) / (static_cast<double>(n) * n);
    visit_pieces(t, n, [&](const Kernel::Point_3& p) {
      const double d2 = tree.squared_distance(p);
      area += weight;
      squares += weight * d2;
      distances += weight * std::sqrt(d2);
      largest2 = std::max(largest2, d2);
    });
  }
  void add(const PieceSums& other) {
    area += other.area;
    squares += other.squares;
    distances += other.distances;
    largest2 = std::max(largest2, other.largest2);
  }
};

/// Triangles of a block that one thread measures.
constexpr std::size_t kBlock = 256;

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
  const CommonTriangles common(to);
  Tree tree(to.begin(), to.end());
  tree.build();
  tree.accelerate_distance_queries();
  std::vector<PieceSums> sums((from.size() + kBlock - 1) / kBlock);
  parallel_blocks(from.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    PieceSums& block = sums[begin / kBlock];
    for (std::size_t t = begin; t < end; ++t) {
      if (common.contains(from[t])) {
        block.area += std::sqrt(from[t].squared_area());
      } else {
        block.add(from[t], spacing, tree);
      }
    }
  });
  PieceSums total;
  for (const PieceSums& block : sums) total.add(block);
  return {std::sqrt(total.squares / total.area), total.distances / total.area,
          std::sqrt(total.largest2)};
}

}  // namespace geoprior
