// Random pulls: whatever hands do to a sheet that tears, the hybrid model keeps what it promises.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/planar.h"
#include "core/random.h"
#include "models/paper/contact/segments.h"
#include "models/paper/tear/lips.h"
#include "solvers/paper/sheet/invariants.h"
#include "tests/paper/sheet/hybrid_fixture.h"
#include "tests/support/long_tests.h"

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

/// Cells of the pattern, with walls where a cut passes between the middles of two.
class Cells {
 public:
  explicit Cells(const Pattern& pattern) : right_(kCount, false), up_(kCount, false) {
    for (const std::vector<Vector2d>& cut : pattern.cuts) {
      for (std::size_t k = 0; k + 1 < cut.size(); ++k) build_wall(cut[k], cut[k + 1]);
    }
  }
  /// Of those that hang together, the areas (m^2).
  [[nodiscard]] std::vector<double> areas() const {
    std::vector<double> areas;
    std::vector<bool> seen(kCount, false);
    for (int first = 0; first < kCount; ++first) {
      if (seen[first]) continue;
      std::vector<int> filled{first};
      seen[first] = true;
      for (std::size_t k = 0; k < filled.size(); ++k) {
        const int i = filled[k], column = i % kColumns;
        const auto visit = [&](int j, bool wall) {
          if (wall || seen[j]) return;
          seen[j] = true;
          filled.push_back(j);
        };
        if (column > 0) visit(i - 1, right_[i - 1]);
        if (column + 1 < kColumns) visit(i + 1, right_[i]);
        if (i >= kColumns) visit(i - kColumns, up_[i - kColumns]);
        if (i + kColumns < kCount) visit(i + kColumns, up_[i]);
      }
      areas.push_back(static_cast<double>(filled.size()) * kSize * kSize);
    }
    return areas;
  }

 private:
  static constexpr double kSize =
      5e-4;  // m: half of what a tear leaves between itself and a border
  static constexpr int kColumns = 420, kRows = 594, kCount = kColumns * kRows;

  static Vector2d middle(int column, int row) {
    return {-0.105 + (column + 0.5) * kSize, -0.1485 + (row + 0.5) * kSize};
  }
  void build_wall(const Vector2d& a, const Vector2d& b) {
    const Vector2d low = (a.cwiseMin(b) - middle(0, 0)) / kSize;
    const Vector2d high = (a.cwiseMax(b) - middle(0, 0)) / kSize;
    const auto within = [](double x, int count) {
      return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1);
    };
    for (int row = within(low.y() - 1, kRows); row <= within(high.y() + 1, kRows); ++row) {
      for (int column = within(low.x() - 1, kColumns); column <= within(high.x() + 1, kColumns);
           ++column) {
        const int i = row * kColumns + column;
        const Vector2d p = middle(column, row);
        right_[i] = right_[i] || segments_meet(p, middle(column + 1, row), a, b);
        up_[i] = up_[i] || segments_meet(p, middle(column, row + 1), a, b);
      }
    }
  }

  std::vector<bool> right_, up_;
};

constexpr double kLeastPart = 2e-4;  // m^2: smaller parts are no matter
constexpr double kUnsure = 1.2;      // cells do not see to the last how large one is

int count_above(const std::vector<double>& areas, double least) {
  return static_cast<int>(std::ranges::count_if(areas, [&](double a) { return a > least; }));
}

class LongRandomPulls : public testing::TestWithParam<int> {};

TEST_P(LongRandomPulls, LeaveASheetThatIsWholeInEveryPart) {
  const int frames = test::at_length() ? 500 : 38;
  const std::uint64_t seed = GetParam();
  const Sheet sheet = pulled_about(seed, frames);
  int frame = 0, strained = 0;
  double length = 0;
  int most_parts = 1;
  const double start = Tears(sheet.pattern, 1e-4).length();
  run_hybrid(sheet, {}, seed, [&](const HybridMesher& mesher, const ShellState& state) {
    ++frame;
    ASSERT_TRUE(state.x.allFinite() && state.v.allFinite()) << "frame " << frame;
    const Tears* tears = mesher.tears();
    ASSERT_TRUE(tears != nullptr);
    ASSERT_THAT(broken_invariants(mesher.structure(), tears->torn(), state.mesh),
                testing::IsEmpty())
        << "frame " << frame;
    EXPECT_GE(tears->length(), length) << "tears do not heal";
    if (tears->length() > length || frame == frames) {
      const int parts = count_above(Cells(tears->torn()).areas(), kLeastPart);
      EXPECT_LE(count_above(part_areas(state.mesh), kUnsure * kLeastPart), parts) << frame;
      EXPECT_GE(count_above(part_areas(state.mesh), kLeastPart / kUnsure), parts) << frame;
      most_parts = std::max(most_parts, parts);
    }
    length = tears->length();
    const Isometry strain = isometry(state);
    if (strain.rms > 1e-3) ++strained;
  });
  EXPECT_EQ(frame, frames);
  // Hands that pull where no candidate lies stretch the sheet as far as they give.
  EXPECT_LE(strained, frames / 20);
  EXPECT_GT(length, start) << "nothing tore";
  RecordProperty("length_mm", static_cast<int>(1e3 * length));
  RecordProperty("parts", most_parts);
  RecordProperty("strained", strained);
}

/// One seed for 38 frames, in which its tears grow; with GEOPRIOR_LONG, twenty for 500.
INSTANTIATE_TEST_SUITE_P(Seeds, LongRandomPulls,
                         test::at_length() ? testing::Range(1, 21) : testing::Range(2, 3));

}  // namespace
}  // namespace geoprior::paper
