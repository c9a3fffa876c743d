#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/mesh.h"
#include "core/random.h"
#include "metrics/developability/surface_front.h"

/// Surfaces that unfold into a plane, and points on any surface.
namespace geoprior::sampled {

/// A rectangle of n x m cells, inner vertices moved by up to `jitter` of a cell.
inline TriMesh sheet(double width, double height, int n, int m, double jitter) {
  TriMesh mesh;
  mesh.V.setZero((n + 1) * (m + 1), 3);
  mesh.F.resize(2 * n * m, 3);
  RandomStream random(7, "sheet");
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      const double dx = jitter * (2 * random.uniform() - 1);
      const double dy = jitter * (2 * random.uniform() - 1);
      const double x = i + (i > 0 && i < n ? dx : 0), y = j + (j > 0 && j < m ? dy : 0);
      mesh.V.row(j * (n + 1) + i) << x * width / n, y * height / m, 0;
    }
  }
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int v = j * (n + 1) + i, t = 2 * (j * n + i);
      mesh.F.row(t) << v, v + 1, v + n + 2;
      mesh.F.row(t + 1) << v, v + n + 2, v + n + 1;
    }
  }
  return mesh;
}

/// Prism with a regular polygon of n sides about the z axis, of circumference `around`: unrolls to
/// around x height. Vertex (i, j) is at arc length i around / n and z = j height / m.
inline TriMesh prism(double around, double height, int n, int m) {
  TriMesh mesh;
  mesh.V.resize(n * (m + 1), 3);
  mesh.F.resize(2 * n * m, 3);
  const double radius = around / n / (2 * std::sin(std::numbers::pi / n));
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      mesh.V.row(j * n + i) << radius * std::cos(angle), radius * std::sin(angle), j * height / m;
    }
  }
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i, b = j * n + (i + 1) % n, t = 2 * a;
      mesh.F.row(t) << a, b, b + n;
      mesh.F.row(t + 1) << a, b + n, a + n;
    }
  }
  return mesh;
}

/// Place at (x, y) of a regular sheet or prism of n x m cells of size `dx` x `dy`.
inline SurfacePoint on_cells(double x, double y, double dx, double dy, int n, int m) {
  const int i = std::clamp(static_cast<int>(std::floor(x / dx)), 0, n - 1);
  const int j = std::clamp(static_cast<int>(std::floor(y / dy)), 0, m - 1);
  const double u = x / dx - i, v = y / dy - j;
  const int t = 2 * (j * n + i);
  if (u >= v) return {t, {1 - u, u - v, v}};
  return {t + 1, {1 - v, u, v - u}};
}

/// Draws places uniformly by area.
class UniformPlaces {
 public:
  UniformPlaces(const TriMesh& mesh, std::uint64_t seed) : random_(seed, "places") {
    const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
    for (Eigen::Index f = 0; f < areas.size(); ++f) {
      up_to_.push_back((f > 0 ? up_to_.back() : 0) + areas(f));
    }
  }
  SurfacePoint next() {
    const double at = random_.uniform() * up_to_.back();
    const auto f = std::upper_bound(up_to_.begin(), up_to_.end() - 1, at) - up_to_.begin();
    double u = random_.uniform(), v = random_.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return {static_cast<int>(f), {1 - u - v, u, v}};
  }

 private:
  RandomStream random_;
  std::vector<double> up_to_;
};

inline std::vector<SurfacePoint> uniform(const TriMesh& mesh, int count, std::uint64_t seed) {
  UniformPlaces places(mesh, seed);
  std::vector<SurfacePoint> result;
  for (int i = 0; i < count; ++i) result.push_back(places.next());
  return result;
}

}  // namespace geoprior::sampled
