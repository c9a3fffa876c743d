#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/inputs/surface_sequence.h"
#include "core/random.h"
#include "experiments/fluid/injected/contour.h"

namespace geoprior::fluid::surfaces {

/// Graph z = f(x, y) over [-a, a]^2 in n x n squares, inner vertices moved at random by up to
/// `jitter` of the spacing, diagonals at random.
inline TriMesh graph(double a, int n, double jitter, const std::function<double(double, double)>& f,
                     std::uint64_t seed = 1) {
  RandomStream random(seed, "graph");
  const double h = 2 * a / n;
  TriMesh mesh;
  mesh.V.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && j > 0 && i < n && j < n;
      const double s = inner ? 2 * jitter * h : 0;
      const double x = -a + h * i + s * (random.uniform() - 0.5);
      const double y = -a + h * j + s * (random.uniform() - 0.5);
      mesh.V.row(j * (n + 1) + i) << x, y, f(x, y);
    }
  }
  mesh.F.resize(2 * n * n, 3);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int p = j * (n + 1) + i, q = p + 1, r = p + n + 2, s = p + n + 1;
      const int t = 2 * (j * n + i);
      if (random.uniform() < 0.5) {
        mesh.F.row(t) << p, q, r;
        mesh.F.row(t + 1) << p, r, s;
      } else {
        mesh.F.row(t) << p, q, s;
        mesh.F.row(t + 1) << q, r, s;
      }
    }
  }
  return mesh;
}

/// Mean curvature of a graph from its derivatives, positive on crests.
inline double graph_curvature(double zx, double zy, double zxx, double zxy, double zyy) {
  const double w = 1 + zx * zx + zy * zy;
  return -((1 + zy * zy) * zxx - 2 * zx * zy * zxy + (1 + zx * zx) * zyy) / (2 * w * std::sqrt(w));
}

/// Level set 0 of a function, negative inside, contoured on a lattice: slivers included.
inline TriMesh contour(const Eigen::AlignedBox3d& box, double h,
                       const std::function<double(const Eigen::Vector3d&)>& f) {
  LatticeContour contour(box.min(), h);
  const Eigen::Vector3i n = (box.sizes() / h).array().ceil().cast<int>();
  for (int k = 0; k < n.z(); ++k) {
    for (int j = 0; j < n.y(); ++j) {
      for (int i = 0; i < n.x(); ++i) {
        double values[8];
        for (int c = 0; c < 8; ++c) {
          const Eigen::Vector3d node(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
          values[c] = f(box.min() + h * node);
        }
        contour.add_cell(i, j, k, values);
      }
    }
  }
  return contour.mesh();
}

inline TriMesh sphere(const Eigen::Vector3d& centre, double radius, double h) {
  const Eigen::Vector3d r = Eigen::Vector3d::Constant(radius + 2.3 * h);
  return contour({centre - r, centre + r}, h,
                 [&](const Eigen::Vector3d& x) { return (x - centre).norm() - radius; });
}

inline TriMesh turned_over(TriMesh mesh) {
  mesh.F.col(1).swap(mesh.F.col(2));
  return mesh;
}

inline void append(const TriMesh& part, TriMesh& whole) {
  const Eigen::Index n = whole.V.rows(), m = whole.F.rows();
  whole.V.conservativeResize(n + part.V.rows(), 3);
  whole.V.bottomRows(part.V.rows()) = part.V;
  whole.F.conservativeResize(m + part.F.rows(), 3);
  whole.F.bottomRows(part.F.rows()) = part.F.array() + static_cast<int>(n);
}

inline StoredSequence still(const TriMesh& mesh) {
  return StoredSequence({SurfaceFrame{0, mesh, {}, {}}}, "still");
}

}  // namespace geoprior::fluid::surfaces
