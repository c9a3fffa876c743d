#include "solvers/paper/meshing/ruling_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>
#include <utility>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"
#include "models/paper/meshing/outline_chains.h"
#include "models/paper/tear/lips.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Radius of the ring of vertices about a tip, in flat sizes, and the length of a ruling that has
/// room for one: beside it a step of a tear is not much shorter than the edges around.
constexpr double kRing = 0.3, kRingRoom = 0.5;

/// Lattice points that are half a `flat_size` away from border, rulings and every vertex, where
/// `wanted`.
void add_lattice(const PaperStructure& structure, const Pattern& pattern, double flat_size,
                 const std::function<bool(const Vector2d&)>& wanted, PointSet& set) {
  const Eigen::AlignedBox2d box = bounding_box(pattern);
  const Vector2d low = box.min(), high = box.max(), size = box.sizes();
  const double row_height = flat_size * std::numbers::sqrt3 / 2;
  const int rows = static_cast<int>(size.y() / row_height);
  const int columns = static_cast<int>(size.x() / flat_size) + 1;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const Vector2d p((low.x() + high.x()) / 2 + (i - columns / 2 + (j % 2) * 0.5) * flat_size,
                       (low.y() + high.y()) / 2 + (j - rows / 2) * row_height);
      if (!wanted(p) || !contains(pattern, p) ||
          nearest_on_border(pattern, p).distance < flat_size / 2)
        continue;
      const auto near = [&](const Vector2d& q) { return (p - q).norm() < flat_size / 2; };
      const auto near_ruling = [&](const Ruling& r) {
        return distance_to_segment(p, r.a, r.b) < flat_size / 2;
      };
      if (std::any_of(set.points().begin(), set.points().end(), near) ||
          std::any_of(structure.rulings.begin(), structure.rulings.end(), near_ruling)) {
        continue;
      }
      set.add(p);
    }
  }
}

/// Reach of a fine place, in its edges.
constexpr double kReach = 2;

/// The lattice of each fine place.
void add_fine_lattices(const PaperStructure& structure, const Pattern& pattern, PointSet& set) {
  for (const FinePlace& place : structure.fine_places) {
    const auto near = [&](const Vector2d& p) {
      return (p - place.centre).norm() < kReach * place.edge;
    };
    add_lattice(structure, pattern, place.edge, near, set);
  }
}

/// Points of the border about fine places.
void add_fine_border(const PaperStructure& structure, const Pattern& pattern, PointSet& set) {
  const auto divide = [&](const FinePlace& place, const Vector2d& a, const Vector2d& b) {
    const int parts = static_cast<int>(std::ceil((b - a).norm() / place.edge));
    for (int k = 1; k < parts; ++k) {
      const Vector2d p = a + (b - a) * k / parts;
      if ((p - place.centre).norm() >= kReach * place.edge) continue;
      const auto near = [&](const Vector2d& q) { return (p - q).norm() < place.edge / 2; };
      if (std::none_of(set.points().begin(), set.points().end(), near)) set.add(p);
    }
  };
  for (const FinePlace& place : structure.fine_places) {
    each_loop_edge(pattern, [&](const Vector2d& a, const Vector2d& b) { divide(place, a, b); });
  }
}

/// What must be a vertex: corners, cuts, anchors, singular points and ends of rulings.
/// @return  the vertices of the singular points
std::vector<int> add_structure_points(const PaperStructure& structure, const Pattern& pattern,
                                      const std::vector<Vector2d>& anchors, PointSet& set) {
  for (const Vector2d& p : corners(pattern)) set.add(p);
  for (const auto& cut : pattern.cuts) {
    for (const Vector2d& p : cut) set.add(p);
  }
  for (const Vector2d& p : anchors) set.add(p);
  std::vector<int> singular;
  for (const SingularPoint& s : structure.singular_points) singular.push_back(set.add(s.position));
  for (const Ruling& r : structure.rulings) {
    set.add(r.a);
    set.add(r.b);
  }
  return singular;
}

/// A vertex on every ruling that leaves a tip.
void add_rings(const PaperStructure& structure, const MeshSizes& sizes, PointSet& set) {
  for (const Ruling& r : structure.rulings) {
    for (const auto& [from, to, end] :
         {std::tuple(r.a, r.b, r.singular_a), std::tuple(r.b, r.a, r.singular_b)}) {
      if (!end || !structure.singular_points[*end].tear) continue;
      const double length = (to - from).norm();
      if (length > kRingRoom * sizes.flat)
        set.add(from + (to - from) * kRing * sizes.flat / length);
    }
  }
}

/// Vertices along a ruling; none near an anchor on it.
void divide_ruling(const Ruling& ruling, const std::vector<Vector2d>& anchors,
                   const MeshSizes& sizes, PointSet& set) {
  const double length = (ruling.b - ruling.a).norm();
  int parts = sizes.ruling_parts;
  while (parts > 1 && length < parts * sizes.least_part) --parts;
  for (int k = 1; k < parts; ++k) {
    const Vector2d p = ruling.a + (ruling.b - ruling.a) * k / parts;
    const bool near = std::any_of(anchors.begin(), anchors.end(), [&](const Vector2d& anchor) {
      return (anchor - p).norm() < length / parts / 2;
    });
    if (!near) set.add(p);
  }
}

void number_cells(RulingMesh& result) {
  const EdgeConnectivity edges(result.mesh.triangles);
  const std::vector<Edge>& walls = result.mesh.rulings;
  const int m = result.mesh.triangle_count();
  result.cell.assign(m, -1);
  result.cell_count = 0;
  std::vector<int> stack;
  for (int start = 0; start < m; ++start) {
    if (result.cell[start] >= 0) continue;
    const int cell = result.cell_count++;
    result.cell[start] = cell;
    stack.push_back(start);
    while (!stack.empty()) {
      const int f = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int next = edges.across(f, k);
        if (next < 0 || result.cell[next] >= 0) continue;
        const Edge& edge = edges.edge(edges.edge_of(3 * f + k));
        if (std::binary_search(walls.begin(), walls.end(), edge)) continue;
        result.cell[next] = cell;
        stack.push_back(next);
      }
    }
  }
}

/// Opens the mesh along its cuts; rulings that end there keep to their side.
void open(const std::vector<Eigen::Vector2i>& lips, RulingMesh& result) {
  const EdgeConnectivity edges(result.mesh.triangles);
  open_along(result.mesh, lips);
  for (std::vector<int>& path : result.ruling_paths) {
    const std::vector<int> old = path;
    for (std::size_t k = 0; k + 1 < old.size(); ++k) {
      const auto edge = edges.find(old[k], old[k + 1]);
      const int h = edge ? edges.half_edge_from(old[k], *edge) : -1;
      if (h < 0) continue;
      path[k] = result.mesh.triangles(h / 3, h % 3);
      path[k + 1] = result.mesh.triangles(h / 3, (h % 3 + 1) % 3);
    }
  }
}

/// A canonical order, so that nothing depends on how the triangulation was stored.
void sort_triangles(Eigen::MatrixX3i& triangles) {
  std::vector<std::array<int, 3>> rows;
  for (int f = 0; f < triangles.rows(); ++f) {
    std::array<int, 3> t{triangles(f, 0), triangles(f, 1), triangles(f, 2)};
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    rows.push_back(t);
  }
  std::sort(rows.begin(), rows.end());
  for (int f = 0; f < triangles.rows(); ++f) {
    const auto& t = rows[f];
    triangles.row(f) << t[0], t[1], t[2];
  }
}

}  // namespace

RulingMesh mesh_structure(const PaperStructure& structure, const Pattern& pattern,
                          const std::vector<Vector2d>& anchors, const MeshSizes& sizes) {
  const double tolerance = 1e-9 * width(pattern);
  PointSet set(tolerance);
  RulingMesh result;
  result.singular_vertices = add_structure_points(structure, pattern, anchors, set);
  for (const Ruling& r : structure.rulings) divide_ruling(r, anchors, sizes, set);
  add_rings(structure, sizes, set);
  add_fine_border(structure, pattern, set);
  const std::vector<std::vector<int>> loops = border_chains(pattern, sizes.flat, tolerance, set);
  std::vector<Eigen::Vector2i> segments = cut_segments(pattern, sizes.flat, tolerance, set);
  const std::vector<Eigen::Vector2i> lips = segments;
  add_fine_lattices(structure, pattern, set);
  add_lattice(
      structure, pattern, sizes.flat, [](const Vector2d&) { return true; }, set);

  for (const Ruling& r : structure.rulings) {
    result.ruling_paths.push_back(points_along(set.points(), r.a, r.b, tolerance));
    const std::vector<int>& path = result.ruling_paths.back();
    for (std::size_t k = 0; k + 1 < path.size(); ++k) segments.emplace_back(path[k], path[k + 1]);
  }
  result.mesh.pattern.resize(set.points().size(), 2);
  for (std::size_t i = 0; i < set.points().size(); ++i) {
    result.mesh.pattern.row(i) = set.points()[i];
  }
  result.mesh.triangles = constrained_delaunay(result.mesh.pattern, loops, segments);
  sort_triangles(result.mesh.triangles);
  for (const auto& path : result.ruling_paths) {
    for (std::size_t k = 0; k + 1 < path.size(); ++k)
      result.mesh.rulings.push_back(undirected(path[k], path[k + 1]));
  }
  std::sort(result.mesh.rulings.begin(), result.mesh.rulings.end());
  if (!lips.empty()) open(lips, result);
  number_cells(result);
  return result;
}

std::vector<int> edge_path(const ShellMesh& mesh, const Vector2d& a, const Vector2d& b,
                           double tolerance) {
  std::vector<Vector2d> points(mesh.vertex_count());
  for (int i = 0; i < mesh.vertex_count(); ++i) {
    points[i] = mesh.pattern.row(i);
  }
  const std::vector<int> all = points_along(points, a, b, tolerance);
  if (all.size() < 2 || (points[all.front()] - a).norm() > tolerance ||
      (points[all.back()] - b).norm() > tolerance) {
    return {};
  }
  const EdgeConnectivity edges(mesh.triangles);
  const auto same = [&](int i, int j) { return (points[i] - points[j]).norm() <= tolerance; };
  // At its ends the path may find two lips of a cut: that one counts to which an edge leads.
  for (std::size_t first = 0; first < all.size() && same(all[0], all[first]); ++first) {
    std::vector<int> path{all[first]};
    for (std::size_t k = first + 1; k < all.size(); ++k) {
      if (!same(path.back(), all[k]) && edges.find(path.back(), all[k])) path.push_back(all[k]);
    }
    if (same(path.back(), all.back())) return path;
  }
  return {};
}

}  // namespace geoprior::paper
