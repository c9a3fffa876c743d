#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "core/mesh.h"
#include "core/random.h"

/// Flat patterns, their triangulations and maps to space with a known answer.
namespace geoprior::sheets {

using Map = std::function<Eigen::Vector3d(const Eigen::Vector2d&)>;

struct Sheet {
  Eigen::MatrixX2d pattern;
  Eigen::MatrixX3i triangles;
  Eigen::MatrixX3d x;

  [[nodiscard]] TriMesh mesh() const { return {x, triangles}; }
};

inline Sheet mapped(Sheet sheet, const Map& map) {
  sheet.x.resize(sheet.pattern.rows(), 3);
  for (Eigen::Index v = 0; v < sheet.pattern.rows(); ++v) {
    sheet.x.row(v) = map(sheet.pattern.row(v).transpose()).transpose();
  }
  return sheet;
}

inline Eigen::Vector3d flat(const Eigen::Vector2d& p) { return {p(0), p(1), 0}; }

/// Rectangle about the origin, nx x ny squares with alternating diagonals; interior vertices moved
/// at random by `jitter` of a square's side.
inline Sheet rectangle(double width, double height, int nx, int ny, double jitter = 0) {
  Sheet s;
  s.pattern.resize((nx + 1) * (ny + 1), 2);
  s.triangles.resize(2 * nx * ny, 3);
  RandomStream random(7, "sheet");
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      const bool inside = i > 0 && i < nx && j > 0 && j < ny;
      const double du = inside ? jitter * (2 * random.uniform() - 1) : 0;
      const double dv = inside ? jitter * (2 * random.uniform() - 1) : 0;
      s.pattern.row(i * (ny + 1) + j) << width * ((i + du) / nx - 0.5),
          height * ((j + dv) / ny - 0.5);
    }
  }
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const int a = i * (ny + 1) + j, b = a + ny + 1, t = 2 * (i * ny + j);
      if ((i + j) % 2 == 0) {
        s.triangles.row(t) << a, b, b + 1;
        s.triangles.row(t + 1) << a, b + 1, a + 1;
      } else {
        s.triangles.row(t) << a, b, a + 1;
        s.triangles.row(t + 1) << b, b + 1, a + 1;
      }
    }
  }
  return mapped(s, flat);
}

/// The same sheet with its pattern turned about the origin; its place in space stays.
inline Sheet turned_pattern(Sheet sheet, double angle) {
  sheet.pattern = sheet.pattern * Eigen::Rotation2Dd(angle).toRotationMatrix().transpose();
  return sheet;
}

/// Folded by `angle` along u = `at`, up on the far side: an isometry.
inline Map fold(double angle, double at = 0) {
  return [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    const double beyond = p(0) - at;
    if (beyond <= 0) return {p(0), p(1), 0};
    return {at + beyond * std::cos(angle), p(1), beyond * std::sin(angle)};
  };
}

/// Rolled about an axis parallel to v: an isometry.
inline Map cylinder(double radius) {
  return [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    return {radius * std::sin(p(0) / radius), p(1), radius * (1 - std::cos(p(0) / radius))};
  };
}

}  // namespace geoprior::sheets
