#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "baselines/paper/dense.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/shell/stepper.h"

/// Small sheets in motion, for the tests of the stepper.
namespace geoprior::paper::sheets {

inline constexpr std::array<Integration, 2> kIntegrations{Integration::linear, Integration::newton};

/// A sheet without handles, obstacles, gravity or imperfection.
inline Sheet free_sheet(double width, double height) {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(width, height);
  sheet.gravity.setZero();
  sheet.imperfection = 0;
  return sheet;
}

inline Handle point_handle(const std::string& name, std::vector<Eigen::Vector2d> points,
                           std::vector<Keyframe> keys = {Keyframe{}}) {
  Handle handle;
  handle.name = name;
  handle.points = std::move(points);
  handle.motion = Trajectory{std::move(keys)};
  return handle;
}

/// Two hands that pull a small sheet with a cut apart, 4 cm of tear in 0.8 s.
inline Sheet pulled_sheet() {
  Sheet sheet = free_sheet(0.12, 0.16);
  sheet.pattern.cuts = {{{0, -0.08}, {0, -0.04}}};
  sheet.imperfection = 1e-5;
  sheet.toughness.energy = 1e4;
  sheet.duration = 0.8;
  for (const double side : {-1.0, 1.0}) {
    Keyframe start, end;
    end.time = 0.8;
    end.shift = Eigen::Vector3d(side * 0.04, 0, 0);
    sheet.handles.push_back(
        point_handle(side < 0 ? "left" : "right", {{side * 0.05, -0.08}}, {start, end}));
    sheet.handles.back().stiffness = 500;
  }
  return sheet;
}

inline ShellState at_rest(const Sheet& sheet, int triangles,
                          UniformLayout layout = UniformLayout::structured) {
  return resting_state(
      sheet, uniform_mesh(sheet.pattern, triangles, layout, handle_points(sheet, 0.05), 1), 1);
}

/// Places the flat sheet by `placement`: pattern (u, v, 0) to space.
inline void put(ShellState& state, const Eigen::Isometry3d& placement) {
  for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
    const Eigen::Vector3d flat(state.mesh.pattern(i, 0), state.mesh.pattern(i, 1), 0);
    state.x.row(i) = placement * flat;
  }
}

inline double area(const ShellMesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Eigen::RowVector2d a = mesh.pattern.row(mesh.triangles(t, 0));
    const Eigen::RowVector2d b = mesh.pattern.row(mesh.triangles(t, 1)) - a;
    const Eigen::RowVector2d c = mesh.pattern.row(mesh.triangles(t, 2)) - a;
    sum += (b.x() * c.y() - b.y() * c.x()) / 2;
  }
  return sum;
}

inline double mass(const Sheet& sheet, const ShellState& state) {
  return sheet.material.area_density * area(state.mesh);
}

inline double total(const ShellEnergies& e) {
  return e.membrane + e.bending + e.kinetic + e.gravity + e.contact;
}

inline StepReport advance(ShellStepper& stepper, ShellState& state, double dt, int steps) {
  RunContext context;
  StepReport last;
  for (int k = 0; k < steps; ++k) last = stepper.step(state, dt, context);
  return last;
}

}  // namespace geoprior::paper::sheets
