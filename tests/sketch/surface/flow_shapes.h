#pragma once

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "core/random.h"
#include "metrics/developability/developability.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

/// Surfaces of which one knows how developable they are.
namespace geoprior::flow_shapes {

/// Open frustum about the z axis between two circles, its triangles cut out of planar trapezoids:
/// developable to rounding, rulings are edges. Equal radii: a prism ("cylinder").
inline TriMesh frustum(double low_radius, double high_radius, double height, int sectors,
                       int rows) {
  TriMesh mesh;
  mesh.V.resize(sectors * (rows + 1), 3);
  mesh.F.resize(2 * sectors * rows, 3);
  for (int j = 0; j <= rows; ++j) {
    const double s = static_cast<double>(j) / rows;
    const double r = low_radius + s * (high_radius - low_radius);
    for (int i = 0; i < sectors; ++i) {
      const double angle = 2 * std::numbers::pi * i / sectors;
      mesh.V.row(j * sectors + i) << r * std::cos(angle), r * std::sin(angle), s * height;
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < sectors; ++i) {
      const int a = j * sectors + i, b = j * sectors + (i + 1) % sectors;
      const int c = b + sectors, d = a + sectors, t = 2 * a;
      if ((i + j) % 2 == 0)
        mesh.F.row(t) << a, b, c, mesh.F.row(t + 1) << a, c, d;
      else
        mesh.F.row(t) << a, b, d, mesh.F.row(t + 1) << b, c, d;
    }
  }
  return mesh;
}

inline TriMesh cylinder() { return frustum(0.2, 0.2, 0.6, 40, 24); }
inline TriMesh cone() { return frustum(0.25, 0.1, 0.6, 40, 24); }
/// A sheet that is folded by 50 degrees along edges.
inline TriMesh tent() {
  return sheets::folded(0.5, 0.4, 20, 16, 50 * std::numbers::pi / 180).mesh();
}

/// Sphere whose radius varies: 8 * 4^levels triangles, closed, no part of it developable.
inline TriMesh bumpy_sphere(int levels) {
  TriMesh mesh = shapes::sphere(1, {0, 0, 0}, levels);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const Eigen::RowVector3d p = mesh.V.row(v);
    mesh.V.row(v) *= 1 + 0.15 * std::sin(4 * p.x()) * std::cos(3 * p.y() + p.z());
  }
  return mesh;
}

/// The mesh with its interior vertices moved at random by up to `amount` in every coordinate.
inline TriMesh noisy(TriMesh mesh, double amount, bool move_border = false) {
  RandomStream random(11, "noise of a surface");
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    for (int k = 0; k < 3; ++k) {
      const double move = amount * (2 * random.uniform() - 1);
      if (move_border || !border[v]) mesh.V(v, k) += move;
    }
  }
  return mesh;
}

inline double sum_of_defects(const TriMesh& mesh) { return angle_defect(mesh).cwiseAbs().sum(); }

/// Largest difference of a gradient from central differences of `energy`, over the largest entry of
/// the gradient.
template <class Energy>
double gradient_error(Energy&& energy, const Eigen::MatrixX3d& x, double step) {
  Eigen::MatrixX3d gradient, ignored;
  energy(x, &gradient);
  double largest = 0;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    for (int k = 0; k < 3; ++k) {
      Eigen::MatrixX3d up = x, down = x;
      up(v, k) += step;
      down(v, k) -= step;
      const double slope = (energy(up, nullptr) - energy(down, nullptr)) / (2 * step);
      largest = std::max(largest, std::abs(slope - gradient(v, k)));
    }
  }
  return largest / gradient.cwiseAbs().maxCoeff();
}

inline bool same_bytes(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b) {
  return a.rows() == b.rows() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Positions after some steps of a flow with a limited number of threads.
template <class Flow>
Eigen::MatrixX3d after_steps(const TriMesh& mesh, int steps, int threads) {
  Eigen::MatrixX3d x;
  with_threads(threads, [&] {
    Flow flow(mesh);
    for (int i = 0; i < steps; ++i) flow.step();
    x = flow.surface().V;
  });
  return x;
}

}  // namespace geoprior::flow_shapes
