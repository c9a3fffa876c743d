#include "models/sketch/drawing/traced_stroke.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/disjoint_sets.h"
#include "models/sketch/drawing/polyline.h"
#include "models/sketch/surface/path.h"

namespace geoprior::sketch {
namespace {

class StrokeTrace {
 public:
  StrokeTrace(const std::vector<Eigen::Vector2d>& points, DepthSide side, const OutlinedView& view,
              double reach, TriMesh& mesh)
      : points_(points),
        side_(side),
        view_(view),
        reach_(reach),
        length_(length(points)),
        mesh_(mesh),
        edges_(mesh.F) {
    for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
      const BesideStroke at = beside(points_, view_.project(mesh.V.row(v).transpose()));
      side_of_.push_back(at.distance == 0 ? 1e-12 * reach : at.distance);
    }
    const Eigen::MatrixX3d normals = triangle_normals(mesh);
    const Eigen::Vector3d eye = view_.frame.row(2).transpose();
    const double sign = side == DepthSide::back ? -1 : 1;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t)
      faces_.push_back(side == DepthSide::both || sign * normals.row(t).dot(eye) > 1e-9);
  }

  TracedStroke trace(const std::vector<std::vector<Edge>*>& kept) {
    find_nodes();
    std::vector<Edge> path = segments();
    keep_nearest_sheet(path);
    split(path, kept);
    std::sort(path.begin(), path.end());
    return {path, missed_share(path)};
  }

 private:
  /// Where the stroke crosses each edge: a vertex of it, or a new one.
  void find_nodes() {
    node_.assign(edges_.edge_count(), -1);
    for (int e = 0; e < edges_.edge_count(); ++e) {
      const auto [a, b] = edges_.edge(e);
      if ((side_of_[a] > 0) == (side_of_[b] > 0)) continue;
      const std::span<const int> both = edges_.half_edges(e);
      if (std::none_of(both.begin(), both.end(), [&](int h) { return faces_[h / 3]; })) continue;
      const double share = side_of_[a] / (side_of_[a] - side_of_[b]);
      const Eigen::RowVector3d x = (1 - share) * mesh_.V.row(a) + share * mesh_.V.row(b);
      const BesideStroke at = beside(points_, view_.project(x.transpose()));
      const double edge_length = (mesh_.V.row(a) - mesh_.V.row(b)).norm();
      // Far from the stroke the sides meet too, where another of its segments becomes the nearest.
      if (std::abs(at.distance) > 0.25 * edge_length) continue;
      if (at.along < -reach_ || at.along > length_ + reach_) continue;
      if (share < kSnapShare) {
        node_[e] = a;
      } else if (share > 1 - kSnapShare) {
        node_[e] = b;
      } else {
        node_[e] = mesh_.vertex_count() + static_cast<int>(added_.size());
        added_.push_back({e, share});
      }
    }
  }

  /// Pieces of the path, each across or along one triangle that faces the view.
  std::vector<Edge> segments() const {
    std::set<Edge> found;
    for (int t = 0; t < mesh_.F.rows(); ++t) {
      if (!faces_[t]) continue;
      std::array<int, 3> nodes;
      int count = 0;
      for (int k = 0; k < 3; ++k) {
        const int node = node_[edges_.edge_of(3 * t + k)];
        if (node >= 0 &&
            std::find(nodes.begin(), nodes.begin() + count, node) == nodes.begin() + count)
          nodes[count++] = node;
      }
      if (count == 2) found.insert(undirected(nodes[0], nodes[1]));
    }
    return {found.begin(), found.end()};
  }

  [[nodiscard]] Eigen::RowVector3d position(int node) const {
    const int n = mesh_.vertex_count();
    if (node < n) return mesh_.V.row(node);
    const auto& [e, share] = added_[node - n];
    const auto [a, b] = edges_.edge(e);
    return (1 - share) * mesh_.V.row(a) + share * mesh_.V.row(b);
  }

  /// Of connected parts of the path that cover the same stretch of the stroke, keeps the one that
  /// the view sees (or the last one behind it).
  void keep_nearest_sheet(std::vector<Edge>& path) const {
    if (side_ == DepthSide::both || path.empty()) return;
    const int nodes = mesh_.vertex_count() + static_cast<int>(added_.size());
    DisjointSets sets(nodes);
    for (const Edge& e : path) sets.join(e[0], e[1]);
    struct Sheet {
      double from = 1e300, to = -1e300, depth = 0, length = 0;
    };
    std::map<int, Sheet> sheets;
    for (const Edge& e : path) {
      Sheet& sheet = sheets[sets.find(e[0])];
      const Eigen::RowVector3d a = position(e[0]), b = position(e[1]);
      for (const Eigen::RowVector3d& x : {a, b}) {
        const double along = beside(points_, view_.project(x.transpose())).along;
        sheet.from = std::min(sheet.from, along);
        sheet.to = std::max(sheet.to, along);
      }
      const double l = (a - b).norm();
      sheet.depth += l * view_.frame.row(2).dot((a + b) / 2);
      sheet.length += l;
    }
    std::vector<std::pair<double, int>> order;
    for (const auto& [root, sheet] : sheets) {
      const double depth = sheet.length > 0 ? sheet.depth / sheet.length : 0;
      order.emplace_back(side_ == DepthSide::front ? -depth : depth, root);
    }
    std::sort(order.begin(), order.end());
    std::set<int> chosen;
    for (const auto& [depth, root] : order) {
      const Sheet& sheet = sheets[root];
      const bool covered = std::any_of(chosen.begin(), chosen.end(), [&](int other) {
        const Sheet& o = sheets[other];
        return std::min(o.to, sheet.to) - std::max(o.from, sheet.from) >
               0.5 * (sheet.to - sheet.from);
      });
      if (!covered) chosen.insert(root);
    }
    std::erase_if(path, [&](const Edge& e) { return !chosen.contains(sets.find(e[0])); });
  }

  /// Adds the new vertices that the path uses, and splits the triangles at them.
  void split(std::vector<Edge>& path, const std::vector<std::vector<Edge>*>& kept) {
    const int n = mesh_.vertex_count();
    std::vector<char> used(added_.size(), 0);
    for (const Edge& e : path) {
      for (const int v : e) {
        if (v >= n) used[v - n] = 1;
      }
    }
    std::vector<int> renamed(added_.size(), -1);
    std::vector<int> split_at(edges_.edge_count(), -1);
    Eigen::MatrixX3d V(n + std::count(used.begin(), used.end(), 1), 3);
    V.topRows(n) = mesh_.V;
    int next = n;
    for (int i = 0; i < std::ssize(added_); ++i) {
      if (!used[i]) continue;
      V.row(next) = position(n + i);
      split_at[added_[i].first] = next;
      renamed[i] = next++;
    }
    for (Edge& e : path) {
      for (int& v : e) v = v >= n ? renamed[v - n] : v;
      e = undirected(e[0], e[1]);
    }
    split_kept(split_at, kept);
    split_triangles(split_at);
    mesh_.V = V;
  }

  void split_kept(const std::vector<int>& split_at,
                  const std::vector<std::vector<Edge>*>& kept) const {
    for (std::vector<Edge>* edges : kept) {
      std::vector<Edge> finer;
      for (const Edge& e : *edges) {
        const std::optional<int> found = edges_.find(e[0], e[1]);
        const int at = found ? split_at[*found] : -1;
        if (at < 0) {
          finer.push_back(e);
        } else {
          finer.push_back(undirected(e[0], at));
          finer.push_back(undirected(e[1], at));
        }
      }
      *edges = std::move(finer);
    }
  }

  void split_triangles(const std::vector<int>& split_at) {
    std::vector<std::array<int, 3>> made;
    for (int t = 0; t < mesh_.F.rows(); ++t) {
      std::array<int, 3> at;
      for (int k = 0; k < 3; ++k) at[k] = split_at[edges_.edge_of(3 * t + k)];
      const auto corner = [&](int k) { return mesh_.F(t, k % 3); };
      const auto count = std::count_if(at.begin(), at.end(), [](int v) { return v >= 0; });
      if (count == 0) made.push_back({corner(0), corner(1), corner(2)});
      if (count == 1) {
        const int k = static_cast<int>(
            std::find_if(at.begin(), at.end(), [](int v) { return v >= 0; }) - at.begin());
        made.push_back({corner(k), at[k], corner(k + 2)});
        made.push_back({at[k], corner(k + 1), corner(k + 2)});
      }
      if (count == 2) {
        // `k` is the whole edge; the two others meet in the corner that is cut off.
        const int k = static_cast<int>(std::find(at.begin(), at.end(), -1) - at.begin());
        const int b = at[(k + 1) % 3], c = at[(k + 2) % 3];
        made.push_back({b, corner(k + 2), c});
        made.push_back({corner(k), b, c});
        made.push_back({corner(k), corner(k + 1), b});
      }
      if (count == 3) {
        for (int k = 0; k < 3; ++k) made.push_back({corner(k), at[k], at[(k + 2) % 3]});
        made.push_back({at[0], at[1], at[2]});
      }
    }
    mesh_.F.resize(made.size(), 3);
    for (std::size_t t = 0; t < made.size(); ++t)
      mesh_.F.row(t) << made[t][0], made[t][1], made[t][2];
  }

  /// Share of the stroke in bins of a reach's length beside which no edge of the path lies.
  [[nodiscard]] double missed_share(const std::vector<Edge>& path) const {
    const int bins = std::max(1, static_cast<int>(length_ / reach_));
    std::vector<char> met(bins, 0);
    for (const Edge& e : path) {
      double from = beside(points_, view_.project(mesh_.V.row(e[0]).transpose())).along;
      double to = beside(points_, view_.project(mesh_.V.row(e[1]).transpose())).along;
      if (from > to) std::swap(from, to);
      if (to - from > length_ / 2) continue;  // across the ends of a closed stroke
      const int first = std::clamp(static_cast<int>(from / length_ * bins), 0, bins - 1);
      const int last = std::clamp(static_cast<int>(to / length_ * bins), 0, bins - 1);
      std::fill(met.begin() + first, met.begin() + last + 1, static_cast<char>(1));
    }
    return static_cast<double>(std::count(met.begin(), met.end(), 0)) / bins;
  }

  const std::vector<Eigen::Vector2d>& points_;
  DepthSide side_;
  const OutlinedView& view_;
  double reach_, length_;
  TriMesh& mesh_;
  EdgeConnectivity edges_;
  std::vector<double> side_of_;
  std::vector<char> faces_;
  std::vector<int> node_;                      ///< of each edge, -1: not crossed
  std::vector<std::pair<int, double>> added_;  ///< edge and share of each new vertex
};

}  // namespace

TracedStroke trace_stroke(const std::vector<Eigen::Vector2d>& points, DepthSide side,
                          const OutlinedView& view, double reach, TriMesh& mesh,
                          std::vector<std::vector<Edge>*> kept) {
  return StrokeTrace(points, side, view, reach, mesh).trace(kept);
}

}  // namespace geoprior::sketch
