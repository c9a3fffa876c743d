#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/paper/meshing/uniform_mesh.h"
#include "models/sound/events/detector.h"
#include "tests/paper/meshes.h"
#include "tests/sound/all_events.h"

namespace geoprior::sound {
namespace {

constexpr double kSquareSide = 0.2, kFrameStep = 0.01;

Sheet a_square() {
  Sheet sheet;
  sheet.pattern = paper::rectangle_pattern(kSquareSide, kSquareSide);
  return sheet;
}

/// A grid about the origin whose cells right of the middle have the other diagonals, or not.
ShellMesh half_turned(bool turned) {
  constexpr int kCells = 20;
  ShellMesh mesh = paper::meshes::grid(kCells, kCells, kSquareSide, kSquareSide, false);
  for (int j = 0; j < kCells; ++j) {
    for (int i = kCells / 2; turned && i < kCells; ++i) {
      const int a = j * (kCells + 1) + i, b = a + 1, d = a + kCells + 1, c = d + 1;
      mesh.triangles.row(2 * (j * kCells + i)) << a, b, d;
      mesh.triangles.row(2 * (j * kCells + i) + 1) << b, c, d;
    }
  }
  mesh.pattern.array() -= kSquareSide / 2;
  return mesh;
}

/// Bumps 30 mm apart, which meshes of a few hundred triangles see as they please.
SheetSnapshot bumps(const ShellMesh& mesh, double time) {
  constexpr double kBumpHeight = 2e-3, kWave = 2 * std::numbers::pi / 0.03;
  SheetSnapshot frame{time, mesh, {}, {}, {}};
  frame.x.resize(mesh.vertex_count(), 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double a = mesh.pattern(v, 0), b = mesh.pattern(v, 1);
    frame.x.row(v) << a, b, kBumpHeight * std::sin(kWave * a) * std::sin(kWave * b);
  }
  return frame;
}

SheetSnapshot rolled(const ShellMesh& mesh, double time, double curvature) {
  return {time, mesh, paper::meshes::rolled(mesh.pattern, curvature, 0), {}, {}};
}

std::vector<SoundEvent> heard(const std::vector<SheetSnapshot>& frames, bool remeshing) {
  DetectionOptions options;
  options.flips.remeshing = remeshing;
  return all_events(a_square(), options, frames);
}

std::vector<ShellMesh> two_meshes() {
  const Sheet sheet = a_square();
  std::vector<ShellMesh> meshes;
  for (const int seed : {1, 2}) {
    meshes.push_back(
        paper::uniform_mesh(sheet.pattern, 400, paper::UniformLayout::delaunay, {}, seed));
  }
  return meshes;
}

/// The curvature of a sheet that snaps, 20 to -20 1/m from one frame to the next, in a frame that
/// changes the mesh, too.
double snapping_curvature(int frame) { return frame < 15 ? 20 : -20; }

TEST(SoundRemeshing, AShapeThatStaysIsSilentWhateverItsMesh) {
  const std::vector<ShellMesh> meshes = two_meshes();
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i < 30; ++i) frames.push_back(bumps(meshes[i / 5 % 2], i * kFrameStep));
  EXPECT_TRUE(heard(frames, false).empty());
  // The null: five changes of the mesh are taken for snaps.
  const auto taken = heard(frames, true);
  EXPECT_GT(taken.size(), 5u);
  double energy = 0;
  for (const SoundEvent& e : taken) energy += e.energy;
  EXPECT_GT(energy, 2e-5);
}

TEST(SoundRemeshing, ASnapIsHeardWhereTheMeshStays) {
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i < 30; ++i) {
    frames.push_back(rolled(half_turned(i >= 15), i * kFrameStep, snapping_curvature(i)));
  }
  const auto half = heard(frames, false), whole = heard(frames, true);
  ASSERT_EQ(half.size(), 1u);
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_NEAR(whole.front().flipped_area, kSquareSide * kSquareSide,
              0.05 * kSquareSide * kSquareSide);
  // Cells beside the middle are smoothed with some beyond it, read from triangles beyond it.
  EXPECT_LT(half.front().flipped_area, kSquareSide * kSquareSide / 2);
  EXPECT_GT(half.front().flipped_area, 0.3 * kSquareSide * kSquareSide);
  const SoundGrid grid = sound_grid(a_square().pattern, DetectionOptions{}.spacing);
  for (const FlippedCell& flip : half.front().flips) EXPECT_LT(grid.centre(flip.cell).x(), 0);
}

TEST(SoundRemeshing, ASnapIsHeardAllOverInTheFrameAfterTheMeshHasChanged) {
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i < 30; ++i) {
    frames.push_back(rolled(half_turned(i >= 14), i * kFrameStep, snapping_curvature(i)));
  }
  const auto events = heard(frames, false);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_NEAR(events.front().flipped_area, kSquareSide * kSquareSide,
              0.05 * kSquareSide * kSquareSide);
}

// What it costs: silence here is no merit, and `remeshed` says so.
TEST(SoundRemeshing, AMeshThatChangesEverywhereInEveryFrameIsNotListenedTo) {
  const std::vector<ShellMesh> meshes = two_meshes();
  std::vector<SheetSnapshot> frames;
  for (int i = 0; i < 30; ++i) {
    frames.push_back(rolled(meshes[i % 2], i * kFrameStep, snapping_curvature(i)));
  }
  EXPECT_TRUE(heard(frames, false).empty());
  EXPECT_FALSE(heard(frames, true).empty());
  SheetSampler sampler(sound_grid(a_square().pattern, 3.3e-3), 4e-3);
  const auto changed = [&](int i) {
    const SheetField field = sampler.sample(frames[i]);
    return std::count(field.remeshed.begin(), field.remeshed.end(), 1);
  };
  EXPECT_EQ(changed(0), 0) << "nothing comes before the first frame";
  EXPECT_EQ(changed(1), sampler.grid().count());
  EXPECT_EQ(changed(3), 0) << "the same mesh";
}

// Beside the border the fit takes the farther edges that it needs in the order of their numbers.
TEST(SoundRemeshing, OtherNumbersOfVerticesAndTrianglesAreNoOtherMeshAwayFromTheBorder) {
  const ShellMesh mesh = two_meshes().front();
  ShellMesh other = mesh;
  const int n = mesh.vertex_count();
  other.pattern = mesh.pattern.colwise().reverse().eval();
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::RowVector3i f = mesh.triangles.row(mesh.triangle_count() - 1 - t);
    other.triangles.row(t) << n - 1 - f[1], n - 1 - f[2], n - 1 - f[0];
  }
  SheetSampler sampler(sound_grid(a_square().pattern, 3.3e-3), 4e-3);
  sampler.sample(rolled(mesh, 0, 20));
  const SheetField field = sampler.sample(rolled(other, kFrameStep, 20));
  for (int c = 0; c < sampler.grid().count(); ++c) {
    if (sampler.grid().centre(c).cwiseAbs().maxCoeff() > 0.05) continue;
    EXPECT_EQ(field.remeshed[c], 0) << c;
  }
}

}  // namespace
}  // namespace geoprior::sound
