// What tears do to the hybrid's structure, and where it says that the sheet may tear.

#include "solvers/paper/tear/torn_structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "models/paper/contact/segments.h"
#include "solvers/paper/sheet/invariants.h"
#include "solvers/paper/sheet/pieces.h"
#include "solvers/paper/sheet/singular_point.h"
#include "tests/paper/sheets.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;
using testing::ElementsAre;
using testing::IsEmpty;

/// A sheet of 0.2 m by 0.2 m with a cut of 4 cm from the middle of its lower side.
struct TornSheet {
  Sheet sheet = sheets::free_sheet(0.2, 0.2);
  HybridOptions options;
  PaperStructure structure;
  Tears tears;

  TornSheet() : tears(with_cut(), 1e-4) {}
  Pattern with_cut() {
    sheet.pattern.cuts = {{{0, -0.1}, {0, -0.06}}};
    return sheet.pattern;
  }
  RulingEditor editor() { return {tears.torn(), {}, {4e-3, 0.1}, structure}; }
  int follow() {
    RulingEditor pen = editor();
    return follow_tears(tears, 0.5, options, pen);
  }
  std::vector<std::string> broken() {
    RulingMesh mesh = mesh_structure(structure, tears.torn(), {}, {0.1, 4, 0.04});
    derive_pieces(structure, tears.torn(), mesh);
    return broken_invariants(structure, tears.torn(), mesh.mesh);
  }
};

TEST(TornStructure, ATipIsASingularPointWithAFan) {
  TornSheet s;
  EXPECT_EQ(s.follow(), 0);
  ASSERT_EQ(s.structure.singular_points.size(), 1U);
  const SingularPoint& tip = s.structure.singular_points[0];
  EXPECT_EQ(tip.position, Vector2d(0, -0.06));
  EXPECT_EQ(tip.tear, 0);
  EXPECT_GE(s.structure.rulings_at(0).size(), 3U);
  EXPECT_THAT(s.broken(), IsEmpty());
}

TEST(TornStructure, ATearPassesTheApexOfCones) {
  TornSheet s;
  s.follow();
  RulingEditor pen = s.editor();
  add_singular_point({0.001, -0.02}, 0, {}, s.options, pen);
  ASSERT_EQ(s.structure.singular_points.size(), 2U);
  ASSERT_THAT(s.broken(), IsEmpty());
  int removed = 0;
  for (int step = 1; step <= 20; ++step) {
    s.tears.advance(0, {0, -0.06 + step * 4e-3}, 0.5);
    removed += s.follow();
    EXPECT_THAT(s.broken(), IsEmpty()) << "step " << step;
  }
  EXPECT_EQ(removed, 1) << "where it was the sheet is no longer whole";
  ASSERT_EQ(s.structure.singular_points.size(), 1U);
  EXPECT_LT((s.structure.singular_points[0].position - Vector2d(0, 0.02)).norm(), 1e-12);
}

TEST(TornStructure, RulingsEndAtTheLipsOfATearThatCrossesThem) {
  TornSheet s;
  RulingEditor pen = s.editor();
  const auto level = pen.chord({0, 0.05}, {1, 0});
  ASSERT_TRUE(level.has_value());
  pen.add(*level);
  for (int step = 1; step <= 40; ++step) s.tears.advance(0, {0, -0.06 + step * 3e-3}, 0.5);
  s.follow();
  int halves = 0;
  for (const Ruling& r : s.structure.rulings) {
    if (std::abs(r.a.y() - 0.05) < 1e-9 && std::abs(r.b.y() - 0.05) < 1e-9) ++halves;
  }
  EXPECT_EQ(halves, 2);
  EXPECT_THAT(s.broken(), IsEmpty());
}

/// Three uprights make one cylinder: it meets the flat ground at four places of the border.
TEST(TearCandidates, AreTipsAndJunctions) {
  TornSheet s;
  for (const double u : {0.05, 0.065, 0.08}) {
    RulingEditor pen = s.editor();
    const auto upright = pen.chord({u, 0}, {0, 1});
    ASSERT_TRUE(upright.has_value());
    pen.add(*upright);
  }
  ASSERT_THAT(s.broken(), IsEmpty());
  std::vector<double> junctions;
  for (const TearCandidate& c : tear_candidates(s.sheet, s.tears, s.structure)) {
    EXPECT_EQ(c.on_flaw, !c.tear.has_value());
    if (c.on_flaw && c.place.x() > 0.04 && c.place.y() < 0) junctions.push_back(c.place.x());
  }
  std::sort(junctions.begin(), junctions.end());
  EXPECT_THAT(junctions,
              ElementsAre(testing::DoubleNear(0.05, 1e-9), testing::DoubleNear(0.08, 1e-9)));
}

}  // namespace
}  // namespace geoprior::paper
