#include "metrics/arrangement/terrain_gap.h"

#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

/// Plan of a triangle: a corner, its edges from it, twice its signed area.
struct PlanTriangle {
  Eigen::Vector2d a, u, v;
  double area;
};

PlanTriangle plan_of(const TriMesh& mesh, int triangle) {
  const Eigen::Vector2d a = mesh.V.row(mesh.F(triangle, 0)).head<2>();
  const Eigen::Vector2d b = mesh.V.row(mesh.F(triangle, 1)).head<2>();
  const Eigen::Vector2d c = mesh.V.row(mesh.F(triangle, 2)).head<2>();
  const Eigen::Vector2d u = b - a, v = c - a;
  return {a, u, v, u.x() * v.y() - u.y() * v.x()};
}

bool is_upright(const PlanTriangle& t) {
  return !(std::abs(t.area) > 1e-12 * (t.u.squaredNorm() + t.v.squaredNorm()));
}

}  // namespace

TerrainHeights::TerrainHeights(TriMesh mesh) : mesh_(std::move(mesh)) {
  std::vector<PlanarBox> boxes;
  for (int t = 0; t < mesh_.triangle_count(); ++t) {
    const PlanTriangle plan = plan_of(mesh_, t);
    if (is_upright(plan)) continue;
    const Eigen::Vector2d b = plan.a + plan.u, c = plan.a + plan.v;
    const Eigen::Vector2d low = plan.a.cwiseMin(b).cwiseMin(c);
    const Eigen::Vector2d high = plan.a.cwiseMax(b).cwiseMax(c);
    const Eigen::Vector2d margin = 1e-9 * (high - low);
    boxes.push_back({low - margin, high + margin});
    triangle_.push_back(t);
  }
  if (boxes.empty()) throw Error("no triangle is seen from above", "terrain");
  grid_.emplace(std::move(boxes));
}

std::optional<double> TerrainHeights::height_near(const Eigen::Vector3d& x) const {
  std::optional<double> out;
  const Eigen::Vector2d plan = x.head<2>();
  grid_->visit({plan, plan}, [&](int box) {
    const int t = triangle_[box];
    const PlanTriangle p = plan_of(mesh_, t);
    const Eigen::Vector2d d = plan - p.a;
    const double b = (d.x() * p.v.y() - d.y() * p.v.x()) / p.area;
    const double c = (p.u.x() * d.y() - p.u.y() * d.x()) / p.area;
    constexpr double kEdge = -1e-9;
    if (b < kEdge || c < kEdge || 1 - b - c < kEdge) return;
    const double z0 = mesh_.V(mesh_.F(t, 0), 2);
    const double z =
        z0 + b * (mesh_.V(mesh_.F(t, 1), 2) - z0) + c * (mesh_.V(mesh_.F(t, 2), 2) - z0);
    if (!out || std::abs(z - x.z()) < std::abs(*out - x.z())) out = z;
  });
  return out;
}

double TerrainHeights::gap(const Eigen::Vector3d& x) const {
  if (const auto z = height_near(x)) return x.z() - *z;
  return (mesh_.V.rowwise() - x.transpose()).rowwise().norm().minCoeff();
}

}  // namespace geoprior
