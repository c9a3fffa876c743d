#include "models/sketch/ridges/ridge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "core/connectivity.h"

namespace geoprior::sketch {
namespace {

constexpr double kThinnest = 0.3;  ///< height of a triangle that is made, over its longest edge
constexpr double kNeedle = 0.001;  ///< the same of one that is flipped away whatever it turns by

/// One pass over the edges. What a flip touches is left alone until the next pass, since the
/// connectivity is that of its beginning.
class FlipPass {
 public:
  explicit FlipPass(TriMesh& mesh) : mesh_(mesh), edges_(mesh.F), touched_(mesh.F.rows(), 0) {}

  int run() {
    int flips = 0;
    for (int e = 0; e < edges_.edge_count(); ++e) flips += flip(e) ? 1 : 0;
    return flips;
  }

 private:
  /// Triangles a b c and b a d beside the edge a b, and those across their other edges (-1: none).
  struct Diamond {
    int left, right;
    int a, b, c, d;
    std::array<int, 4> around;  ///< across b c, c a, a d, d b
  };

  [[nodiscard]] Eigen::Vector3d at(int v) const { return mesh_.V.row(v).transpose(); }
  [[nodiscard]] Eigen::Vector3d area_normal(int a, int b, int c) const {
    return (at(b) - at(a)).cross(at(c) - at(a));
  }
  [[nodiscard]] double turning(int p, int q, const Eigen::Vector3d& n,
                               const Eigen::Vector3d& m) const {
    return (at(p) - at(q)).norm() * std::atan2(n.cross(m).norm(), n.dot(m));
  }
  [[nodiscard]] double turning_to(int p, int q, const Eigen::Vector3d& n, int triangle) const {
    if (triangle < 0) return 0;
    const Eigen::RowVector3i f = mesh_.F.row(triangle);
    return turning(p, q, n, area_normal(f(0), f(1), f(2)));
  }

  [[nodiscard]] std::optional<Diamond> diamond(int e) const {
    const std::span<const int> sides = edges_.half_edges(e);
    if (sides.size() != 2) return std::nullopt;
    const int h = sides[0], g = sides[1];
    Diamond at_edge{h / 3, g / 3, edges_.origin(h), edges_.tip(h), 0, 0, {}};
    at_edge.c = edges_.tip(EdgeConnectivity::next(h));
    at_edge.d = edges_.tip(EdgeConnectivity::next(g));
    at_edge.around = {edges_.across(h / 3, EdgeConnectivity::next(h) % 3),
                      edges_.across(h / 3, EdgeConnectivity::previous(h) % 3),
                      edges_.across(g / 3, EdgeConnectivity::next(g) % 3),
                      edges_.across(g / 3, EdgeConnectivity::previous(g) % 3)};
    const bool used = touched_[at_edge.left] || touched_[at_edge.right] ||
                      std::any_of(at_edge.around.begin(), at_edge.around.end(), [&](int triangle) {
                        return triangle >= 0 && touched_[triangle];
                      });
    if (used || edges_.origin(g) != at_edge.b || at_edge.c == at_edge.d) return std::nullopt;
    if (edges_.find(at_edge.c, at_edge.d) || edges_.valence(at_edge.a) <= 3 ||
        edges_.valence(at_edge.b) <= 3)
      return std::nullopt;
    return at_edge;
  }

  bool flip(int e) {
    const std::optional<Diamond> found = diamond(e);
    if (!found) return false;
    const auto& [left, right, a, b, c, d, around] = *found;
    const Eigen::Vector3d n = area_normal(a, b, c), m = area_normal(b, a, d);
    const Eigen::Vector3d by_b = area_normal(c, d, b), by_a = area_normal(d, c, a);
    const double longest = std::max({(at(c) - at(d)).squaredNorm(), (at(b) - at(c)).squaredNorm(),
                                     (at(c) - at(a)).squaredNorm(), (at(a) - at(d)).squaredNorm(),
                                     (at(d) - at(b)).squaredNorm()});
    const double thinnest_after = std::min(by_a.norm(), by_b.norm());
    const auto is_needle_below = [&](int apex, const Eigen::Vector3d& normal) {
      const double length = (at(a) - at(b)).norm();
      return normal.norm() < kNeedle * length * length && (at(apex) - at(a)).norm() < length &&
             (at(apex) - at(b)).norm() < length && thinnest_after > 2 * normal.norm();
    };
    if (by_a.dot(by_b) > 0 && (is_needle_below(c, n) || is_needle_below(d, m)))
      return apply(*found);
    if (thinnest_after < kThinnest * longest) return false;
    const double before = turning(a, b, n, m) + turning_to(b, c, n, around[0]) +
                          turning_to(c, a, n, around[1]) + turning_to(a, d, m, around[2]) +
                          turning_to(d, b, m, around[3]);
    const double after = turning(c, d, by_b, by_a) + turning_to(b, c, by_b, around[0]) +
                         turning_to(c, a, by_a, around[1]) + turning_to(a, d, by_a, around[2]) +
                         turning_to(d, b, by_b, around[3]);
    if (!(after < before - 1e-3 * (at(a) - at(b)).norm())) return false;
    return apply(*found);
  }

  bool apply(const Diamond& of) {
    mesh_.F.row(of.left) << of.c, of.d, of.b;
    mesh_.F.row(of.right) << of.d, of.c, of.a;
    touched_[of.left] = touched_[of.right] = 1;
    for (const int triangle : of.around) {
      if (triangle >= 0) touched_[triangle] = 1;
    }
    return true;
  }

  TriMesh& mesh_;
  EdgeConnectivity edges_;
  std::vector<char> touched_;
};

}  // namespace

int flip_to_ridges(TriMesh& mesh) {
  constexpr int kPasses = 8;
  int flips = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const int made = FlipPass(mesh).run();
    if (made == 0) break;
    flips += made;
  }
  return flips;
}

}  // namespace geoprior::sketch
