// What pulls a sheet apart, against sheets whose energy release is known.

#include "models/paper/tear/tip_pull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "models/paper/tear/lips.h"
#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

int vertex_at(const ShellMesh& mesh, const Vector2d& p) {
  Eigen::Index nearest = 0;
  (mesh.pattern.rowwise() - p.transpose()).rowwise().norm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

/// A square of 0.2 m under the strain along u that one tension alone gives.
std::pair<Sheet, ShellState> stretched(double strain) {
  const Sheet sheet = sheets::free_sheet(0.2, 0.2);
  ShellState state = sheets::at_rest(sheet, 400);
  state.x.col(0) *= 1 + strain;
  state.x.col(1) *= 1 - sheet.material.poisson_ratio * strain;
  return {sheet, state};
}

TEST(PullOnFlaw, ReleasesWhatASlitDoes) {
  constexpr double kStrain = 1e-3, kFlaw = 4e-3;
  const auto [sheet, state] = stretched(kStrain);
  const MeshNeighbours neighbours(state.mesh);
  const double tension = sheet.material.young_modulus * kStrain;
  const double slit = std::numbers::pi * kFlaw * tension * tension / sheet.material.young_modulus;
  const auto pull = [&](const Vector2d& p) {
    return pull_on_flaw(sheet, state, neighbours, vertex_at(state.mesh, p), kFlaw);
  };
  const auto border = pull({0, -0.1});
  ASSERT_TRUE(border.has_value());
  EXPECT_NEAR(border->away().y(), 1, 1e-9) << "into the sheet";
  EXPECT_NEAR(border->released({0, 1}, sheet.material.thickness), 1.12 * 1.12 * slit, 0.01 * slit);
  EXPECT_NEAR(border->force, tension * sheet.material.thickness * kFlaw, 0.01 * border->force);
  EXPECT_NEAR(border->angle, std::numbers::pi, 1e-12);
  EXPECT_GT(border->right.x(), 0) << "each side is pulled away";
  const auto inside = pull({0, 0});
  ASSERT_TRUE(inside.has_value());
  EXPECT_NEAR(inside->released(inside->away(), sheet.material.thickness), slit, 0.01 * slit);
}

TEST(PullOnFlaw, IsAbsentWithoutTension) {
  const Sheet sheet = sheets::free_sheet(0.2, 0.2);
  ShellState state = sheets::at_rest(sheet, 400);
  state.x *= 0.999;
  const MeshNeighbours neighbours(state.mesh);
  EXPECT_FALSE(pull_on_flaw(sheet, state, neighbours, vertex_at(state.mesh, {0, 0}), 4e-3));
}

/// A long strip, cut along its middle from one end to the centre, whose long sides are drawn apart:
/// far ahead of the tip it has the density W of energy, far behind none, so that a tear releases W
/// times the strip's height (Rivlin and Thomas 1953).
class CutStrip : public testing::TestWithParam<double> {
 protected:
  static constexpr double kLength = 0.6, kHeight = 0.1, kStrain = 2e-3;
  CutStrip() {
    sheet_ = sheets::free_sheet(kLength, kHeight);
    sheet_.pattern.cuts = {{{-kLength / 2, 0}, {0, 0}}};
    for (const double side : {-1.0, 1.0}) {
      Handle edge;
      edge.name = side < 0 ? "lower" : "upper";
      const double v = side * kHeight / 2;
      edge.segment = {{-kLength / 2, v}, {kLength / 2, v}};
      Keyframe drawn;
      drawn.shift = Vector3d(0, side * kStrain * kHeight / 2, 0);
      edge.motion = Trajectory{{drawn}};
      sheet_.handles.push_back(edge);
    }
    state_ = sheets::at_rest(sheet_, 6000, UniformLayout::equilateral);
  }

  Sheet sheet_;
  ShellState state_;
};

TEST_P(CutStrip, ReleasesTheEnergyAheadOfTheTip) {
  ShellStepper stepper(sheet_, {}, 1);
  stepper.set_mesh(state_);
  for (int i = 0; i < 10; ++i) stepper.relax(state_, 1e-2);
  const MeshNeighbours neighbours(state_.mesh);
  PullOptions options;
  options.reach = GetParam();
  const auto pull =
      pull_at(sheet_, stepper, state_, neighbours, vertex_at(state_.mesh, {0, 0}), options);
  ASSERT_TRUE(pull.has_value());
  const double strain = kStrain + kStrain * kStrain / 2;
  const double density = sheet_.material.membrane_stiffness() * strain * strain / 2;  // J/m^2
  EXPECT_NEAR(pull->release.x(), density * kHeight, 0.03 * density * kHeight);
  EXPECT_NEAR(pull->release.y(), 0, 0.01 * density * kHeight);
}

/// Whatever the piece's outline.
INSTANTIATE_TEST_SUITE_P(Reach, CutStrip, testing::Values(0.015, 0.03, 0.045));

}  // namespace
}  // namespace geoprior::paper
