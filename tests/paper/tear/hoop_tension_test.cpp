// Where a tear that has run into a hole goes on.

#include "models/paper/tear/hoop_tension.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "baselines/paper/dense.h"
#include "core/angles.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "solvers/paper/hybrid.h"
#include "tests/paper/sheets.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

constexpr double kHoleRadius = 0.02;

/// A hole of `corners` corners on a circle about a point, clockwise, the first at `turn_deg`.
std::vector<Vector2d> round_hole(const Vector2d& centre, double radius, int corners,
                                 double turn_deg) {
  std::vector<Vector2d> loop;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn_deg * kDegree - i * 2 * std::numbers::pi / corners;
    loop.emplace_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return loop;
}

/// Displacement of a plate with a hole of radius a about the origin under the stress s along u, in
/// plane stress (Kirsch 1898), over s a / 8 G.
Vector2d kirsch(const Vector2d& p, double a, double nu) {
  const double kappa = (3 - nu) / (1 + nu), r = p.norm() / a, angle = std::atan2(p.y(), p.x());
  const double c = std::cos(2 * angle), s = std::sin(2 * angle);
  const double radial =
      r * (kappa - 1 + 2 * c) + 2 / r * (1 + (kappa + 1) * c) - 2 / (r * r * r) * c;
  const double around = -2 * r * s + 2 / r * (1 - kappa - 1 / (r * r)) * s;
  return radial * p.normalized() + around * Vector2d(-p.y(), p.x()).normalized();
}

/// A plate pulled along a direction, with a hole of any polygon.
ShellState kirsch_state(const Sheet& sheet, double pull_deg) {
  const ShellMesh mesh = lattice_mesh(sheet.pattern, 5e-3, UniformLayout::equilateral, {}, 1);
  ShellState state = resting_state(sheet, mesh, 1);
  const Eigen::Rotation2Dd turn(pull_deg * kDegree);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector2d p = mesh.pattern.row(v);
    const Vector2d u = turn * kirsch(turn.inverse() * p, kHoleRadius, sheet.material.poisson_ratio);
    state.x.row(v) << (p + 1e-6 * u).transpose(), 0;
  }
  return state;
}

/// The tension is greatest across the pull (Kirsch 1898), whatever the polygon and however it is
/// turned: within 3 degrees, a tenth of an edge of the dodecagon.
TEST(HoopTension, IsGreatestAcrossThePullOnAnyPolygon) {
  for (const int corners : {12, 24, 96}) {
    for (const double turn : {0.0, 4.0, 11.0}) {
      for (const double pull : {0.0, 25.0, 70.0}) {
        Sheet sheet = sheets::free_sheet(0.16, 0.16);
        sheet.pattern.holes = {round_hole({0, 0}, kHoleRadius, corners, turn)};
        const ShellState state = kirsch_state(sheet, pull);
        const auto peak =
            greatest_hoop_tension(sheet, state, MeshNeighbours(state.mesh), sheet.pattern.holes[0]);
        ASSERT_TRUE(peak);
        const double at = std::atan2(peak->place.y(), peak->place.x()) / kDegree;
        EXPECT_NEAR(std::remainder(at - pull - 90, 180), 0, 3)
            << corners << " corners turned by " << turn << ", pulled at " << pull;
      }
    }
  }
}

/// Two hands pull a sheet with a hole apart; the tear runs into it from below.
Sheet holed_sheet(int corners, double turn_deg) {
  Sheet sheet = sheets::pulled_sheet();
  sheet.pattern.holes = {round_hole({0, -0.02}, 8e-3, corners, turn_deg)};
  return sheet;
}

/// Where on the hole a tear begins (degrees about its centre); NaN: none does.
double restart(Process& process) {
  test::Recording recording;
  RunContext context(1);
  process.run(recording, context, {});
  const Part& tears = recording.frames.back().parts.at("tears");
  const Eigen::MatrixXd& pattern =
      tears.require_array("pattern", NamedArray::On::points, 2, "tears").values;
  for (const std::vector<int>& line : tears.lines) {
    const Vector2d p = pattern.row(line.front()).transpose() - Vector2d(0, -0.02);
    if (p.norm() < 0.01) return std::atan2(p.y(), p.x()) / kDegree;
  }
  return std::nan("");
}

/// Pulls that are alike on both sides tear on from the hole's far side, whatever its polygon:
/// within 20 degrees, half an edge of this mesh (a millimetre is 7 degrees).
TEST(HoopTension, TearsGoOnFromTheFarSideOfAHole) {
  DenseOptions dense;
  dense.triangles = 600;
  for (const auto& [corners, turn] : {std::pair(12, 11.0), {24, 4.0}, {96, 0.0}}) {
    const Sheet sheet = holed_sheet(corners, turn);
    EXPECT_NEAR(restart(*make_dense_sheet(sheet, dense)), 90, 20) << corners << " " << turn;
  }
}

/// Its half a dozen triangles about the hole say little of where the border is stretched most: it
/// is the far half of the hole, no more.
TEST(HoopTension, TheHybridsTearGoesOnFromThatSideToo) {
  EXPECT_NEAR(restart(*make_hybrid_sheet(holed_sheet(24, 4), {})), 90, 80);
}

}  // namespace
}  // namespace geoprior::paper
