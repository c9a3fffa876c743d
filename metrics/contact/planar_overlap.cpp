#include "metrics/contact/planar_overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/parallel.h"
#include "metrics/volume/box_grid.h"

namespace geoprior {
namespace {

constexpr std::size_t kTrianglesOfBlock = 512;

/// A triangle of the plane, its corners counter-clockwise.
struct FlatTriangle {
  std::array<int, 3> vertex;
  std::array<Eigen::Vector2d, 3> corner;
  bool has_area = false;
};

std::vector<FlatTriangle> flat_triangles(const Eigen::MatrixX2d& points,
                                         const Eigen::MatrixX3i& triangles) {
  std::vector<FlatTriangle> flat(triangles.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    FlatTriangle& f = flat[t];
    for (int k = 0; k < 3; ++k) {
      f.vertex[k] = triangles(t, k);
      f.corner[k] = points.row(f.vertex[k]).transpose();
    }
    const int turn = orientation(f.corner[0], f.corner[1], f.corner[2]);
    f.has_area = turn != 0;
    if (turn < 0) {
      std::swap(f.vertex[1], f.vertex[2]);
      std::swap(f.corner[1], f.corner[2]);
    }
  }
  return flat;
}

/// Whether the line of an edge of `a` has all of `b` on its right side or on it.
bool edge_separates(const FlatTriangle& a, const FlatTriangle& b) {
  for (int k = 0; k < 3; ++k) {
    const int n = (k + 1) % 3;
    bool separates = true;
    for (int j = 0; j < 3 && separates; ++j) {
      // A common vertex is on the line, and would cost the exact predicate its slowest path.
      if (b.vertex[j] == a.vertex[k] || b.vertex[j] == a.vertex[n]) continue;
      separates = orientation(a.corner[k], a.corner[n], b.corner[j]) <= 0;
    }
    if (separates) return true;
  }
  return false;
}

/// Two convex polygons have no interior point in common just when an edge of one separates them.
bool interiors_meet(const FlatTriangle& a, const FlatTriangle& b) {
  return !edge_separates(a, b) && !edge_separates(b, a);
}

/// Part of a convex polygon on the left of the line from `p` to `q`.
PlanarLoop left_part(const PlanarLoop& polygon, const Eigen::Vector2d& p,
                     const Eigen::Vector2d& q) {
  PlanarLoop part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    const double at_a = cross(q - p, a - p), at_b = cross(q - p, b - p);
    if (at_a >= 0) part.push_back(a);
    if ((at_a > 0 && at_b < 0) || (at_a < 0 && at_b > 0))
      part.emplace_back(a + at_a / (at_a - at_b) * (b - a));
  }
  return part;
}

double common_area(const FlatTriangle& a, const FlatTriangle& b) {
  PlanarLoop polygon(b.corner.begin(), b.corner.end());
  for (int k = 0; k < 3; ++k) polygon = left_part(polygon, a.corner[k], a.corner[(k + 1) % 3]);
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    twice += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0]);
  return std::max(twice / 2, 0.0);
}

/// A segment of a loop and where its neighbours are.
struct LoopSegment {
  Eigen::Vector2d a, b;
  int before, after;  ///< segments of the same loop
};

void append_segments(const PlanarLoop& loop, std::vector<LoopSegment>& segments) {
  PlanarLoop p;
  for (const Eigen::Vector2d& x : loop) {
    if (p.empty() || p.back() != x) p.push_back(x);
  }
  while (p.size() > 1 && p.back() == p.front()) p.pop_back();
  const int first = static_cast<int>(segments.size()), n = static_cast<int>(p.size());
  if (n < 2) return;
  for (int i = 0; i < n; ++i) {
    segments.push_back({p[i], p[(i + 1) % n], first + (i + n - 1) % n, first + (i + 1) % n});
  }
}

/// Whether the second of two segments that share `apex` runs back along the first.
bool folds_back(const Eigen::Vector2d& from, const Eigen::Vector2d& apex,
                const Eigen::Vector2d& to) {
  return orientation(from, apex, to) == 0 && (from - apex).dot(to - apex) > 0;
}

bool segments_cross(const std::vector<LoopSegment>& segments, int i, int j) {
  const LoopSegment &s = segments[i], &t = segments[j];
  if (s.after == j && s.before == j) return true;  // two points: there and back
  if (s.after == j) return folds_back(s.a, s.b, t.b);
  if (s.before == j) return folds_back(t.a, t.b, s.b);
  return segments_meet(s.a, s.b, t.a, t.b);
}

}  // namespace

int winding_number(const PlanarLoop& loop, const Eigen::Vector2d& p) {
  int winding = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d& a = loop[i];
    const Eigen::Vector2d& b = loop[(i + 1) % loop.size()];
    const bool a_below = a.y() <= p.y(), b_below = b.y() <= p.y();
    if (a_below && !b_below && orientation(a, b, p) > 0) ++winding;
    if (!a_below && b_below && orientation(a, b, p) < 0) --winding;
  }
  return winding;
}

int outline_crossings(std::span<const PlanarLoop> loops) {
  std::vector<LoopSegment> segments;
  for (const PlanarLoop& loop : loops) append_segments(loop, segments);
  if (segments.empty()) return 0;
  std::vector<PlanarBox> boxes;
  for (const LoopSegment& s : segments) boxes.push_back({s.a.cwiseMin(s.b), s.a.cwiseMax(s.b)});
  const BoxGrid grid(std::move(boxes));
  int crossings = 0;
  for (int i = 0; i < std::ssize(segments); ++i) {
    grid.visit(grid.box(i), [&](int j) {
      if (j > i && segments_cross(segments, i, j)) ++crossings;
    });
  }
  return crossings;
}

std::vector<TrianglePair> overlapping_triangles(const Eigen::MatrixX2d& points,
                                                const Eigen::MatrixX3i& triangles,
                                                std::span<const int> group) {
  if (!points.allFinite()) throw Error("coordinate is not finite", "overlap", "finite numbers");
  if (!group.empty() && std::ssize(group) != triangles.rows()) {
    throw Error(std::to_string(group.size()) + " groups", "overlap",
                std::to_string(triangles.rows()) + ", one a triangle, or none");
  }
  if (triangles.rows() == 0) return {};
  const std::vector<FlatTriangle> flat = flat_triangles(points, triangles);
  std::vector<PlanarBox> boxes;
  for (const FlatTriangle& f : flat) boxes.push_back(box_of(f.corner));
  const BoxGrid grid(std::move(boxes));
  std::vector<std::vector<TrianglePair>> found((flat.size() + kTrianglesOfBlock - 1) /
                                               kTrianglesOfBlock);
  parallel_blocks(flat.size(), kTrianglesOfBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<TrianglePair>& pairs = found[begin / kTrianglesOfBlock];
    for (std::size_t t = begin; t < end; ++t) {
      const int i = static_cast<int>(t);
      if (!flat[i].has_area) continue;
      grid.visit(grid.box(i), [&](int j) {
        if (j <= i || !flat[j].has_area) return;
        if (!group.empty() && group[i] == group[j]) return;
        if (interiors_meet(flat[i], flat[j]))
          pairs.push_back({i, j, common_area(flat[i], flat[j])});
      });
    }
    std::sort(pairs.begin(), pairs.end(), [](const TrianglePair& a, const TrianglePair& b) {
      return std::array{a.first, a.second} < std::array{b.first, b.second};
    });
  });
  std::vector<TrianglePair> all;
  for (const auto& pairs : found) all.insert(all.end(), pairs.begin(), pairs.end());
  return all;
}

}  // namespace geoprior
