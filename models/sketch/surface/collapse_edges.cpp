#include "models/sketch/surface/collapse_edges.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <vector>

namespace geoprior::sketch {
namespace {

/// Triangles about vertices, kept up to date while edges are collapsed.
class CollapsingMesh {
 public:
  explicit CollapsingMesh(const TriMesh& mesh) : star_(mesh.V.rows()) {
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
      triangles_.push_back({mesh.F(t, 0), mesh.F(t, 1), mesh.F(t, 2)});
      for (const int v : triangles_.back()) star_[v].push_back(static_cast<int>(t));
    }
  }

  [[nodiscard]] const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }

  /// Corners of the triangles about a vertex but itself, ascending.
  [[nodiscard]] std::vector<int> neighbours(int vertex) const {
    std::vector<int> found;
    for (const int t : star_[vertex]) {
      for (const int v : triangles_[t]) {
        if (v != vertex) found.push_back(v);
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  /// Whether the vertices are joined by an edge whose collapse leaves a manifold.
  [[nodiscard]] bool can_merge(int a, int b) const {
    const std::vector<int> of_a = neighbours(a), of_b = neighbours(b);
    if (!std::binary_search(of_a.begin(), of_a.end(), b)) return false;
    std::vector<int> common;
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                          std::back_inserter(common));
    return common.size() == 2 && of_a.size() > 3 && of_b.size() > 3;
  }

  /// Moves all of `gone` to `kept`; the triangles at their edge vanish.
  void merge(int kept, int gone) {
    for (const int t : star_[gone]) {
      std::array<int, 3>& corners = triangles_[t];
      if (std::find(corners.begin(), corners.end(), kept) != corners.end()) {
        for (const int v : corners) {
          if (v != gone) std::erase(star_[v], t);
        }
        corners = {-1, -1, -1};
        continue;
      }
      std::replace(corners.begin(), corners.end(), gone, kept);
      star_[kept].push_back(t);
    }
    star_[gone].clear();
  }

 private:
  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::vector<int>> star_;
};

/// The triangles that are left, with the vertices that they use in their order.
void take_over(const CollapsingMesh& collapsed, TriMesh& mesh) {
  std::vector<int> renamed(mesh.V.rows(), -1);
  Eigen::Index count = 0;
  for (const std::array<int, 3>& t : collapsed.triangles()) {
    if (t[0] < 0) continue;
    mesh.F.row(count++) << t[0], t[1], t[2];
    for (const int v : t) renamed[v] = 0;
  }
  mesh.F.conservativeResize(count, 3);
  int next = 0;
  for (std::size_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] < 0) continue;
    mesh.V.row(next) = mesh.V.row(v);
    renamed[v] = next++;
  }
  mesh.V.conservativeResize(next, 3);
  mesh.F = mesh.F.unaryExpr([&](int v) { return renamed[v]; });
}

}  // namespace

int collapse_short_edges(TriMesh& mesh, double length) {
  CollapsingMesh collapsing(mesh);
  int collapsed = 0;
  for (std::size_t t = 0; t < collapsing.triangles().size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::array<int, 3> corners = collapsing.triangles()[t];
      if (corners[0] < 0) break;
      const int a = std::min(corners[k], corners[(k + 1) % 3]);
      const int b = std::max(corners[k], corners[(k + 1) % 3]);
      if ((mesh.V.row(a) - mesh.V.row(b)).norm() >= length || !collapsing.can_merge(a, b)) continue;
      collapsing.merge(a, b);
      ++collapsed;
    }
  }
  if (collapsed > 0) take_over(collapsing, mesh);
  return collapsed;
}

}  // namespace geoprior::sketch
