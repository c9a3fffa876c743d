#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "baselines/details/hole_mesh.h"

namespace geoprior {
namespace {

constexpr double kShort = 0.35;  ///< of the edge that a border vertex cuts

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// Collapses around the borders. Knows the triangles of the vertices that may take part: border
/// vertices and those that share a triangle with one.
class BorderTidier {
 public:
  explicit BorderTidier(HoledMesh& mesh) : mesh_(mesh), around_(mesh.x.size()) {
    std::vector<char> near(mesh.x.size(), 0);
    for (const auto& t : mesh.triangle)
      for (const int v : t)
        if (mesh.hole[index(v)] >= 0)
          for (const int w : t) near[index(w)] = 1;
    for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
      for (const int v : mesh.triangle[t])
        if (near[index(v)] != 0) around_[index(v)].push_back(static_cast<int>(t));
  }

  void run() {
    for (int pass = 0; pass < 4; ++pass) {
      int done = 0;
      for (const ShortEdge& e : short_edges())
        if (is_short(e.gone, e.stays) && collapse(e.gone, e.stays)) ++done;
      if (done == 0) break;
    }
    std::erase_if(mesh_.triangle, [](const auto& t) { return t[0] < 0; });
  }

 private:
  struct ShortEdge {
    double length2;
    int gone, stays;
  };

  [[nodiscard]] bool is_short(int gone, int stays) const {
    double scale = mesh_.scale[index(stays)];
    if (mesh_.hole[index(gone)] >= 0) scale = std::min(scale, mesh_.scale[index(gone)]);
    return (mesh_.x[index(gone)] - mesh_.x[index(stays)]).norm() < kShort * scale;
  }

  /// Shortest first. What stays is a border vertex.
  [[nodiscard]] std::vector<ShortEdge> short_edges() const {
    std::vector<ShortEdge> edges;
    for (const auto& t : mesh_.triangle) {
      if (t[0] < 0) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        for (const auto& [v, w] :
             {std::pair(t[k], t[(k + 1) % 3]), std::pair(t[(k + 1) % 3], t[k])}) {
          if (mesh_.hole[index(w)] < 0) continue;
          if (mesh_.hole[index(v)] >= 0 && v < w) continue;
          if (is_short(v, w))
            edges.push_back({(mesh_.x[index(v)] - mesh_.x[index(w)]).squaredNorm(), v, w});
        }
      }
    }
    std::sort(edges.begin(), edges.end(), [](const ShortEdge& a, const ShortEdge& b) {
      return std::tie(a.length2, a.gone, a.stays) < std::tie(b.length2, b.gone, b.stays);
    });
    return edges;
  }

  [[nodiscard]] bool has(int t, int v) const {
    const auto& c = mesh_.triangle[index(t)];
    return c[0] == v || c[1] == v || c[2] == v;
  }
  [[nodiscard]] std::vector<int> triangles_of(int v) const {
    std::vector<int> live;
    for (const int t : around_[index(v)])
      if (has(t, v)) live.push_back(t);
    return live;
  }
  [[nodiscard]] std::vector<int> neighbours(int v, const std::vector<int>& triangles) const {
    std::vector<int> result;
    for (const int t : triangles)
      for (const int w : mesh_.triangle[index(t)])
        if (w != v) result.push_back(w);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// Whether no triangle around `gone` turns or becomes a needle.
  [[nodiscard]] bool stays_flat(int gone, int stays, const std::vector<int>& triangles) const {
    for (const int t : triangles) {
      if (has(t, stays)) continue;
      auto c = mesh_.triangle[index(t)];
      const auto normal = [&] {
        return Eigen::Vector3d((mesh_.x[index(c[1])] - mesh_.x[index(c[0])])
                                   .cross(mesh_.x[index(c[2])] - mesh_.x[index(c[0])]));
      };
      const Eigen::Vector3d before = normal();
      std::replace(c.begin(), c.end(), gone, stays);
      const Eigen::Vector3d after = normal();
      if (!(after.dot(before) > 0.94 * after.norm() * before.norm())) return false;
      if (!(after.norm() > 0.15 * before.norm())) return false;
    }
    return true;
  }

  bool collapse(int gone, int stays) {
    const std::vector<int> of_gone = triangles_of(gone), of_stays = triangles_of(stays);
    const auto shared =
        std::count_if(of_gone.begin(), of_gone.end(), [&](int t) { return has(t, stays); });
    if (shared == 0) return false;
    const auto a = neighbours(gone, of_gone), b = neighbours(stays, of_stays);
    const bool on_border = a.size() != of_gone.size();
    // A border vertex moves along its own border only.
    if (on_border && (shared != 1 || mesh_.hole[index(gone)] != mesh_.hole[index(stays)]))
      return false;
    std::vector<int> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    if (static_cast<long>(common.size()) != shared) return false;  // link condition
    if (!stays_flat(gone, stays, of_gone)) return false;
    for (const int t : of_gone) {
      auto& c = mesh_.triangle[index(t)];
      if (has(t, stays)) {
        c = {-1, -1, -1};
      } else {
        std::replace(c.begin(), c.end(), gone, stays);
        around_[index(stays)].push_back(t);
      }
    }
    return true;
  }

  HoledMesh& mesh_;
  std::vector<std::vector<int>> around_;
};

}  // namespace

void tidy_borders(HoledMesh& mesh) { BorderTidier(mesh).run(); }

}  // namespace geoprior
