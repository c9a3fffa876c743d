#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "models/paper/shell/state.h"

/// Meshes of sheets whose answer is known, for the tests of the paper topic.
namespace geoprior::paper::meshes {

/// Grid of `columns` x `rows` cells over [0, width] x [0, height]; diagonals all from lower left to
/// upper right, or alternating.
inline ShellMesh grid(int columns, int rows, double width, double height, bool alternating) {
  ShellMesh mesh;
  mesh.pattern.resize((columns + 1) * (rows + 1), 2);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i)
      mesh.pattern.row(j * (columns + 1) + i) << width * i / columns, height * j / rows;
  mesh.triangles.resize(2 * columns * rows, 3);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      const int t = 2 * (j * columns + i);
      if (alternating && (i + j) % 2 == 1) {
        mesh.triangles.row(t) << a, b, d;
        mesh.triangles.row(t + 1) << b, c, d;
      } else {
        mesh.triangles.row(t) << a, b, c;
        mesh.triangles.row(t + 1) << a, c, d;
      }
    }
  return mesh;
}

/// Equilateral triangles of side `edge`; every second row is shifted by half an edge, so that two
/// sides of the sheet are zigzags.
inline ShellMesh equilateral(int columns, int rows, double edge) {
  ShellMesh mesh =
      grid(columns, rows, edge * columns, edge * std::numbers::sqrt3 / 2 * rows, false);
  for (int j = 1; j <= rows; j += 2)
    for (int i = 0; i <= columns; ++i) mesh.pattern(j * (columns + 1) + i, 0) += edge / 2;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      const int t = 2 * (j * columns + i);
      if (j % 2 == 0) {
        mesh.triangles.row(t) << a, b, d;
        mesh.triangles.row(t + 1) << b, c, d;
      }
    }
  return mesh;
}

inline double twice_area(const ShellMesh& mesh, int a, int b, int c) {
  const Eigen::RowVector2d e = mesh.pattern.row(b) - mesh.pattern.row(a);
  const Eigen::RowVector2d f = mesh.pattern.row(c) - mesh.pattern.row(a);
  return e.x() * f.y() - e.y() * f.x();
}

/// Positive when `d` lies inside the circle through a, b, c (counter-clockwise).
inline double in_circle(const ShellMesh& mesh, int a, int b, int c, int d) {
  Eigen::Matrix3d M;
  const int corner[] = {a, b, c};
  for (int k = 0; k < 3; ++k) {
    const Eigen::RowVector2d r = mesh.pattern.row(corner[k]) - mesh.pattern.row(d);
    M.row(k) << r, r.squaredNorm();
  }
  return M.row(0).dot(M.row(1).cross(M.row(2)));
}

/// Flips edges (Lawson) until every triangle's circle is empty.
inline void make_delaunay(ShellMesh& mesh) {
  const double scale = std::pow(
      std::abs(twice_area(mesh, mesh.triangles(0, 0), mesh.triangles(0, 1), mesh.triangles(0, 2))),
      2);
  for (bool flipped = true; flipped;) {
    flipped = false;
    std::map<std::pair<int, int>, std::pair<int, int>> side;  // directed edge: triangle, corner
    for (int t = 0; t < mesh.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k)
        side[{mesh.triangles(t, k), mesh.triangles(t, (k + 1) % 3)}] = {t, k};
    std::vector<bool> touched(mesh.triangle_count(), false);
    for (const auto& [edge, place] : side) {
      const auto twin = side.find({edge.second, edge.first});
      if (edge.first > edge.second || twin == side.end()) continue;
      const int t = place.first, u = twin->second.first;
      if (touched[t] || touched[u]) continue;
      const int a = edge.first, b = edge.second, c = mesh.triangles(t, (place.second + 2) % 3),
                d = mesh.triangles(u, (twin->second.second + 2) % 3);
      if (in_circle(mesh, a, b, c, d) < 1e-9 * scale) continue;
      mesh.triangles.row(t) << a, d, c;
      mesh.triangles.row(u) << d, b, c;
      touched[t] = touched[u] = flipped = true;
    }
  }
}

/// Random Delaunay mesh of [0, width] x [0, height]: a grid whose vertices walk at random (those of
/// the border along it, corners not), with flips between the walks.
inline ShellMesh delaunay(int columns, int rows, double width, double height,
                          std::uint64_t seed = 1) {
  ShellMesh mesh = grid(columns, rows, width, height, true);
  RandomStream random(seed, "delaunay test mesh");
  const double step_u = 0.2 * width / columns, step_v = 0.2 * height / rows;
  const double smallest = 0.3 * width / columns * height / rows;
  for (int round = 0; round < 6; ++round) {
    std::vector<std::vector<int>> star(mesh.vertex_count());
    for (int t = 0; t < mesh.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) star[mesh.triangles(t, k)].push_back(t);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const int i = v % (columns + 1), j = v / (columns + 1);
      const Eigen::RowVector2d before = mesh.pattern.row(v);
      const double du = step_u * random.normal(), dv = step_v * random.normal();
      if (i != 0 && i != columns) mesh.pattern(v, 0) += du;
      if (j != 0 && j != rows) mesh.pattern(v, 1) += dv;
      const auto& around = star[v];
      if (std::any_of(around.begin(), around.end(), [&](int t) {
            return twice_area(mesh, mesh.triangles(t, 0), mesh.triangles(t, 1),
                              mesh.triangles(t, 2)) < smallest;
          }))
        mesh.pattern.row(v) = before;
    }
    make_delaunay(mesh);
  }
  return mesh;
}

/// Strips between `count` + 1 parallel rulings that run from border to border of [0, width] x
/// [0, height], sheared by `slant` (du per dv).
inline ShellMesh ruling_strips(int count, double width, double height, double slant = 0) {
  ShellMesh mesh = grid(count, 1, width, height, false);
  mesh.pattern.col(0) += slant * mesh.pattern.col(1);
  return mesh;
}

/// Strips between rulings through an apex at the origin: the sector of `angle` (rad) between radii.
inline ShellMesh cone_strips(int count, double inner, double outer, double angle) {
  ShellMesh mesh = grid(count, 1, angle, 1, false);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double t = angle - mesh.pattern(v, 0), r = inner + (outer - inner) * mesh.pattern(v, 1);
    mesh.pattern.row(v) << r * std::cos(t), r * std::sin(t);
  }
  return mesh;
}

/// Triangles about an apex at the origin: the sector of `angle` (rad).
inline ShellMesh fan(int count, double radius, double angle) {
  ShellMesh mesh;
  mesh.pattern = Eigen::MatrixX2d::Zero(count + 2, 2);
  mesh.triangles.resize(count, 3);
  for (int i = 0; i <= count; ++i)
    mesh.pattern.row(i + 1) << radius * std::cos(angle * i / count),
        radius * std::sin(angle * i / count);
  for (int i = 0; i < count; ++i) mesh.triangles.row(i) << 0, i + 1, i + 2;
  return mesh;
}

/// The same triangles on the pattern turned by `angle` (rad) about the origin.
inline ShellMesh turned(ShellMesh mesh, double angle) {
  Eigen::Matrix2d R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  mesh.pattern = (mesh.pattern * R.transpose()).eval();
  return mesh;
}

/// A sheet at rest in the plane z = 0.
inline ShellState flat_state(const ShellMesh& mesh) {
  ShellState state;
  state.mesh = mesh;
  state.x = Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3);
  state.x.leftCols(2) = mesh.pattern;
  state.v = Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3);
  state.plastic_curvature = Eigen::MatrixX3d::Zero(mesh.triangle_count(), 3);
  state.damage = Eigen::VectorXd::Zero(mesh.triangle_count());
  return state;
}

/// Isometric image of a pattern on the cylinder of curvature `kappa` (1/m) whose axis makes `angle`
/// (rad) with the v axis of the pattern; a valley seen from the normals' side.
inline Eigen::MatrixX3d rolled(const Eigen::MatrixX2d& pattern, double kappa, double angle) {
  Eigen::MatrixX3d x(pattern.rows(), 3);
  const Eigen::Vector2d across(std::cos(angle), std::sin(angle));
  const Eigen::Vector2d along(-across.y(), across.x());
  for (Eigen::Index v = 0; v < pattern.rows(); ++v) {
    const double s = pattern.row(v).dot(across), t = pattern.row(v).dot(along);
    const Eigen::Vector2d flat = std::sin(kappa * s) / kappa * across + t * along;
    x.row(v) << flat.x(), flat.y(), (1 - std::cos(kappa * s)) / kappa;
  }
  return x;
}

/// Isometric image of a pattern on the circular cone with apex at the origin whose curvature at
/// distance r from it is `curvature` / r; valley as in `rolled`.
inline Eigen::MatrixX3d coned(const Eigen::MatrixX2d& pattern, double curvature) {
  // On the unit sphere the cone is a circle of geodesic curvature `curvature`, of radius `circle`.
  const double circle = 1 / std::hypot(1.0, curvature), height = curvature * circle;
  Eigen::MatrixX3d x(pattern.rows(), 3);
  for (Eigen::Index v = 0; v < pattern.rows(); ++v) {
    const double r = pattern.row(v).norm();
    const double turn = std::atan2(pattern(v, 1), pattern(v, 0)) / circle;
    x.row(v) << r * circle * std::cos(turn), r * circle * std::sin(turn), r * height;
  }
  return x;
}

struct NamedMesh {
  std::string name;
  ShellMesh mesh;
};

/// One of every kind, about a sheet of 1 x 1.
inline std::vector<NamedMesh> every_kind() {
  return {{"grid", grid(8, 8, 1, 1, false)},
          {"alternating grid", grid(8, 8, 1, 1, true)},
          {"stretched grid", grid(4, 20, 1, 1, false)},
          {"equilateral", equilateral(8, 9, 0.125)},
          {"random Delaunay", delaunay(8, 8, 1, 1)},
          {"ruling strips", ruling_strips(9, 1, 1)},
          {"slanted ruling strips", ruling_strips(9, 1, 1, 0.5)},
          {"cone strips", cone_strips(9, 0.2, 1, 1.5)}};
}

}  // namespace geoprior::paper::meshes
