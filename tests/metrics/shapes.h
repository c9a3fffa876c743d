#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/mesh.h"

/// Shapes with a known answer.
namespace geoprior::shapes {

/// Axis-aligned box, each face two triangles.
inline TriMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriMesh m;
  m.V.resize(8, 3);
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) m.V(i, k) = (i >> k) & 1 ? high(k) : low(k);
  }
  m.F.resize(12, 3);
  m.F << 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6,
      1, 3, 5, 3, 7, 5;
  return m;
}

/// Octahedron refined `levels` times, vertices on the sphere: 8 * 4^levels triangles.
inline TriMesh sphere(double radius, const Eigen::Vector3d& centre, int levels) {
  std::vector<Eigen::Vector3d> p{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                 {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  std::vector<Eigen::Vector3i> f{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                 {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto mid = [&](int a, int b) {
      const auto [it, is_new] = middle.emplace(std::minmax(a, b), static_cast<int>(p.size()));
      if (is_new) p.push_back((p[a] + p[b]).normalized());
      return it->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const Eigen::Vector3i& t : f) {
      const int a = mid(t(0), t(1)), b = mid(t(1), t(2)), c = mid(t(2), t(0));
      finer.insert(finer.end(), {{t(0), a, c}, {t(1), b, a}, {t(2), c, b}, {a, b, c}});
    }
    f = std::move(finer);
  }
  TriMesh m;
  m.V.resize(p.size(), 3);
  for (std::size_t i = 0; i < p.size(); ++i) m.V.row(i) = (centre + radius * p[i]).transpose();
  m.F.resize(f.size(), 3);
  for (std::size_t i = 0; i < f.size(); ++i) m.F.row(i) = f[i].transpose();
  return m;
}

/// Closed surface over a periodic (u, v) grid of n x m points.
inline TriMesh periodic_grid(int n, int m,
                             const std::function<Eigen::Vector3d(double, double)>& point) {
  TriMesh mesh;
  mesh.V.resize(n * m, 3);
  mesh.F.resize(2 * n * m, 3);
  const auto id = [&](int i, int j) { return (i % n) * m + j % m; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      mesh.V.row(id(i, j)) = point(2 * std::numbers::pi * i / n, 2 * std::numbers::pi * j / m);
      const int t = 2 * (i * m + j);
      mesh.F.row(t) << id(i, j), id(i + 1, j), id(i + 1, j + 1);
      mesh.F.row(t + 1) << id(i, j), id(i + 1, j + 1), id(i, j + 1);
    }
  }
  return mesh;
}

/// Torus about the z axis; self-overlapping (a spindle) for tube > ring.
inline TriMesh torus(double ring, double tube, int n, int m) {
  return periodic_grid(n, m, [=](double u, double v) {
    const double r = ring + tube * std::cos(v);
    return Eigen::Vector3d(r * std::cos(u), r * std::sin(u), tube * std::sin(v));
  });
}

/// Both meshes as one.
inline TriMesh together(const TriMesh& a, const TriMesh& b) {
  TriMesh m;
  m.V.resize(a.V.rows() + b.V.rows(), 3);
  m.V << a.V, b.V;
  m.F.resize(a.F.rows() + b.F.rows(), 3);
  m.F << a.F, (b.F.array() + a.vertex_count()).matrix();
  return m;
}

/// Triangles turned inside out.
inline TriMesh inverted(TriMesh m) {
  m.F.col(1).swap(m.F.col(2));
  return m;
}

inline Eigen::AlignedBox3d bounds(const Eigen::MatrixX3d& V) {
  Eigen::AlignedBox3d b;
  for (Eigen::Index v = 0; v < V.rows(); ++v) b.extend(V.row(v).transpose());
  return b;
}

}  // namespace geoprior::shapes
