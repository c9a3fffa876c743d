// Random pulls: whatever hands do to a sheet that tears, the hybrid model keeps what it promises.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "core/planar.h"
#include "core/random.h"
#include "models/paper/lips.h"
#include "models/paper/segments.h"
#include "solvers/paper/invariants.h"
#include "tests/paper/hybrid_fixture.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// A sheet with a cut, and four hands on its border that give and wander.
Sheet pulled_about(std::uint64_t seed, int frames) {
  Sheet sheet;
  sheet.pattern = rectangle_pattern(0.21, 0.297);
  sheet.material.damping = 1e-3;
  sheet.handle_step = 5e-4;
  sheet.toughness.energy = 1e4;
  sheet.toughness.noise = 0.5;
  sheet.toughness.seed = seed;
  sheet.duration = frames * sheet.frame_interval;
  RandomStream random(seed, "random pulls");
  const double u = 0.15 * (random.uniform() - 0.5), depth = 0.03 + 0.05 * random.uniform();
  sheet.pattern.cuts = {{{u, -0.1485}, {u, -0.1485 + depth}}};
  const std::vector<Vector2d> held{{u - 0.025, -0.1485},
                                   {u + 0.025, -0.1485},
                                   {0.105, 0.2 * (random.uniform() - 0.5)},
                                   {-0.06, 0.1485}};
  for (std::size_t i = 0; i < held.size(); ++i) {
    Keys keys{{0, {0, 0, 0}}};
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (int second = 2; second <= static_cast<int>(sheet.duration) + 2; second += 2) {
      const double x = random.uniform(), y = random.uniform(), z = random.uniform();
      at = 0.8 * at + 0.2 * Eigen::Vector3d(x - 0.5, y - 0.5, z - 0.5);
      keys.emplace_back(second, at);
    }
    sheet.handles.push_back(point_handle("hand " + std::to_string(i), held[i], keys));
    sheet.handles.back().stiffness = 300;
  }
  return sheet;
}

constexpr double kGrid = 2e-3;       // m
constexpr double kLeastPart = 2e-4;  // m^2: smaller parts are no matter for a grid

/// Parts of a pattern by filling a grid, without any mesh.
int parts_of(const Pattern& pattern) {
  const int columns = 105, rows = 148;
  const auto place = [&](int i) {
    return Vector2d(-0.105 + (i % columns + 0.5) * kGrid, -0.1485 + (i / columns + 0.5) * kGrid);
  };
  const auto divided = [&](const Vector2d& p, const Vector2d& q) {
    for (const std::vector<Vector2d>& cut : pattern.cuts) {
      for (std::size_t k = 0; k + 1 < cut.size(); ++k) {
        if (segments_meet(p, q, cut[k], cut[k + 1])) return true;
      }
    }
    return false;
  };
  std::vector<bool> seen(static_cast<std::size_t>(columns) * rows, false);
  int count = 0;
  for (int first = 0; first < columns * rows; ++first) {
    if (seen[first]) continue;
    std::vector<int> filled{first};
    seen[first] = true;
    for (std::size_t k = 0; k < filled.size(); ++k) {
      const int i = filled[k], column = i % columns, row = i / columns;
      const auto visit = [&](int j) {
        if (seen[j] || divided(place(i), place(j))) return;
        seen[j] = true;
        filled.push_back(j);
      };
      if (column > 0) visit(i - 1);
      if (column + 1 < columns) visit(i + 1);
      if (row > 0) visit(i - columns);
      if (row + 1 < rows) visit(i + columns);
    }
    if (static_cast<double>(filled.size()) * kGrid * kGrid > kLeastPart) ++count;
  }
  return count;
}

/// Parts of a mesh that are as large.
int parts_of(const ShellMesh& mesh) {
  const std::vector<double> areas = part_areas(mesh);
  return static_cast<int>(
      std::count_if(areas.begin(), areas.end(), [](double a) { return a > kLeastPart; }));
}

class RandomPulls : public testing::TestWithParam<int> {};

TEST_P(RandomPulls, LeaveASheetThatIsWholeInEveryPart) {
  constexpr int kFrames = 500;
  const auto seed = static_cast<std::uint64_t>(GetParam());
  const Sheet sheet = pulled_about(seed, kFrames);
  int frame = 0, strained = 0;
  double length = 0;
  int most_parts = 1;
  run_hybrid(sheet, {}, seed, [&](const HybridMesher& mesher, const ShellState& state) {
    ++frame;
    ASSERT_TRUE(state.x.allFinite() && state.v.allFinite()) << "frame " << frame;
    const Tears* tears = mesher.tears();
    ASSERT_TRUE(tears != nullptr);
    ASSERT_THAT(broken_invariants(mesher.structure(), tears->torn(), state.mesh),
                testing::IsEmpty())
        << "frame " << frame;
    EXPECT_GE(tears->length(), length) << "tears do not heal";
    if (tears->length() > length || frame == kFrames) {
      EXPECT_EQ(parts_of(state.mesh), parts_of(tears->torn())) << "frame " << frame;
      most_parts = std::max(most_parts, parts_of(state.mesh));
    }
    length = tears->length();
    const Isometry strain = isometry(state);
    if (strain.rms > 1e-3) ++strained;
  });
  EXPECT_EQ(frame, kFrames);
  // Hands that pull where no candidate lies stretch the sheet as far as they give.
  EXPECT_LE(strained, kFrames / 20);
  RecordProperty("length_mm", static_cast<int>(1e3 * length));
  RecordProperty("parts", most_parts);
  RecordProperty("strained", strained);
}

/// GEOPRIOR_LONG asks for twenty seeds.
int last_seed() { return std::getenv("GEOPRIOR_LONG") == nullptr ? 2 : 20; }

INSTANTIATE_TEST_SUITE_P(Seeds, RandomPulls, testing::Range(1, last_seed() + 1));

}  // namespace
}  // namespace geoprior::paper
