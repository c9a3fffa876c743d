// Sheets that are cut open: lips, what is carried to them, and tears that grow.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "baselines/paper/adaptive/adaptive.h"
#include "baselines/paper/adaptive/recut.h"
#include "baselines/paper/dense.h"
#include "core/error.h"
#include "models/paper/contact/segments.h"
#include "models/paper/meshing/transfer.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "models/paper/sheet/pattern_locator.h"
#include "models/paper/sheet/valid.h"
#include "models/paper/tear/growth.h"
#include "models/paper/tear/lips.h"
#include "models/paper/tear/tears.h"
#include "solvers/paper/hybrid.h"
#include "tests/paper/sheets.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using test::Recording;

using Eigen::Vector2d;
using Eigen::Vector3d;

/// A sheet of 0.2 m by 0.2 m with a cut from its lower side upwards.
Pattern cut_square(double length) {
  Pattern pattern = rectangle_pattern(0.2, 0.2);
  pattern.cuts = {{{0.013, -0.1}, {0.013, -0.1 + length}}};
  return pattern;
}

ShellMesh square_mesh(double length) {
  return lattice_mesh(cut_square(length), 0.02, UniformLayout::equilateral, {}, 1);
}

/// Rest, the lips drawn apart: what lies to the right of the cut is lifted.
ShellState parted(const ShellMesh& mesh, const Pattern& pattern) {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  sheet.pattern = pattern;
  ShellState state = resting_state(sheet, mesh, 1);
  const double tip = pattern.cuts[0].back().y();
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const double u =
        (mesh.pattern(mesh.triangles(f, 0), 0) + mesh.pattern(mesh.triangles(f, 1), 0) +
         mesh.pattern(mesh.triangles(f, 2), 0)) /
        3;
    if (u < pattern.cuts[0][0].x()) continue;
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles(f, k);
      if (mesh.pattern(v, 1) < tip - 1e-9) state.x(v, 2) = tip - mesh.pattern(v, 1);
    }
  }
  return state;
}

TEST(Lips, MeshIsOpenAlongItsCuts) {
  const ShellMesh whole =
      lattice_mesh(rectangle_pattern(0.2, 0.2), 0.02, UniformLayout::equilateral, {}, 1);
  EXPECT_FALSE(has_lips(whole));
  const ShellMesh open = square_mesh(0.1);
  EXPECT_TRUE(has_lips(open));
  EXPECT_EQ(part_count(open.triangles), 1);
  EXPECT_NEAR(sheets::area(open), 0.04, 1e-12);
  // Every vertex of the lips twice, the tip once.
  int lips = 0, tips = 0;
  for (int v = 0; v < open.vertex_count(); ++v) {
    if (std::abs(open.pattern(v, 0) - 0.013) > 1e-12 || open.pattern(v, 1) > 1e-12) continue;
    (open.pattern(v, 1) > -1e-12 ? tips : lips) += 1;
  }
  EXPECT_EQ(tips, 1);
  EXPECT_EQ(lips % 2, 0);
  EXPECT_GE(lips, 8);
}

TEST(Lips, ASheetCutAcrossHasTwoParts) {
  const ShellMesh mesh = square_mesh(0.2);
  EXPECT_EQ(part_count(mesh.triangles), 2);
  EXPECT_NEAR(sheets::area(mesh), 0.04, 1e-12);
}

TEST(Lips, PlacesAreFoundOnTheSideOneComesFrom) {
  const ShellMesh mesh = square_mesh(0.1);
  const PatternLocator locator(mesh);
  const Vector2d p(0.013, -0.05);
  for (const double side : {-1.0, 1.0}) {
    const auto at = locator.locate(p, p + Vector2d(side * 0.01, 0.003));
    double u = 0;
    for (int k = 0; k < 3; ++k) u += mesh.pattern(mesh.triangles(at.triangle, k), 0) / 3;
    EXPECT_GT(side * (u - p.x()), 0);
  }
}

TEST(Lips, StateKeepsToItsSideWhenTheCutGrows) {
  const Pattern before = cut_square(0.1), after = cut_square(0.13);
  const ShellState state = parted(square_mesh(0.1), before);
  const ShellState carried = transfer_state(state, square_mesh(0.13));
  double least = 1, most = 0;
  for (int f = 0; f < carried.mesh.triangle_count(); ++f) {
    Vector2d middle = Vector2d::Zero();
    for (int k = 0; k < 3; ++k)
      middle += carried.mesh.pattern.row(carried.mesh.triangles(f, k)).transpose() / 3;
    if (middle.y() > -0.03 || std::abs(middle.x() - 0.013) > 0.02) continue;
    for (int k = 0; k < 3; ++k) {
      const int v = carried.mesh.triangles(f, k);
      if (std::abs(carried.mesh.pattern(v, 0) - 0.013) > 1e-9) continue;
      const double lifted = carried.x(v, 2) / std::max(1e-9, 0.0 - carried.mesh.pattern(v, 1));
      if (middle.x() > 0.013) least = std::min(least, lifted);
      if (middle.x() < 0.013) most = std::max(most, std::abs(lifted));
    }
  }
  EXPECT_GT(least, 0.5);  // the lifted lip is lifted
  EXPECT_LT(most, 1e-9);  // the other is not
}

TEST(Lips, RecutKeepsVerticesAndOpensTheRest) {
  const ShellMesh mesh = square_mesh(0.1);
  const ShellMesh longer = recut(mesh, cut_square(0.14), {}, 2e-3);
  EXPECT_NEAR(sheets::area(longer), 0.04, 1e-12);
  EXPECT_EQ(part_count(longer.triangles), 1);
  EXPECT_EQ(part_count(recut(mesh, cut_square(0.2), {}, 2e-3).triangles), 2);
}

TEST(Pattern, RefusesCutsThatAreNone) {
  const auto refuse = [](std::vector<std::vector<Vector2d>> cuts, const char* what) {
    Pattern pattern = rectangle_pattern(0.2, 0.2);
    pattern.cuts = std::move(cuts);
    EXPECT_THAT([&] { require_simple(pattern, "pattern"); },
                testing::ThrowsMessage<Error>(testing::HasSubstr(what)));
  };
  refuse({{{0, 0}}}, "fewer than two");
  refuse({{{0, 0}, {0, std::numeric_limits<double>::quiet_NaN()}}}, "not finite");
  refuse({{{0, 0}, {0, 0.2}}}, "leaves the pattern");
  refuse({{{0, 0}, {0, 0}}}, "stands still");
  refuse({{{0, 0}, {0.05, 0}, {0.05, 0.05}, {0.02, -0.05}}}, "crosses itself");
  refuse({{{0, -0.1}, {0, 0}}, {{-0.05, -0.05}, {0.05, -0.05}}}, "crosses");
  refuse({{{0.1 - 1e-8, 0}, {0, 0}}}, "too near");
  Pattern good = rectangle_pattern(0.2, 0.2);
  good.cuts = {{{0, -0.1}, {0, 0}}, {{0, -0.05}, {0.05, -0.05}}};
  EXPECT_NO_THROW(require_simple(good, "pattern"));
  // An older tear ends on a younger one.
  std::swap(good.cuts[0], good.cuts[1]);
  EXPECT_NO_THROW(require_simple(good, "pattern"));
}

/// The younger tear goes on within its tolerance of 0.1 mm; the edge on which the older one ends
/// stays where it is, or they would cross by 0.03 mm.
TEST(Tears, KeepTheEdgeOnWhichAnotherEnds) {
  Tears tears(rectangle_pattern(0.2, 0.2), 1e-4);
  const int older = tears.start({0, -0.1}, 0);
  tears.advance(older, {0, -2e-3}, 0);
  const int younger = tears.start({-0.1, 0}, 0);
  tears.advance(younger, {2e-3, 0}, 0);
  tears.advance(older, {0, 0}, 0);
  tears.end(older);
  tears.advance(younger, {4e-3, -3e-5}, 0);
  EXPECT_NO_THROW(require_simple(tears.torn(), "pattern"));
  EXPECT_LE(distance_to_segment({0, 0}, tears.torn().cuts[1][0], tears.torn().cuts[1][1]), 1e-12);
  tears.advance(younger, {6e-3, -6e-5}, 0);
  EXPECT_EQ(tears.torn().cuts[1].size(), 3U);
  const ShellMesh mesh = lattice_mesh(tears.torn(), 0.02, UniformLayout::equilateral, {}, 1);
  EXPECT_EQ(part_count(mesh.triangles), 2) << "a quarter falls off";
}

/// The same where the sheet begins with both as cuts: the one goes on along a curve.
TEST(Tears, KeepTheEdgeOnWhichACutEnds) {
  Pattern pattern = rectangle_pattern(0.4, 0.4);
  pattern.cuts = {{{0, -0.2}, {0, -0.12}}, {{0, -0.15}, {0.2, -0.15}}};
  for (const double side : {-1.0, 1.0}) {
    Tears tears(pattern, 1e-3);
    for (double s = 2e-3; s <= 24e-3; s += 2e-3)
      tears.advance(0, {side * 0.15 * s * s, -0.12 + s}, 0);
    EXPECT_NO_THROW(require_simple(tears.torn(), "pattern"));
    const ShellMesh mesh = lattice_mesh(tears.torn(), 0.02, UniformLayout::equilateral, {}, 1);
    EXPECT_EQ(part_count(mesh.triangles), 2) << "a corner falls off";
  }
}

TEST(Toughness, IsSeededAndKnowsTheGrain) {
  Toughness t;
  t.energy = 1e4;
  EXPECT_EQ(t.at({0.01, 0.02}, {1, 0}), 1e4);
  t.noise = 0.5;
  double least = 1, most = 0;
  for (int i = 0; i < 2000; ++i) {
    const double here = t.texture({i * 1e-3, i * 0.7e-3});
    least = std::min(least, here);
    most = std::max(most, here);
  }
  EXPECT_GE(least, 0.5);
  EXPECT_LE(most, 1);
  EXPECT_GT(most - least, 0.3);
  Toughness other = t;
  EXPECT_EQ(t.texture({0.03, 0.01}), other.texture({0.03, 0.01}));
  other.seed = 2;
  EXPECT_NE(t.texture({0.03, 0.01}), other.texture({0.03, 0.01}));
  t.noise = 0;
  t.grain_deg = 90;
  t.across = 2;
  EXPECT_NEAR(t.at({0, 0}, {0, 1}), 1e4, 1e-6);
  EXPECT_NEAR(t.at({0, 0}, {1, 0}), 2e4, 1e-6);
  EXPECT_LE(t.least(), 1e4);
}

TEST(Toughness, RefusesWhatIsNone) {
  const auto refuse = [](const Toughness& toughness, const char* key) {
    Sheet sheet = sheets::free_sheet(0.2, 0.2);
    sheet.handles = {sheets::point_handle("hand", {{0, 0}})};
    sheet.toughness = toughness;
    EXPECT_THAT([&] { require_valid(sheet, "scene"); },
                testing::ThrowsMessage<Error>(testing::HasSubstr(key)));
  };
  Toughness t;
  t.energy = -1;
  refuse(t, "toughness.energy");
  t.energy = std::numeric_limits<double>::quiet_NaN();
  refuse(t, "toughness.energy");
  t.energy = 1;
  t.noise = 1;
  refuse(t, "toughness.noise");
  t.noise = std::numeric_limits<double>::quiet_NaN();
  refuse(t, "toughness.noise");
  t.noise = 0;
  t.across = 2;
  refuse(t, "grain");
}

TEST(Tears, CutKeepsToThePathWithFewKnots) {
  Tears tears(rectangle_pattern(0.4, 0.4), 1e-4);
  const int tear = tears.start({0, -0.2}, 0);
  // An arc of radius 0.1 in steps of 1 mm.
  for (int i = 1; i <= 150; ++i) {
    const double angle = i * 0.01;
    tears.advance(tear, {0.1 - 0.1 * std::cos(angle), -0.2 + 0.1 * std::sin(angle)}, i);
  }
  const auto& cut = tears.torn().cuts[0];
  EXPECT_LT(cut.size(), 40U);  // twice the fewest chords
  EXPECT_NEAR(tears.length(), 0.15, 1e-4);
  for (const Vector2d& p : tears.all()[0].path) {
    Pattern line;
    line.cuts = {cut};
    EXPECT_LE(nearest_on_border(line, p).distance, 1e-4 + 1e-12);
  }
}

TEST(Tears, CutKeepsToAPathThatZigzags) {
  Tears tears(rectangle_pattern(0.4, 0.4), 1e-4);
  const int tear = tears.start({0, -0.2}, 0);
  Vector2d p(0, -0.2);
  for (int i = 0; i < 60; ++i) {
    p += 2e-3 * Vector2d(std::sin(1.7 * i), 1).normalized();
    tears.advance(tear, p, i);
  }
  for (const Vector2d& q : tears.all()[0].path) {
    Pattern line;
    line.cuts = {tears.torn().cuts[0]};
    EXPECT_LE(nearest_on_border(line, q).distance, 1e-4 + 1e-12);
  }
}

TEST(Tears, EndWhereSomethingStandsInTheWay) {
  Pattern pattern = rectangle_pattern(0.2, 0.2);
  pattern.cuts = {{{-0.1, 0}, {0.05, 0}}, {{0, -0.1}, {0, -0.05}}};
  Tears tears(pattern, 1e-4);
  EXPECT_FALSE(tears.obstruction(1, {0, -0.03}, 1e-3));
  const auto other = tears.obstruction(1, {0, 0.01}, 1e-3);  // the first tear
  ASSERT_TRUE(other);
  EXPECT_NEAR(other->y(), 0, 1e-12);
  const auto border = tears.obstruction(0, {0.0995, 0}, 1e-3);
  ASSERT_TRUE(border);
  EXPECT_NEAR(border->x(), 0.1, 1e-12);
}

TEST(TearGrowth, RefusesAStepLostInRounding) {
  Sheet sheet = sheets::free_sheet(1, 1);
  sheet.toughness.energy = 1e4;
  TearOptions options;
  options.step = 1e-9;
  EXPECT_THAT([&] { TearGrowth(sheet, options); },
              testing::ThrowsMessage<Error>(testing::HasSubstr("rounding")));
}

DenseOptions few_triangles() {
  DenseOptions options;
  options.triangles = 400;
  return options;
}

double grown(const Frame& frame) { return frame.diagnostics.at("tear_length") - 0.04; }

class TearsOf : public testing::TestWithParam<const char*> {
 protected:
  /// The whole of it, made once a mesh.
  static const Recording& whole(const std::string& mesh) {
    static std::map<std::string, Recording> made;
    const auto [at, is_new] = made.try_emplace(mesh);
    if (is_new) {
      RunContext context(1);
      make(mesh)->run(at->second, context, {});
    }
    return at->second;
  }
  static std::unique_ptr<Process> make(const std::string& mesh) {
    static const Sheet sheet = sheets::pulled_sheet();
    if (mesh == "dense") return make_dense_sheet(sheet, few_triangles());
    if (mesh == "adaptive") return make_adaptive_sheet(sheet, {});
    return make_hybrid_sheet(sheet, {});
  }
};

TEST_P(TearsOf, GrowBetweenTwoHands) {
  const Frame& last = whole(GetParam()).frames.back();
  EXPECT_GT(grown(last), 0.01);
  EXPECT_LT(grown(last), 0.08);
  EXPECT_EQ(last.diagnostics.at("tears"), 1);
  EXPECT_NEAR(last.diagnostics.at("tear_energy"), 1e4 * 1e-4 * grown(last), 1e-9);
  EXPECT_EQ(part_count(last.parts.at("surface").triangles), 1);
  // Straight on, as both hands pull alike.
  const Part& tears = last.parts.at("tears");
  const auto& pattern = tears.require_array("pattern", NamedArray::On::points, 2).values;
  // Few triangles: within 22 degrees.
  EXPECT_LT(pattern.col(0).cwiseAbs().maxCoeff(), 0.4 * grown(last));
  EXPECT_TRUE(last.parts.at("surface").points.allFinite());
}

TEST_P(TearsOf, AreTheSameWhenResumedInTheirMiddle) {
  const Recording& whole = TearsOf::whole(GetParam());
  std::size_t middle = 0;
  while (middle + 1 < whole.frames.size() && grown(whole.frames[middle]) < 0.004) ++middle;
  ASSERT_LT(middle + 2, whole.frames.size());
  Recording rest;
  RunContext again(1);
  make(GetParam())->run(rest, again, whole.checkpoints[middle]);
  ASSERT_EQ(rest.frames.size() + middle + 1, whole.frames.size());
  for (std::size_t i = 0; i < rest.frames.size(); ++i) {
    const Frame &here = rest.frames[i], &there = whole.frames[i + middle + 1];
    EXPECT_EQ(here.parts.at("surface").points, there.parts.at("surface").points);
    EXPECT_EQ(here.diagnostics.at("tear_length"), there.diagnostics.at("tear_length"));
    EXPECT_EQ(here.diagnostics.at("tear_candidates"), there.diagnostics.at("tear_candidates"));
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, TearsOf, testing::Values("dense", "adaptive", "hybrid"),
                         [](const auto& of) { return std::string(of.param); });

TEST(TearGrowth, WithoutPullNothingTears) {
  Sheet sheet = sheets::pulled_sheet();
  for (Handle& handle : sheet.handles) handle.motion->keys.resize(1);
  Recording recording;
  RunContext context(1);
  make_hybrid_sheet(sheet, {})->run(recording, context, {});
  EXPECT_EQ(grown(recording.frames.back()), 0);
}

TEST(TearGrowth, ASheetTornThroughFallsIntoTwoParts) {
  Sheet sheet = sheets::pulled_sheet();
  sheet.pattern.cuts = {{{0, -0.08}, {0, 0.06}}};
  sheet.duration = 1.6;
  sheet.handle_step = 1e-3;
  sheet.substeps = 4;
  for (Handle& handle : sheet.handles) {
    handle.motion->keys[1].time = 1.6;
    handle.motion->keys[1].shift *= 7;
  }
  DenseOptions options = few_triangles();
  options.triangles = 200;
  Recording recording;
  RunContext context(1);
  make_dense_sheet(sheet, options)->run(recording, context, {});
  const Frame& last = recording.frames.back();
  const Part& surface = last.parts.at("surface");
  EXPECT_EQ(part_count(surface.triangles), 2);
  EXPECT_TRUE(surface.points.allFinite());
  // Each hand has its part with it.
  for (const double side : {-1.0, 1.0}) {
    const Vector3d hand(side * (0.05 + 7 * 0.04), -0.08, 0);
    EXPECT_LT((surface.points.rowwise() - hand.transpose()).rowwise().norm().minCoeff(), 0.01);
  }
  // A part that is too small to be cut off stays on.
  options.tearing.least_part = 0.9 * 0.12 * 0.16;
  Recording kept;
  RunContext again(1);
  make_dense_sheet(sheet, options)->run(kept, again, {});
  EXPECT_EQ(part_count(kept.frames.back().parts.at("surface").triangles), 1);
  EXPECT_LT(grown(kept.frames.back()), grown(last));
}

/// Thesis 3.2.2: the fingers' places are candidates.
TEST(TearGrowth, AFingerTearsTheSheetThatItPulls) {
  Sheet sheet = sheets::pulled_sheet();
  sheet.pattern.cuts.clear();
  sheet.toughness.energy = 100;
  Keyframe start, end;
  end.time = 0.8;
  end.shift = Vector3d(0, -0.03, 0);
  sheet.handles = {
      sheets::point_handle("finger", {{0.02, -0.04}}, {start, end}),
      sheets::point_handle("far edge", {{-0.06, 0.08}, {0, 0.08}, {0.06, 0.08}}, {start})};
  sheet.handles[0].stiffness = 2000;
  Recording recording;
  RunContext context(1);
  make_dense_sheet(sheet, few_triangles())->run(recording, context, {});
  const Frame& last = recording.frames.back();
  ASSERT_GT(last.diagnostics.at("tear_length"), 0);
  const auto& pattern =
      last.parts.at("tears").require_array("pattern", NamedArray::On::points, 2).values;
  EXPECT_LT((pattern.row(0) - Eigen::RowVector2d(0.02, -0.04)).norm(), 1e-12);
}

/// The same sheet whole, its border between the hands smooth.
TEST(TearGrowth, TheGeneralSearchTearsASmoothBorder) {
  Sheet sheet = sheets::pulled_sheet();
  sheet.pattern.cuts.clear();
  sheet.toughness.energy = 500;
  sheet.handle_step = 1e-3;
  sheet.substeps = 4;
  DenseOptions options = few_triangles();
  options.triangles = 200;
  const auto torn = [&](TearSearch search, double flaw) {
    options.tearing.search = search;
    options.tearing.flaw = flaw;
    Recording recording;
    RunContext context(1);
    make_dense_sheet(sheet, options)->run(recording, context, {});
    return recording.frames.back().diagnostics.at("tear_length");
  };
  EXPECT_GT(torn(TearSearch::everywhere, 4e-3), 0.01);
  EXPECT_EQ(torn(TearSearch::everywhere, 1e-9), 0) << "no flaws";
}

}  // namespace
}  // namespace geoprior::paper
