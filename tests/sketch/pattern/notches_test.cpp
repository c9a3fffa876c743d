#include "experiments/sketch/pattern/notches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/error.h"
#include "models/sketch/pattern/piece_border.h"
#include "tests/sketch/pattern/flat_patterns.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

double notched_length(const Pattern& pattern, const Notch& notch) {
  const PatternPiece& piece = pattern.pieces[notch.piece];
  return edge_length(piece, piece.edges[notch.edge]);
}

TEST(Notches, LieAtEqualLengthsOnBothSides) {
  const Pattern pattern = test::bucket();
  const auto notches = paired_notches(pattern, {.spacing = 0.05});
  ASSERT_GE(notches.size(), 20U);
  ASSERT_EQ(notches.size() % 2, 0U);
  for (std::size_t k = 0; k < notches.size(); k += 2) {
    const Notch &a = notches[k], &b = notches[k + 1];
    EXPECT_EQ(a.label, static_cast<int>(k / 2) + 1);
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.direction, b.direction);
    EXPECT_NE(std::pair(a.piece, a.edge), std::pair(b.piece, b.edge));
    EXPECT_NEAR(a.arc, notched_length(pattern, b) - b.arc, 1e-14);
  }
}

// Sewn along the facets of a bucket, both notches of a pair lie at the same point of the surface:
// between the same two vertices, at the same share.
TEST(Notches, MeetOnTheSewnSurface) {
  const Pattern pattern = test::bucket(24);
  const auto notches = paired_notches(pattern, {.spacing = 0.07});
  const auto surface_place = [&](const Notch& notch) {
    const PatternPiece& piece = pattern.pieces[notch.piece];
    const auto& chain = piece.edges[notch.edge].vertices;
    std::map<int, double> weights;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Eigen::Vector2d a = piece.points.row(chain[i]), b = piece.points.row(chain[i + 1]);
      const double t = (notch.point - a).dot(b - a) / (b - a).squaredNorm();
      if (t < 0 || t > 1 || (a + t * (b - a) - notch.point).norm() > 1e-12) continue;
      weights[piece.surface_vertex[chain[i]]] = 1 - t;
      weights[piece.surface_vertex[chain[i + 1]]] = t;
    }
    return weights;
  };
  for (std::size_t k = 0; k < notches.size(); k += 2) {
    auto here = surface_place(notches[k]);
    const auto there = surface_place(notches[k + 1]);
    ASSERT_GE(here.size(), 2U);
    for (const auto& [vertex, weight] : there) EXPECT_NEAR(here[vertex], weight, 1e-9) << k;
  }
}

// Turned round, the notches of an edge do not come to lie upon themselves.
TEST(Notches, ShowWhenAnEdgeIsReversed) {
  const Pattern pattern = test::bucket();
  for (const double spacing : {0.02, 0.033, 0.1, 0.5, 10.0}) {
    std::map<std::pair<int, int>, std::vector<double>> arcs;
    std::map<std::pair<int, int>, double> lengths;
    for (const Notch& notch : paired_notches(pattern, {.spacing = spacing})) {
      arcs[{notch.piece, notch.edge}].push_back(notch.arc);
      lengths[{notch.piece, notch.edge}] = notched_length(pattern, notch);
    }
    ASSERT_EQ(arcs.size(), 4U) << "two seams";
    for (const auto& [edge, along] : arcs) {
      double worst = 0;
      for (const double arc : along) {
        double nearest = 1e300;
        for (const double other : along) {
          nearest = std::min(nearest, std::abs(lengths[edge] - other - arc));
        }
        worst = std::max(worst, nearest);
      }
      const double part = std::min(spacing, lengths[edge]);
      EXPECT_GT(worst, 0.1 * part) << spacing;
      for (const double arc : along) {
        EXPECT_GT(std::min(arc, lengths[edge] - arc), 0.2 * part) << "no mark at a corner";
      }
    }
  }
}

TEST(Notches, PointAwayFromTheMaterial) {
  const Pattern pattern = test::bucket();
  for (const Notch& notch : paired_notches(pattern, {.spacing = 0.05})) {
    EXPECT_NEAR(notch.outward.norm(), 1, 1e-15);
    // The wall's outer arc and the disc are circles about the origin; chords cost a little.
    if (notch.edge == 0) {
      EXPECT_GT(notch.outward.dot(notch.point.normalized()), 0.99);
    }
  }
}

// 100 mm sewn to 102 mm: the shares are equal, the difference is eased in evenly.
TEST(Notches, EaseADifferenceOfLengthInEvenly) {
  PatternPiece a = test::polygon_piece("a", {{0, 0}, {0.1, 0}, {0.1, 0.05}, {0, 0.05}});
  PatternPiece b = test::polygon_piece("b", {{0, 0}, {0.102, 0}, {0.102, 0.05}, {0, 0.05}});
  a.edges = {{{0, 1}, 0, 1, 0}};
  b.edges = {{{0, 1}, 0, 0, 0}};
  const auto notches = paired_notches({{a, b}}, {.spacing = 0.02});
  ASSERT_EQ(notches.size(), 10U);
  for (std::size_t k = 0; k < notches.size(); k += 2) {
    EXPECT_NEAR(notches[k].arc / 0.1, 1 - notches[k + 1].arc / 0.102, 1e-14);
  }
}

TEST(Notches, FoldAnEdgeThatIsItsOwnPartner) {
  PatternPiece piece = test::polygon_piece("dart", {{0, 0}, {0.1, 0}, {0.1, 0.1}, {0, 0.1}});
  piece.edges = {{{0, 1, 2}, 0, 0, 0}};
  const auto notches = paired_notches({{piece}}, {.spacing = 0.05});
  ASSERT_EQ(notches.size(), 4U);
  for (std::size_t k = 0; k < notches.size(); k += 2) {
    EXPECT_NEAR(notches[k].arc + notches[k + 1].arc, 0.2, 1e-15);
  }
}

TEST(Notches, LeaveFreeAndVeryShortEdgesAlone) {
  PatternPiece piece = test::polygon_piece("small", {{0, 0}, {0.01, 0}, {0.01, 0.1}, {0, 0.1}});
  piece.edges = {{{0, 1}, 0, 0, 2}, {{1, 2}, -1, -1, -1}, {{2, 3}, 0, 0, 0}};
  EXPECT_TRUE(paired_notches({{piece}}, {.spacing = 0.05}).empty());
}

TEST(Notches, NameThePieceOfABrokenPattern) {
  const auto refusal = [](auto change) {
    Pattern pattern = test::bucket(6);
    change(pattern);
    return test::error_of([&] { paired_notches(pattern, {}); });
  };
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[1].edges[0].partner_edge = 2; }),
              HasSubstr("piece 0 'wall', edge 0"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[0].edges[0].partner_piece = 7; }),
              HasSubstr("does not exist"));
  EXPECT_THAT(refusal([](Pattern& p) {
                p.pieces[0].edges[1].vertices = {0, 2};
              }),
              HasSubstr("not joined by the border"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[0].points(3, 0) = NAN; }), HasSubstr("point 3"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[0].points(4, 1) = NAN; }), HasSubstr("point 4"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[1].borders[0][2] = 99; }),
              HasSubstr("point 99 of 6"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[1].borders.clear(); }), HasSubstr("no border"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[1].grain = {0, 0}; }), HasSubstr("grain"));
  EXPECT_THAT(refusal([](Pattern& p) { p.pieces[1].folds = {{1}}; }), HasSubstr("fold 0"));
}

}  // namespace
}  // namespace geoprior::sketch
