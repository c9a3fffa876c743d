#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

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

/// A rectangle that is folded by `angle` along u = 0, on a mesh with edges there (nx even) and
/// everywhere else irregular; its pattern is turned by `turn`.
inline Sheet folded(double width, double height, int nx, int ny, double angle, double turn = 0) {
  Sheet s = rectangle(width, height, nx, ny, 0.25);
  for (int j = 0; j <= ny; ++j) s.pattern(nx / 2 * (ny + 1) + j, 0) = 0;
  return turned_pattern(mapped(s, fold(angle)), turn);
}

/// Rolled about an axis parallel to v: an isometry.
inline Map cylinder(double radius) {
  return [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    return {radius * std::sin(p(0) / radius), p(1), radius * (1 - std::cos(p(0) / radius))};
  };
}

/// Miura-ori: planar parallelograms folded along every one of their sides, an isometric image of
/// its pattern with no angle defect anywhere. Shifts as in Schenk and Guest 2013.
struct Miura {
  double S = 0.02, V = 0.012, L = 0.018, H = 0.01;  ///< m
  int columns = 10, rows = 10;                      ///< parallelograms
};
inline Sheet miura_ori(const Miura& m = {}) {
  Sheet s = rectangle(1, 1, m.columns, m.rows);
  s.x.resize(s.pattern.rows(), 3);
  const double a = std::hypot(m.L, m.H);
  const double V0 = m.V * m.L / a;  // the angle between the sides is kept
  const double S0 = std::sqrt(m.S * m.S + m.V * m.V - V0 * V0);
  for (int i = 0; i <= m.columns; ++i) {
    for (int j = 0; j <= m.rows; ++j) {
      const int v = i * (m.rows + 1) + j;
      s.pattern.row(v) << S0 * i, a * j + V0 * (i % 2);
      s.x.row(v) << m.S * i, m.L * j + m.V * (i % 2), m.H * (j % 2);
    }
  }
  return s;
}

/// Disc of `rings` rings and `spokes` spokes about a centre vertex: edges are rulings.
inline Sheet disc(double radius, int rings, int spokes) {
  Sheet s;
  s.pattern = Eigen::MatrixX2d::Zero(1 + rings * spokes, 2);
  s.triangles.resize(spokes * (2 * rings - 1), 3);
  const auto id = [&](int ring, int spoke) { return 1 + (ring - 1) * spokes + spoke % spokes; };
  for (int r = 1; r <= rings; ++r) {
    for (int k = 0; k < spokes; ++k) {
      const double angle = 2 * std::numbers::pi * k / spokes;
      s.pattern.row(id(r, k)) << radius * r / rings * std::cos(angle),
          radius * r / rings * std::sin(angle);
    }
  }
  int t = 0;
  for (int k = 0; k < spokes; ++k) s.triangles.row(t++) << 0, id(1, k), id(1, k + 1);
  for (int r = 1; r < rings; ++r) {
    for (int k = 0; k < spokes; ++k) {
      s.triangles.row(t++) << id(r, k), id(r + 1, k), id(r + 1, k + 1);
      s.triangles.row(t++) << id(r, k), id(r + 1, k + 1), id(r, k + 1);
    }
  }
  return mapped(s, flat);
}

/// An isometric d-cone, apex at the origin: the disc's rays go to the rays through a closed curve
/// of length 2 pi on the unit sphere, elevation beta(t) = tilt cos(lobes t) + offset over azimuth
/// t, the offset such that the length is 2 pi.
class DCone {
 public:
  DCone(double tilt, int lobes) : tilt_(tilt), lobes_(lobes) {
    double low = 0;  // too long there, for two lobes or more
    double high = 1.2;
    for (int i = 0; i < 60; ++i) {
      offset_ = (low + high) / 2;
      tabulate();
      (length_.back() > 2 * std::numbers::pi ? low : high) = offset_;
    }
  }
  [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector2d& p) const {
    const double wanted =
        std::fmod(std::atan2(p(1), p(0)) + 2 * std::numbers::pi, 2 * std::numbers::pi) *
        length_.back() / (2 * std::numbers::pi);
    const auto next = std::upper_bound(length_.begin() + 1, length_.end() - 1, wanted);
    const auto i = static_cast<double>(next - length_.begin());
    const double part = (wanted - *(next - 1)) / (*next - *(next - 1));
    return p.norm() * on_sphere((i - 1 + part) * kStep);
  }

 private:
  static constexpr int kSteps = 4096;
  static constexpr double kStep = 2 * std::numbers::pi / kSteps;
  [[nodiscard]] Eigen::Vector3d on_sphere(double t) const {
    const double beta = tilt_ * std::cos(lobes_ * t) + offset_;
    return {std::cos(beta) * std::cos(t), std::cos(beta) * std::sin(t), std::sin(beta)};
  }
  void tabulate() {
    length_.assign(1, 0);
    for (int i = 0; i < kSteps; ++i) {
      const double chord = (on_sphere((i + 1) * kStep) - on_sphere(i * kStep)).norm();
      length_.push_back(length_.back() + 2 * std::asin(chord / 2));
    }
  }
  double tilt_, offset_ = 0;
  int lobes_;
  std::vector<double> length_;
};

}  // namespace geoprior::sheets
