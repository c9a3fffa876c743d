#include "models/paper/meshing/grid_anchors.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/geometry/topology.h"
#include "models/paper/meshing/transfer.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// A vertex may move to an anchor while every triangle keeps this share of its quality.
constexpr double kLeastShare = 0.5;

/// 4 sqrt(3) area / (sum of squared edges): 1 for equilateral, negative when turned over.
double quality(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const double edges = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return 2 * std::sqrt(3.0) * cross(b - a, c - a) / edges;
}

enum class Place { corner, side, inside };

class AnchorPlacer {
 public:
  AnchorPlacer(ShellMesh& mesh, const Pattern& pattern)
      : mesh_(mesh),
        pattern_(pattern),
        tolerance_(1e-9 * width(pattern)),
        taken_(mesh.vertex_count(), false) {}

  /// Moves a vertex to the anchor; false when none can go.
  bool move_vertex(const Vector2d& anchor);

 private:
  [[nodiscard]] Place place(const BorderPoint& b) const;
  [[nodiscard]] bool may_move(int vertex, const Vector2d& to, const BorderPoint& border) const;

  ShellMesh& mesh_;
  const Pattern& pattern_;
  double tolerance_;
  std::vector<bool> taken_;  ///< vertices that are anchors already
};

Place AnchorPlacer::place(const BorderPoint& b) const {
  if (b.distance > tolerance_) return Place::inside;
  const std::vector<Vector2d> all = corners(pattern_);
  return std::any_of(all.begin(), all.end(),
                     [&](const Vector2d& c) { return (c - b.point).norm() <= tolerance_; })
             ? Place::corner
             : Place::side;
}

bool AnchorPlacer::may_move(int vertex, const Vector2d& to, const BorderPoint& border) const {
  const BorderPoint from = nearest_on_border(pattern_, mesh_.pattern.row(vertex));
  const Place here = place(from), there = place(border);
  if (here != there || here == Place::corner) return false;
  if (here == Place::side && from.edge != border.edge) return false;
  for (int f = 0; f < mesh_.triangle_count(); ++f) {
    std::array<Vector2d, 3> old, moved;
    bool touches = false;
    for (int k = 0; k < 3; ++k) {
      const int v = mesh_.triangles(f, k);
      old[k] = mesh_.pattern.row(v);
      moved[k] = v == vertex ? to : old[k];
      touches = touches || v == vertex;
    }
    if (touches &&
        quality(moved[0], moved[1], moved[2]) < kLeastShare * quality(old[0], old[1], old[2])) {
      return false;
    }
  }
  return true;
}

bool AnchorPlacer::move_vertex(const Vector2d& anchor) {
  const BorderPoint border = nearest_on_border(pattern_, anchor);
  const Vector2d to = border.distance <= tolerance_ ? border.point : anchor;
  int nearest = 0, movable = -1;
  double nearest_distance = (mesh_.pattern.row(0).transpose() - to).norm(), movable_distance = 0;
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    const double d = (mesh_.pattern.row(v).transpose() - to).norm();
    if (d < nearest_distance) {
      nearest = v;
      nearest_distance = d;
    }
    if (taken_[v] || (movable >= 0 && d >= movable_distance)) continue;
    if (place(nearest_on_border(pattern_, mesh_.pattern.row(v))) != place(border)) continue;
    movable = v;
    movable_distance = d;
  }
  if (nearest_distance <= tolerance_) {
    taken_[nearest] = true;
    return true;
  }
  if (movable < 0 || !may_move(movable, to, border)) return false;
  mesh_.pattern.row(movable) = to;
  taken_[movable] = true;
  return true;
}

/// Triangles without those that contain one of the anchors or touch them along an edge: what stays
/// of a mesh when new vertices come.
std::vector<Edge> edges_that_stay(const ShellMesh& mesh, const std::vector<Vector2d>& anchors,
                                  double tolerance) {
  std::vector<char> opened(mesh.triangle_count());
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    std::array<Vector2d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.pattern.row(mesh.triangles(f, k));
    opened[f] = std::any_of(anchors.begin(), anchors.end(), [&](const Vector2d& a) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector2d along = p[(k + 1) % 3] - p[k];
        least = std::min(least, cross(along, a - p[k]) / along.norm());
      }
      return least >= -tolerance;
    });
  }
  const EdgeConnectivity connectivity(mesh.triangles);
  std::vector<Edge> stay;
  for (int e = 0; e < connectivity.edge_count(); ++e) {
    const std::span<const int> here = connectivity.half_edges(e);
    if (std::none_of(here.begin(), here.end(), [&](int h) { return opened[h / 3] != 0; }))
      stay.push_back(connectivity.edge(e));
  }
  return stay;
}

/// Directed border edges of a mesh in which new vertices may lie: each in pieces between them.
void add_border(const ShellMesh& old, const Eigen::MatrixX2d& points, double tolerance,
                std::vector<Eigen::Vector2i>& segments) {
  std::vector<Edge> border = boundary_edges(old.triangles);
  std::sort(border.begin(), border.end());
  for (const auto& [a, b] : border) {
    const Vector2d from = points.row(a), along = points.row(b) - points.row(a);
    std::vector<std::pair<double, int>> stops{{0, a}, {1, b}};
    for (int v = old.vertex_count(); v < points.rows(); ++v) {
      const Vector2d r = points.row(v).transpose() - from;
      const double t = r.dot(along) / along.squaredNorm();
      if (t > 0 && t < 1 && std::abs(cross(along, r)) <= tolerance * along.norm()) {
        stops.emplace_back(t, v);
      }
    }
    std::sort(stops.begin(), stops.end());
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      segments.emplace_back(stops[i].second, stops[i + 1].second);
    }
  }
}

ShellMesh with_new_vertices(const ShellMesh& mesh, const Pattern& pattern,
                            const std::vector<Vector2d>& anchors) {
  const double tolerance = 1e-9 * width(pattern);
  ShellMesh grown;
  grown.pattern.resize(mesh.vertex_count() + anchors.size(), 2);
  grown.pattern.topRows(mesh.vertex_count()) = mesh.pattern;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const BorderPoint b = nearest_on_border(pattern, anchors[i]);
    grown.pattern.row(mesh.vertex_count() + i) = b.distance <= tolerance ? b.point : anchors[i];
  }
  std::vector<Eigen::Vector2i> segments;
  add_border(mesh, grown.pattern, tolerance, segments);
  for (const auto& [a, b] : edges_that_stay(mesh, anchors, tolerance)) segments.emplace_back(a, b);
  grown.triangles = constrained_delaunay(grown.pattern, segments);
  return grown;
}

}  // namespace

ShellMesh with_anchors(ShellMesh mesh, const Pattern& pattern,
                       const std::vector<Vector2d>& anchors) {
  AnchorPlacer placer(mesh, pattern);
  std::vector<Vector2d> left;
  for (const Vector2d& anchor : anchors) {
    if (!placer.move_vertex(anchor)) left.push_back(anchor);
  }
  return left.empty() ? mesh : with_new_vertices(mesh, pattern, left);
}

}  // namespace geoprior::paper
