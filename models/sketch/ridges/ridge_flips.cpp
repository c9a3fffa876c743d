#include "models/sketch/ridges/ridge_flips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "models/sketch/ridges/edge_flips.h"

namespace geoprior::sketch {
namespace {

constexpr double kThinnest = 0.3;  ///< height of a triangle that is made, over its longest edge
constexpr double kNeedle = 0.001;  ///< the same of one that is flipped away whatever it turns by

/// Which edges of a mesh are flipped.
class RidgeFlips {
 public:
  explicit RidgeFlips(const TriMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] bool are_wanted(const EdgeDiamond& of) const;

 private:
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

  const TriMesh& mesh_;
};

bool RidgeFlips::are_wanted(const EdgeDiamond& of) const {
  const auto& [left, right, a, b, c, d, around] = of;
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
  if (by_a.dot(by_b) > 0 && (is_needle_below(c, n) || is_needle_below(d, m))) return true;
  if (thinnest_after < kThinnest * longest) return false;
  const double before = turning(a, b, n, m) + turning_to(b, c, n, around[0]) +
                        turning_to(c, a, n, around[1]) + turning_to(a, d, m, around[2]) +
                        turning_to(d, b, m, around[3]);
  const double after = turning(c, d, by_b, by_a) + turning_to(b, c, by_b, around[0]) +
                       turning_to(c, a, by_a, around[1]) + turning_to(a, d, by_a, around[2]) +
                       turning_to(d, b, by_b, around[3]);
  return after < before - 1e-3 * (at(a) - at(b)).norm();
}

}  // namespace

int flip_to_ridges(TriMesh& mesh) {
  constexpr int kPasses = 8;
  const RidgeFlips flips_of(mesh);
  int flips = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const int made =
        flip_edges(mesh.F, [&](const EdgeDiamond& of) { return flips_of.are_wanted(of); });
    if (made == 0) break;
    flips += made;
  }
  return flips;
}

}  // namespace geoprior::sketch
