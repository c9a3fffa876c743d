#include "metrics/isometry/flattening.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using std::numbers::pi;

FlatPiece piece_of(const sheets::Sheet& s) { return {s.pattern, s.x, s.triangles}; }

/// A flat plate whose pattern is it stretched along x and y.
FlatPiece stretched(double along_x, double along_y) {
  FlatPiece piece = piece_of(sheets::rectangle(0.4, 0.3, 8, 6, 0.2));
  piece.points.col(0) *= along_x;
  piece.points.col(1) *= along_y;
  return piece;
}

FlatteningSummary flattening_of(const FlatPiece& piece) { return flattening({&piece, 1}); }

TEST(Flattening, OfAnIsometricPatternIsPerfect) {
  // The pattern of a prism is exact: its facets are unrolled.
  const int n = 24;
  sheets::Sheet s = sheets::mapped(sheets::rectangle(0.3, 0.2, n, 6), sheets::cylinder(0.1));
  const double arc = 0.3 / n / 0.1;  // a facet is the chord of it
  s.pattern.col(0) *= std::sin(arc / 2) / (arc / 2);
  const FlatteningSummary f = flattening_of(piece_of(s));
  EXPECT_NEAR(f.stretch_max, 1, 1e-7);
  EXPECT_NEAR(f.area_ratio, 1, 1e-12);
  EXPECT_NEAR(f.angle_ratio_max, 1, 1e-7);
  EXPECT_NEAR(f.sander_l2, 1, 1e-7);
  EXPECT_NEAR(f.sander_linf, 1, 1e-7);
  EXPECT_EQ(f.stretch_share[0], 1);
  EXPECT_EQ(f.area_share[0], 1);
  EXPECT_EQ(f.flips, 0);
  EXPECT_EQ(f.self_overlaps, 0);
}

TEST(Flattening, OfAStretchedPlateIsItsFactors) {
  const double a = 1.03, b = 0.985;
  const FlatPiece piece = stretched(a, b);
  const Eigen::MatrixX2d s = flattening_singular_values(piece);
  EXPECT_LT((s.col(0).array() - a).abs().maxCoeff(), 1e-12);
  EXPECT_LT((s.col(1).array() - b).abs().maxCoeff(), 1e-12);
  const FlatteningSummary f = flattening_of(piece);
  EXPECT_NEAR(f.stretch_mean, a, 1e-12);
  EXPECT_NEAR(f.stretch_p95, a, 1e-12);
  EXPECT_NEAR(f.stretch_max, a, 1e-12);
  EXPECT_NEAR(f.area_ratio, a * b, 1e-12);
  EXPECT_NEAR(f.area_ratio_min, a * b, 1e-12);
  EXPECT_NEAR(f.area_ratio_max, a * b, 1e-12);
  EXPECT_NEAR(f.angle_ratio_mean, a / b, 1e-12);
  EXPECT_NEAR(f.sander_l2, std::sqrt((1 / (a * a) + 1 / (b * b)) / 2), 1e-12);
  EXPECT_NEAR(f.sander_linf, 1 / b, 1e-12);
  EXPECT_EQ(f.stretch_share, (std::array{0.0, 0.0, 1.0}));  // 3 %
  EXPECT_EQ(f.area_share, (std::array{0.0, 1.0, 1.0}));     // 1.455 %
}

TEST(Flattening, ShrinkingCountsAsStretchOfTheSurface) {
  // Ten per cent too small is 1 / 0.9 too long in space; scale is not forgiven.
  const FlatteningSummary f = flattening_of(stretched(0.9, 0.9));
  EXPECT_NEAR(f.stretch_max, 1 / 0.9, 1e-7);
  EXPECT_NEAR(f.angle_ratio_max, 1, 1e-7);
  EXPECT_NEAR(f.sander_l2, 1 / 0.9, 1e-7);
  EXPECT_NEAR(f.area_ratio, 0.81, 1e-12);
}

TEST(Flattening, SharesAreByAreaOfTheSurface) {
  // One piece of four units of area is exact, one of a unit is stretched by 4 %.
  const sheets::Sheet s = sheets::rectangle(1, 1, 3, 3);
  FlatPiece large = piece_of(s), small = large;
  large.points *= 2;
  large.x *= 2;
  small.points.col(0) *= 1.04;
  const FlatteningSummary f = flattening(std::array{large, small});
  EXPECT_NEAR(f.stretch_share[1], 0.8, 1e-12);
  EXPECT_NEAR(f.area_share[1], 0.8, 1e-12);
  EXPECT_EQ(f.stretch_share[2], 1);
  EXPECT_NEAR(f.stretch_mean, 1 + 0.04 / 5, 1e-8);
  EXPECT_NEAR(f.stretch_p95, 1.04, 1e-8);
  EXPECT_NEAR(f.area_ratio, 1 + 0.04 / 5, 1e-12);
}

TEST(Flattening, OfAConeSectorIsExactAndOfItsProjectionItIsTheSine) {
  // Cone of half angle alpha: unrolled it turns by sin alpha of a turn and nothing stretches; seen
  // along its axis rulings shorten by sin alpha and circles keep their length.
  const double sine = 0.6, cosine = 0.8;
  const int spokes = 40;
  FlatPiece piece = piece_of(sheets::rectangle(1, 1, spokes, 5));
  FlatPiece seen = piece;
  // Along an arc a facet is a chord, so the sector's chords are given the same length.
  const double step = pi / spokes;  // half a turn of the cone
  const double sector_step = 2 * std::asin(sine * std::sin(step / 2));
  for (Eigen::Index v = 0; v < piece.x.rows(); ++v) {
    const double k = std::round((piece.points(v, 0) + 0.5) * spokes);
    const double r = piece.points(v, 1) + 1;  // along a ruling
    piece.x.row(v) << r * sine * std::cos(k * step), r * sine * std::sin(k * step), -r * cosine;
    // Down from the axis: the grid's cells stay counter-clockwise.
    piece.points.row(v) << r * std::cos(k * sector_step), -r * std::sin(k * sector_step);
    seen.points.row(v) = piece.x.row(v).head<2>();
  }
  seen.x = piece.x;
  EXPECT_NEAR(flattening_of(piece).stretch_max, 1, 1e-7);
  EXPECT_EQ(flattening_of(piece).flips, 0);
  // A facet's slope is that of its middle line, a little steeper than the ruling.
  const double middle = std::cos(step / 2) * sine;
  const double facet_sine = middle / std::hypot(middle, cosine);
  const FlatteningSummary f = flattening_of(seen);
  EXPECT_NEAR(f.area_ratio, facet_sine, 1e-12);
  EXPECT_NEAR(f.stretch_mean, 1 / facet_sine, 1e-7);
  EXPECT_NEAR(f.angle_ratio_max, 1 / facet_sine, 1e-7);
}

TEST(Flattening, CountsFlipsAndOverlaps) {
  // Folded flat along its middle: as isometric as before, but half of it is turned over.
  sheets::Sheet s = sheets::rectangle(1, 0.6, 8, 5);
  s.pattern.col(0) = s.pattern.col(0).cwiseAbs();
  const FlatteningSummary f = flattening_of(piece_of(s));
  EXPECT_NEAR(f.stretch_max, 1, 1e-7);
  EXPECT_EQ(f.flips, 40);
  EXPECT_GE(f.self_overlaps, 40);
  EXPECT_NEAR(f.self_overlap_area, 0.3, 1e-12);
}

TEST(Flattening, ACollapsedTriangleIsHugeNotInfinite) {
  FlatPiece piece = stretched(1, 1);
  piece.points.col(1).setZero();
  const FlatteningSummary f = flattening_of(piece);
  EXPECT_EQ(f.flips, piece.triangles.rows());
  EXPECT_GE(f.stretch_max, 1e5);
  EXPECT_TRUE(std::isfinite(f.sander_l2));
  EXPECT_EQ(f.self_overlaps, 0);  // what has no area overlaps nothing
}

TEST(Flattening, ATriangleWithoutAreaOnTheSurfaceHasNoWeight) {
  FlatPiece piece = stretched(1, 1);
  piece.x.row(piece.triangles(0, 0)) = piece.x.row(piece.triangles(0, 1));
  FlatPiece rest = piece;
  // Without the triangles at that corner the rest is exact.
  std::vector<int> kept;
  for (int t = 0; t < piece.triangles.rows(); ++t) {
    if ((piece.triangles.row(t).array() != piece.triangles(0, 0)).all()) kept.push_back(t);
  }
  rest.triangles = piece.triangles(kept, Eigen::all).eval();
  EXPECT_NEAR(flattening_of(rest).stretch_max, 1, 1e-7);
  const Eigen::MatrixX2d s = flattening_singular_values(piece);
  EXPECT_EQ(s(0, 0), 1);
  EXPECT_EQ(s(0, 1), 1);
}

TEST(PieceOverlaps, OfSquaresLaidOut) {
  const sheets::Sheet s = sheets::rectangle(1, 1, 4, 4, 0.2);
  std::array pieces{piece_of(s), piece_of(s), piece_of(s)};
  pieces[1].points.col(0).array() += 0.75;  // covers a quarter of the first
  pieces[1].points.col(1).array() += 0.2;
  pieces[2].points.col(1).array() -= 1;  // touches the first along a side
  const std::vector<PieceOverlap> overlaps = piece_overlaps(pieces);
  ASSERT_EQ(overlaps.size(), 1u);
  EXPECT_EQ(overlaps[0].first, 0);
  EXPECT_EQ(overlaps[0].second, 1);
  EXPECT_NEAR(overlaps[0].area, 0.25 * 0.8, 1e-12);
  EXPECT_TRUE(piece_overlaps({}).empty());
}

TEST(Flattening, RefusesWhatItCannotMeasure) {
  FlatPiece piece = stretched(1, 1);
  EXPECT_THROW(flattening({}), Error);
  piece.x.setZero();
  EXPECT_THROW(flattening_of(piece), Error);
  piece.x.conservativeResize(3, 3);
  EXPECT_THROW(flattening_of(piece), Error);
  piece = stretched(1, 1);
  piece.points(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(flattening_of(piece), Error);
}

TEST(PiecesApart, AreTheStripsThatAPatternWasCutInto) {
  // Strips of a sheet, numbered from right to left with a gap: each has the points of its own
  // triangles alone, and together they are flattened as the whole is.
  const sheets::Sheet s = sheets::mapped(sheets::rectangle(0.4, 0.3, 8, 6), sheets::cylinder(0.1));
  std::vector<int> piece;
  for (Eigen::Index t = 0; t < s.triangles.rows(); ++t)
    piece.push_back(t < s.triangles.rows() / 2 ? 7 : 3);
  const auto pieces = pieces_apart(s.pattern, s.x, s.triangles, piece);
  ASSERT_EQ(pieces.size(), 2U);
  for (const FlatPiece& half : pieces) {
    EXPECT_EQ(half.points.rows(), 5 * 7);
    EXPECT_EQ(half.triangles.rows(), s.triangles.rows() / 2);
    EXPECT_EQ(half.triangles.maxCoeff(), half.points.rows() - 1);
  }
  EXPECT_GT(pieces[0].points.col(0).minCoeff(), -1e-12);  // 3, the right half, comes first
  EXPECT_LT(pieces[1].points.col(0).maxCoeff(), 1e-12);
  const FlatteningSummary apart = flattening(pieces), whole = flattening_of(piece_of(s));
  EXPECT_NEAR(apart.stretch_mean, whole.stretch_mean, 1e-12);
  EXPECT_NEAR(apart.stretch_max, whole.stretch_max, 1e-12);
  piece.pop_back();
  EXPECT_THROW(pieces_apart(s.pattern, s.x, s.triangles, piece), Error);
  EXPECT_THROW(pieces_apart(s.pattern, s.x.topRows(3), s.triangles, piece), Error);
}

}  // namespace
}  // namespace geoprior
