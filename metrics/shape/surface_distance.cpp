#include "metrics/shape/surface_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/geometry/triangle_tree.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

/// A triangle with an area.
struct Triangle {
  std::array<Eigen::Vector3d, 3> corner;

  [[nodiscard]] double area() const {
    const Eigen::Vector3d twice = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    return std::sqrt(squared_length(twice) / 4);
  }
  [[nodiscard]] double longest_edge() const {
    return std::sqrt(
        std::max({squared_length(corner[1] - corner[0]), squared_length(corner[2] - corner[1]),
                  squared_length(corner[0] - corner[2])}));
  }
  /// Summed from left to right, which `squaredNorm` does not.
  static double squared_length(const Eigen::Vector3d& v) {
    return v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
  }
};

using Triangles = std::vector<Triangle>;

Triangles triangles_of(const TriMesh& mesh, const char* which) {
  if (!mesh.V.allFinite()) {
    throw Error("coordinate is not finite", std::string("surface ") + which, "finite numbers");
  }
  Triangles triangles;
  for (const int f : faces_with_area(mesh)) {
    triangles.push_back(
        {{Eigen::Vector3d(mesh.V.row(mesh.F(f, 0))), Eigen::Vector3d(mesh.V.row(mesh.F(f, 1))),
          Eigen::Vector3d(mesh.V.row(mesh.F(f, 2)))}});
  }
  if (triangles.empty()) {
    throw Error("no triangle with an area", std::string("surface ") + which, "at least one");
  }
  return triangles;
}

/// Pieces along an edge when a triangle is cut into similar ones with edges of at most `spacing`.
int cuts(const Triangle& t, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(t.longest_edge() / spacing)));
}

/// Calls `visit(centre)` for the n * n pieces of a triangle.
template <class Visit>
void visit_pieces(const Triangle& t, int n, const Visit& visit) {
  // Weights in thirds of a piece add up to 3 n; those of a centre all leave the same rest by 3: 1
  // in upright pieces, 2 in the others.
  const auto& [a, b, c] = t.corner;
  for (int i = 1; i < 3 * n; ++i) {
    if (i % 3 == 0) continue;
    for (int j = i % 3; i + j < 3 * n; j += 3) {
      visit(Eigen::Vector3d((i * a + j * b + (3 * n - i - j) * c) / (3 * n)));
    }
  }
}

/// The vertices of the mesh, and the centres of the pieces.
std::vector<Eigen::Vector3d> samples_of(const TriMesh& mesh, const Triangles& triangles,
                                        double spacing) {
  std::vector<Eigen::Vector3d> samples;
  std::vector<bool> used(mesh.V.rows(), false);
  for (const int v : mesh.F.reshaped()) used[v] = true;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    if (!used[v]) continue;
    samples.emplace_back(mesh.V.row(v));
  }
  for (const Triangle& t : triangles) {
    visit_pieces(t, cuts(t, spacing), [&](const Eigen::Vector3d& p) { samples.push_back(p); });
  }
  return samples;
}

/// Largest squared distance of the samples from the triangles of `tree`, if larger than `so_far`.
///
/// A sample within the largest distance so far cannot change it, and that is quick to find out: a
/// ball about it meets any triangle. The stride visits far-apart samples first, so that the largest
/// distance grows early.
double largest_distance2(const std::vector<Eigen::Vector3d>& samples, const TriangleTree& tree,
                         double so_far) {
  const std::size_t n = samples.size();
  std::size_t stride = std::max<std::size_t>(1, static_cast<std::size_t>(0.382 * double(n)));
  while (std::gcd(stride, n) != 1) ++stride;
  for (std::size_t k = 0, i = 0; k < n; ++k, i = (i + stride) % n) {
    if (so_far > 0 && tree.meets_ball(samples[i], so_far)) continue;
    so_far = std::max(so_far, tree.squared_distance(samples[i]));
  }
  return so_far;
}

/// Triangles of a surface, to be found again by their exact corners, in any order.
class CommonTriangles {
 public:
  explicit CommonTriangles(const Triangles& triangles) {
    for (const Triangle& t : triangles) corners_.push_back(corners_of(t));
    std::sort(corners_.begin(), corners_.end());
  }
  [[nodiscard]] bool contains(const Triangle& t) const {
    return std::binary_search(corners_.begin(), corners_.end(), corners_of(t));
  }

 private:
  using Corners = std::array<std::array<double, 3>, 3>;
  static Corners corners_of(const Triangle& t) {
    Corners corners;
    for (int k = 0; k < 3; ++k) corners[k] = {t.corner[k].x(), t.corner[k].y(), t.corner[k].z()};
    std::sort(corners.begin(), corners.end());
    return corners;
  }
  std::vector<Corners> corners_;
};

/// Sums over pieces, weighted by area.
struct PieceSums {
  double area = 0, distances = 0, squares = 0, largest2 = 0;

  void add(const Triangle& t, double spacing, const TriangleTree& tree) {
    const int n = cuts(t, spacing);
    const double weight = t.area() / (static_cast<double>(n) * n);
    visit_pieces(t, n, [&](const Eigen::Vector3d& p) {
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
  const TriangleTree first_tree(a), second_tree(b);
  const double forth = largest_distance2(samples_of(a, first, spacing), second_tree, 0);
  return std::sqrt(largest_distance2(samples_of(b, second, spacing), first_tree, forth));
}

double largest_distance(const TriMesh& from, const TriMesh& to, double spacing) {
  if (!(spacing > 0)) throw Error("spacing is not positive", "largest distance", "above 0");
  const Triangles triangles = triangles_of(from, "from");
  triangles_of(to, "to");  // refuses one without area
  return std::sqrt(largest_distance2(samples_of(from, triangles, spacing), TriangleTree(to), 0));
}

double largest_distance(const Eigen::MatrixX3d& points, const TriMesh& to) {
  const TriangleTree tree(to);
  double squared = 0;
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    squared = std::max(squared, tree.squared_distance(points.row(i).transpose()));
  return std::sqrt(squared);
}

SurfaceDeviation surface_deviation(const TriMesh& a, const TriMesh& b, double spacing) {
  if (!(spacing > 0)) throw Error("spacing is not positive", "surface deviation", "above 0");
  const Triangles from = triangles_of(a, "a");
  const Triangles to = triangles_of(b, "b");
  const CommonTriangles common(to);
  const TriangleTree tree(b);
  std::vector<PieceSums> sums((from.size() + kBlock - 1) / kBlock);
  parallel_blocks(from.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    PieceSums& block = sums[begin / kBlock];
    for (std::size_t t = begin; t < end; ++t) {
      if (common.contains(from[t])) {
        block.area += from[t].area();
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

SurfaceDeviation mutual_deviation(const TriMesh& a, const TriMesh& b, double spacing) {
  const SurfaceDeviation there = surface_deviation(a, b, spacing);
  const SurfaceDeviation back = surface_deviation(b, a, spacing);
  return {std::max(there.rms, back.rms), std::max(there.mean, back.mean),
          std::max(there.max, back.max)};
}

}  // namespace geoprior
