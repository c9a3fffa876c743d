#include "models/sketch/surface/split.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "core/geometry/topology.h"

namespace geoprior::sketch {
namespace {

/// Share of its area below which a triangle is spoiled by vertices that moved.
constexpr double kSpoiled = 0.05;

class PathSplitter {
 public:
  PathSplitter(const TriMesh& mesh, std::span<const Edge> kept)
      : mesh_(mesh),
        edges_(mesh.F),
        stays_(boundary_vertices(mesh.F, mesh.vertex_count())),
        stands_in_(mesh.vertex_count(), false),
        node_(edges_.edge_count(), -1) {
    for (const Edge& e : kept) stays_[e[0]] = stays_[e[1]] = true;
  }

  std::optional<SurfaceSplit> split(std::span<const SurfacePath> paths) {
    for (const SurfacePath& path : paths) add_nodes(path);
    split_triangles();
    const EdgeConnectivity made(split_.triangles);
    for (const Edge& e : wanted_) {
      if (!made.find(e[0], e[1])) return {};
    }
    move_vertices();
    straighten(made);
    for (const std::vector<int>& line : lines_) add_edges(line);
    return std::move(split_);
  }

 private:
  /// The vertices of a path that stand in for its points; -1: a new vertex.
  [[nodiscard]] std::vector<int> stand_ins(const SurfacePath& path) const {
    std::vector<int> of;
    for (const EdgePoint& point : path) {
      const bool first = point.is_vertex() || point.share < kSnapShare;
      of.push_back(first ? point.edge[0] : point.share > 1 - kSnapShare ? point.edge[1] : -1);
    }
    // Before and behind a vertex that goes onto the path, a new one on an edge of it would lie in
    // a line with it and with what the path comes from, unless that is on the opposite edge.
    const auto has = [](const Edge& e, int v) { return e[0] == v || e[1] == v; };
    const auto merge = [&](std::size_t from, std::size_t at, std::size_t to) {
      const int v = of[to];
      if (v < 0 || of[at] >= 0 || !has(path[at].edge, v)) return false;
      if (of[from] == v || (of[from] < 0 && !has(path[from].edge, v))) return false;
      of[at] = v;
      return true;
    };
    for (bool merged = true; merged;) {
      merged = false;
      for (std::size_t i = 1; i + 1 < path.size(); ++i)
        merged = merge(i - 1, i, i + 1) || merge(i + 1, i, i - 1) || merged;
    }
    return of;
  }

  int new_vertex(const EdgePoint& point) {
    int& node = node_[*edges_.find(point.edge[0], point.edge[1])];
    if (node < 0) {
      node = mesh_.vertex_count() + static_cast<int>(split_.added.size());
      split_.added.push_back(point);
    }
    return node;
  }

  /// A vertex goes to the nearest of the crossings that it stands in for, unless a path passes it.
  void stand_in(const EdgePoint& point, int v) {
    stands_in_[v] = true;
    if (point.is_vertex()) {
      stays_[v] = true;
      return;
    }
    const double distance = (point.position(mesh_.V) - mesh_.V.row(v)).norm();
    const auto [at, is_new] = nearest_.try_emplace(v, distance, point);
    if (!is_new && distance < at->second.first) at->second = {distance, point};
  }

  void add_nodes(const SurfacePath& path) {
    const std::vector<int> vertices = stand_ins(path);
    std::vector<int>& line = lines_.emplace_back();
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (vertices[i] >= 0) stand_in(path[i], vertices[i]);
      const int node = vertices[i] >= 0 ? vertices[i] : new_vertex(path[i]);
      if (!line.empty() && node == line.back()) continue;
      if (!line.empty()) wanted_.insert(undirected(line.back(), node));
      line.push_back(node);
    }
  }

  /// Those that may, and that spoil no triangle.
  void move_vertices() {
    std::erase_if(nearest_, [&](const auto& move) { return stays_[move.first]; });
    const Eigen::MatrixX3d before = split_.interpolated(mesh_.V);
    for (bool spoiled = true; spoiled;) {
      spoiled = false;
      split_.moved.clear();
      for (const auto& [v, crossing] : nearest_) split_.moved.emplace_back(v, crossing.second);
      const Eigen::MatrixX3d V = split_.interpolated(mesh_.V);
      for (Eigen::Index t = 0; t < split_.triangles.rows(); ++t) {
        const Eigen::RowVector3i F = split_.triangles.row(t);
        const Eigen::RowVector3d was = twice_area(before, F);
        if (twice_area(V, F).dot(was) >= kSpoiled * was.squaredNorm()) continue;
        for (int k = 0; k < 3; ++k) spoiled = nearest_.erase(F(k)) > 0 || spoiled;
      }
    }
  }

  static Eigen::RowVector3d twice_area(const Eigen::MatrixX3d& V, const Eigen::RowVector3i& F) {
    return (V.row(F(1)) - V.row(F(0))).cross(V.row(F(2)) - V.row(F(0)));
  }

  void add_edges(const std::vector<int>& line) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Edge e = undirected(line[i - 1], line[i]);
      if (std::find(split_.path.begin(), split_.path.end(), e) == split_.path.end())
        split_.path.push_back(e);
    }
  }

  /// Where a path runs along two sides of a triangle, lets it run along the third.
  void straighten(const EdgeConnectivity& made) {
    std::map<int, int> uses;
    for (const std::vector<int>& line : lines_) {
      for (const int node : line) ++uses[node];
    }
    const auto is_triangle = [&](int a, int b, int c) {
      const auto edge = made.find(a, c);
      if (!edge || a == c) return false;
      return std::ranges::any_of(made.half_edges(*edge), [&](int h) {
        const auto corners = split_.triangles.row(h / 3);
        return corners[0] == b || corners[1] == b || corners[2] == b;
      });
    };
    const auto is_at_vertex = [&](int node) {
      return node < mesh_.vertex_count() && !nearest_.contains(node);
    };
    for (std::vector<int>& line : lines_) {
      for (std::size_t i = 1; i + 1 < line.size() && line.size() > 4;) {
        if (uses[line[i]] == 1 && is_at_vertex(line[i]) &&
            is_triangle(line[i - 1], line[i], line[i + 1])) {
          line.erase(line.begin() + static_cast<std::ptrdiff_t>(i));
          i = std::max<std::size_t>(1, i - 1);
        } else {
          ++i;
        }
      }
    }
  }

  void split_triangles() {
    std::vector<std::array<int, 3>> made;
    for (int t = 0; t < mesh_.triangle_count(); ++t) split_triangle(t, made);
    split_.triangles.resize(made.size(), 3);
    for (std::size_t t = 0; t < made.size(); ++t)
      split_.triangles.row(t) << made[t][0], made[t][1], made[t][2];
  }

  void split_triangle(int t, std::vector<std::array<int, 3>>& made) const {
    std::array<int, 3> at;
    for (int k = 0; k < 3; ++k) at[k] = node_[edges_.edge_of(3 * t + k)];
    const auto corner = [&](int k) { return mesh_.F(t, k % 3); };
    const auto count = std::count_if(at.begin(), at.end(), [](int v) { return v >= 0; });
    if (count == 0) made.push_back({corner(0), corner(1), corner(2)});
    if (count == 1) {
      const int k = at[0] >= 0 ? 0 : at[1] >= 0 ? 1 : 2;
      made.push_back({corner(k), at[k], corner(k + 2)});
      made.push_back({at[k], corner(k + 1), corner(k + 2)});
    }
    if (count == 2) {
      // `k` is the whole edge; the two others meet in the corner that is cut off.
      const int k = at[0] < 0 ? 0 : at[1] < 0 ? 1 : 2;
      const int b = at[(k + 1) % 3], c = at[(k + 2) % 3];
      made.push_back({b, corner(k + 2), c});
      // Not across a corner that goes onto the path, where there is a choice.
      const bool other = wanted_.contains(undirected(corner(k + 1), c)) ||
                         (stands_in_[corner(k)] && !stands_in_[corner(k + 1)] &&
                          !wanted_.contains(undirected(corner(k), b)));
      if (other) {
        made.push_back({corner(k), corner(k + 1), c});
        made.push_back({corner(k + 1), b, c});
      } else {
        made.push_back({corner(k), b, c});
        made.push_back({corner(k), corner(k + 1), b});
      }
    }
    if (count == 3) {
      for (int k = 0; k < 3; ++k) made.push_back({corner(k), at[k], at[(k + 2) % 3]});
      made.push_back({at[0], at[1], at[2]});
    }
  }

  const TriMesh& mesh_;
  EdgeConnectivity edges_;
  std::vector<bool> stays_;      ///< vertices of the border and of kept edges, and that paths pass
  std::vector<bool> stands_in_;  ///< vertices that paths run through
  std::map<int, std::pair<double, EdgePoint>> nearest_;  ///< crossings that a vertex stands in for
  std::vector<int> node_;                                ///< new vertex of each edge, -1: none
  std::vector<std::vector<int>> lines_;                  ///< vertices along the paths
  std::set<Edge> wanted_;                                ///< edges of the paths as they were given
  SurfaceSplit split_;
};

}  // namespace

Eigen::MatrixX3d SurfaceSplit::interpolated(const Eigen::MatrixX3d& values) const {
  Eigen::MatrixX3d result(values.rows() + added.size(), 3);
  result.topRows(values.rows()) = values;
  for (std::size_t i = 0; i < added.size(); ++i)
    result.row(values.rows() + i) = added[i].position(values);
  for (const auto& [v, place] : moved) result.row(v) = place.position(values);
  return result;
}

std::vector<Edge> SurfaceSplit::split_edges(std::span<const Edge> edges, int first_new) const {
  std::vector<std::pair<Edge, int>> middle;  // of the edges that were split
  for (const EdgePoint& point : added)
    middle.emplace_back(point.edge, first_new + static_cast<int>(middle.size()));
  std::sort(middle.begin(), middle.end());
  std::vector<Edge> finer;
  for (const Edge& e : edges) {
    const auto found = std::ranges::lower_bound(middle, e, {}, &std::pair<Edge, int>::first);
    if (found == middle.end() || found->first != e) {
      finer.push_back(e);
    } else {
      finer.push_back({e[0], found->second});
      finer.push_back({e[1], found->second});
    }
  }
  return finer;
}

std::optional<SurfaceSplit> split_along(const TriMesh& mesh, std::span<const SurfacePath> paths,
                                        std::span<const Edge> kept) {
  return PathSplitter(mesh, kept).split(paths);
}

}  // namespace geoprior::sketch
