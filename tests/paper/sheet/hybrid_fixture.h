#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/numerics/jacobi_svd.h"
#include "core/random.h"
#include "models/paper/sheet/handle_speed.h"
#include "models/paper/sheet/sheet.h"
#include "solvers/paper/meshing/hybrid_mesher.h"

namespace geoprior::paper {

/// Time and shift of a handle.
using Keys = std::vector<std::pair<double, Eigen::Vector3d>>;

inline Trajectory trajectory(const Keys& keys) {
  Trajectory result;
  for (const auto& [time, shift] : keys) {
    Keyframe key;
    key.time = time;
    key.shift = shift;
    result.keys.push_back(key);
  }
  return result;
}

inline Handle point_handle(const std::string& name, const Eigen::Vector2d& p, const Keys& keys) {
  Handle handle;
  handle.name = name;
  handle.points = {p};
  handle.motion = trajectory(keys);
  return handle;
}

inline Handle edge_handle(const std::string& name, const Eigen::Vector2d& a,
                          const Eigen::Vector2d& b, const Keys& keys) {
  Handle handle;
  handle.name = name;
  handle.segment = {a, b};
  handle.motion = trajectory(keys);
  return handle;
}

/// A square of 0.2 m, no gravity, a little damped.
inline Sheet square_sheet(double duration) {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(0.2, 0.2);
  sheet.gravity.setZero();
  sheet.material.damping = 1e-3;
  sheet.duration = duration;
  return sheet;
}

/// Two opposite edges approach to 60 % of their distance in a second.
inline Sheet bent_sheet() {
  Sheet sheet = square_sheet(1.2);
  sheet.handles = {
      edge_handle("left", {-0.1, -0.1}, {-0.1, 0.1}, {{0, {0, 0, 0}}, {1, {0.04, 0, 0}}}),
      edge_handle("right", {0.1, -0.1}, {0.1, 0.1}, {{0, {0, 0, 0}}, {1, {-0.04, 0, 0}}})};
  return sheet;
}

/// The same with a round hole of 4 cm beside its middle.
inline Sheet bent_sheet_with_hole() {
  Sheet sheet = bent_sheet();
  std::vector<Eigen::Vector2d> hole = disc_pattern(0.02, 16).border;
  for (Eigen::Vector2d& p : hole) p += Eigen::Vector2d(0.015, -0.02);
  sheet.pattern.holes = {{hole.rbegin(), hole.rend()}};
  return sheet;
}

/// Bent by its corners, then the corners of the left edge approach: thesis, Figure 3.10.
inline Sheet pinched_sheet() {
  Sheet sheet = square_sheet(2.2);
  const Eigen::Vector3d none(0, 0, 0), in(0.03, 0, 0);
  sheet.handles = {
      point_handle("left low", {-0.1, -0.1}, {{0, none}, {1, in}, {2, {0.03, 0.03, 0}}}),
      point_handle("left high", {-0.1, 0.1}, {{0, none}, {1, in}, {2, {0.03, -0.03, 0}}}),
      point_handle("right low", {0.1, -0.1}, {{0, none}, {1, -in}}),
      point_handle("right high", {0.1, 0.1}, {{0, none}, {1, -in}})};
  return sheet;
}

/// A letter sheet whose corners wander about at random, never farther apart than 0.9 of their
/// distance in the pattern.
inline Sheet wandering_sheet(std::uint64_t seed, int frames) {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(0.21, 0.297);
  sheet.material.damping = 1e-3;
  sheet.duration = frames * sheet.frame_interval;
  RandomStream random(seed, "handle motion");
  std::vector<Eigen::Vector3d> rest;
  for (const Eigen::Vector2d& p : sheet.pattern.border) rest.emplace_back(p.x(), p.y(), 0);
  std::vector<Eigen::Vector3d> at = rest;
  std::vector<Keys> keys(4, {{0, {0, 0, 0}}});
  const auto ratio = [&](const std::vector<Eigen::Vector3d>& p, std::size_t i, std::size_t j) {
    return (p[i] - p[j]).norm() / (rest[i] - rest[j]).norm();
  };
  for (int second = 1; second <= static_cast<int>(sheet.duration) + 1; ++second) {
    for (bool feasible = false; !feasible;) {
      std::vector<Eigen::Vector3d> next = at, middle = at;
      for (std::size_t i = 0; i < 4; ++i) {
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        next[i] += 0.15 * Eigen::Vector3d(x - 0.5, y - 0.5, z - 0.5);
        middle[i] = (at[i] + next[i]) / 2;
      }
      feasible = true;
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          feasible = feasible && ratio(next, i, j) < 0.9 && ratio(next, i, j) > 0.3 &&
                     ratio(middle, i, j) > 0.25;
        }
      }
      if (feasible) at = next;
    }
    for (std::size_t i = 0; i < 4; ++i) keys[i].emplace_back(second, at[i] - rest[i]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    sheet.handles.push_back(
        point_handle("corner " + std::to_string(i), sheet.pattern.border[i], keys[i]));
  }
  return sheet;
}

using HybridLook = std::function<void(const HybridMesher&, const ShellState&)>;

/// Runs the hybrid model and shows each frame, if asked for also as the model finds it.
inline void run_hybrid(const Sheet& sheet, const HybridOptions& options, std::uint64_t seed,
                       const HybridLook& look, const HybridLook& look_before = {}) {
  RunContext context(seed);
  HybridMesher mesher(options);
  ShellState state = mesher.start(sheet, context);
  ShellStepper stepper(sheet, options.stepper, seed);
  stepper.set_mesh(state);
  for (int frame = 1; frame < sheet.frame_count(); ++frame) {
    const double start = sheet.frame_time(frame - 1);
    const int substeps = substeps_of_frame(sheet, start, sheet.frame_time(frame));
    const double dt = (sheet.frame_time(frame) - start) / substeps;
    for (int i = 0; i < substeps; ++i) {
      state.time = start + i * dt;
      stepper.step(state, dt, context);
      mesher.stepped(sheet, stepper, state, context);
    }
    state.time = sheet.frame_time(frame);
    if (look_before) look_before(mesher, state);
    if (mesher.adapt(sheet, stepper, state, context)) {
      stepper.set_mesh(state);
      const bool stays = mesher.settle(sheet, stepper, state, context);
      if (!stays && mesher.take_back(sheet, state, context)) stepper.set_mesh(state);
    }
    look(mesher, state);
  }
}

/// Stretches sigma_1 >= sigma_2 of a triangle's map from the pattern, and the triangle's area
/// there.
struct Stretch {
  Eigen::Vector2d sigma;
  double area = 0;
};
inline Stretch stretch(const ShellState& state, int f) {
  const Eigen::RowVector3i t = state.mesh.triangles.row(f);
  Eigen::Matrix2d rest;
  Eigen::Matrix<double, 3, 2> now;
  for (int k = 0; k < 2; ++k) {
    rest.col(k) = state.mesh.pattern.row(t[k + 1]) - state.mesh.pattern.row(t[0]);
    now.col(k) = state.x.row(t[k + 1]) - state.x.row(t[0]);
  }
  const Eigen::MatrixXd F = now * rest.inverse();
  return {Eigen::JacobiSVD<Eigen::MatrixXd>(F).singularValues(), rest.determinant() / 2};
}

/// RMS (by area) and largest |sigma - 1| of the map from the pattern.
struct Isometry {
  double rms = 0, largest = 0;
};
inline Isometry isometry(const ShellState& state) {
  double sum = 0, whole = 0, largest = 0;
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    const Stretch s = stretch(state, f);
    const Eigen::Vector2d off = s.sigma.array() - 1;
    sum += s.area * off.squaredNorm();
    whole += 2 * s.area;
    largest = std::max(largest, off.cwiseAbs().maxCoeff());
  }
  return {std::sqrt(sum / whole), largest};
}

/// By how much the ends of a ruling's path through space have approached, relative to its length:
/// the path goes over the vertices that lie on the ruling in the pattern.
inline double shortening(const ShellState& state, const Ruling& ruling) {
  const Eigen::Vector2d along = ruling.b - ruling.a;
  std::vector<std::pair<double, Eigen::Index>> path;
  for (Eigen::Index v = 0; v < state.mesh.pattern.rows(); ++v) {
    const Eigen::Vector2d p = state.mesh.pattern.row(v).transpose() - ruling.a;
    const double t = p.dot(along) / along.squaredNorm();
    if ((p - t * along).norm() < 1e-9 && t > -1e-9 && t < 1 + 1e-9) path.emplace_back(t, v);
  }
  std::sort(path.begin(), path.end());
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (state.x.row(path[i].second) - state.x.row(path[i - 1].second)).norm();
  if (!(length > 0)) return 0;
  return 1 - (state.x.row(path.back().second) - state.x.row(path.front().second)).norm() / length;
}

/// Largest compression of a sheet: of a triangle (strain (1 - sigma_2^2) / 2), or along a ruling
/// that has given way.
inline double largest_compression(const PaperStructure& structure, const ShellState& state) {
  double most = 0;
  for (int f = 0; f < state.mesh.triangle_count(); ++f) {
    const double sigma = stretch(state, f).sigma[1];
    most = std::max(most, (1 - sigma * sigma) / 2);
  }
  for (const Ruling& ruling : structure.rulings) most = std::max(most, shortening(state, ruling));
  return most;
}

}  // namespace geoprior::paper
