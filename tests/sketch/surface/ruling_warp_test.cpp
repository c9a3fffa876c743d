#include "solvers/sketch/surface/ruling_warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "experiments/sketch/truth/synthetic_views.h"
#include "solvers/sketch/surface/ruled_patches.h"

namespace geoprior::sketch {
namespace {

/// Half a circle about the origin, from azimuth 0, as the border of a flat ring.
BorderRun half_circle(double radius, int count, double stretch) {
  BorderRun run;
  for (int i = 0; i < count; ++i) {
    const double s = static_cast<double>(i) / (count - 1);
    const double t = std::numbers::pi * (s + stretch * s * (1 - s));
    run.points.emplace_back(radius * std::cos(t), radius * std::sin(t));
    run.tangents.emplace_back(-std::sin(t), std::cos(t));
  }
  return run;
}

/// Azimuth of the place that a node of the first run is joined to.
double azimuth_at(const BorderRun& run, double at) {
  const int i = std::min(static_cast<int>(at), static_cast<int>(run.points.size()) - 2);
  const Eigen::Vector2d p = (i + 1 - at) * run.points[i] + (at - i) * run.points[i + 1];
  return std::atan2(p.y(), p.x());
}

// Concentric circles are joined along radii, however differently their nodes are spread.
TEST(RulingWarp, JoinsConcentricCirclesAlongRadii) {
  const BorderRun inner = half_circle(1, 60, 0.0), outer = half_circle(2, 45, 0.4);
  const RulingPath path = warp_rulings(inner, outer, WarpEnd::both_end, {});
  ASSERT_EQ(path.image.size(), inner.points.size());
  for (std::size_t i = 0; i < path.image.size(); ++i) {
    const double azimuth = std::numbers::pi * static_cast<double>(i) / 59;
    EXPECT_NEAR(azimuth_at(outer, path.image[i]), azimuth, 0.5 * kDegree) << "node " << i;
  }
}

TEST(RulingWarp, PathIsMonotoneInStepsOfAtMostOne) {
  const BorderRun inner = half_circle(1, 60, 0.0), outer = half_circle(2, 45, 0.4);
  const RulingPath path = warp_rulings(inner, outer, WarpEnd::both_end, {});
  EXPECT_EQ(path.cells.front(), (std::array<int, 2>{0, 0}));
  EXPECT_EQ(path.cells.back(), (std::array<int, 2>{59, 44}));
  for (std::size_t k = 1; k < path.cells.size(); ++k) {
    const int di = path.cells[k][0] - path.cells[k - 1][0];
    const int dj = path.cells[k][1] - path.cells[k - 1][1];
    EXPECT_TRUE(di >= 0 && di <= 1 && dj >= 0 && dj <= 1 && di + dj >= 1);
  }
  EXPECT_TRUE(std::is_sorted(path.image.begin(), path.image.end()));
}

// The first run is a quarter of a circle, the second a half: rulings go half way along the second.
TEST(RulingWarp, OpenRunEndsWhereTheOtherIsUsedUp) {
  BorderRun quarter = half_circle(1, 61, 0.0);
  quarter.points.resize(31);
  quarter.tangents.resize(31);
  const BorderRun outer = half_circle(2, 61, 0.0);
  const RulingPath path = warp_rulings(quarter, outer, WarpEnd::second_open, {});
  EXPECT_NEAR(path.image.back(), 30, 1);
  const RulingPath other = warp_rulings(outer, quarter, WarpEnd::first_open, {});
  EXPECT_NEAR(static_cast<double>(other.image.size()), 31, 1);
}

// Along parallel lines every tangent agrees, and collinearity alone decides: rulings stay parallel.
TEST(RulingWarp, JoinsParallelLinesByParallelRulings) {
  BorderRun low, high;
  for (int i = 0; i < 20; ++i) {
    low.points.emplace_back(i, 0);
    high.points.emplace_back(i, 5);
    low.tangents.emplace_back(1, 0);
    high.tangents.emplace_back(1, 0);
  }
  const RulingPath path = warp_rulings(low, high, WarpEnd::both_end, {});
  for (std::size_t i = 0; i < path.image.size(); ++i)
    EXPECT_NEAR(path.image[i], static_cast<double>(i), 1e-9);
}

/// Angles between the rulings found and the lines to the apex of the cone (rad), but for held ones.
std::vector<double> ruling_errors(const SyntheticView& drawing, int half_width) {
  const CurveNet net = build_curve_net(drawing.view, {});
  const std::vector<RuledPatch> patches = sweep_ruled_patches(drawing.view, net, half_width, {});
  std::vector<double> errors;
  for (const RuledPatch& patch : patches) {
    for (const SketchRuling& ruling : patch.rulings) {
      if (ruling.held) continue;
      const Eigen::Vector2d p =
          evaluate(net, position_form(net, {patch.first, static_cast<double>(ruling.node)}));
      const Eigen::Vector2d q = evaluate(net, position_form(net, {patch.second, ruling.at}));
      errors.push_back(std::abs(signed_angle(q - p, drawing.apex.head<2>() - p)));
    }
  }
  return errors;
}

// The true rulings of a cone pass through its apex. Tangents fitted over wider windows turn towards
// chords where the ellipses are most curved, which costs accuracy and buys calm under noise.
TEST(RulingWarp, FindsTheRulingsOfAFrustum) {
  const SyntheticView drawing = synthetic_view({});
  const std::vector<double> narrow = ruling_errors(drawing, 2);
  ASSERT_GT(narrow.size(), 90u);
  EXPECT_LT(*std::max_element(narrow.begin(), narrow.end()), 0.5 * kDegree);
  const std::vector<double> wide = ruling_errors(drawing, 4);
  EXPECT_LT(*std::max_element(wide.begin(), wide.end()), 0.75 * kDegree);
}

TEST(RulingWarp, PatchGoesOnceAroundTwoClosedBorders) {
  const SyntheticView drawing = synthetic_view({});
  const CurveNet net = build_curve_net(drawing.view, {});
  const std::vector<RuledPatch> patches = sweep_ruled_patches(drawing.view, net, 4, {});
  ASSERT_EQ(patches.size(), 1u) << "two silhouettes of one patch";
  const RuledPatch& patch = patches.front();
  EXPECT_TRUE(patch.around);
  EXPECT_EQ(patch.cells.back()[0] - patch.cells.front()[0], net.curves[patch.first].size());
  EXPECT_EQ(std::abs(patch.cells.back()[1] - patch.cells.front()[1]),
            net.curves[patch.second].size());
}

}  // namespace
}  // namespace geoprior::sketch
