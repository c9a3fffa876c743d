#include "metrics/developability/creases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/angles.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using sheets::Sheet;

GriddedSheet gridded(const Sheet& s) {
  return gridded_sheet(s.pattern, s.x, s.triangles, CreaseOptions{}.grid_spacing);
}
double length_of(const Sheet& s) { return crease_length(gridded(s)); }
std::vector<DetectedCone> cones_of(const Sheet& s) { return detect_cones(gridded(s)); }

TEST(CreaseLength, OfAStraightFoldAtAnyAngleToTheGrid) {
  for (double turn = 0; turn < 180; turn += 7.5) {
    const Sheet s = sheets::folded(0.2, 0.25, 8, 6, 50 * kDegree, turn * kDegree);
    EXPECT_NEAR(length_of(s) / 0.25, 1, 0.05) << turn;
  }
}

TEST(CreaseLength, DoesNotDependOnTheMeshThatCarriesTheFold) {
  // The lines that cross are the same; only edges on the fold matter.
  const double coarse = length_of(sheets::folded(0.2, 0.25, 2, 1, 50 * kDegree, 0.3));
  EXPECT_EQ(coarse, length_of(sheets::folded(0.2, 0.25, 8, 6, 50 * kDegree, 0.3)));
  EXPECT_EQ(coarse, length_of(sheets::folded(0.2, 0.25, 40, 60, 50 * kDegree, 0.3)));
}

/// Flat, a quarter of a cylinder about the middle, flat.
sheets::Map rounded_fold(double radius) {
  return [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    const double half = radius * std::numbers::pi / 4;
    const double s = std::clamp(p(0), -half, half);
    const double angle = s / radius;
    const Eigen::Vector3d on_arc(radius * std::sin(angle), p(1), radius * (1 - std::cos(angle)));
    return on_arc + (p(0) - s) * Eigen::Vector3d(std::cos(angle), 0, std::sin(angle));
  };
}

TEST(CreaseLength, OfARoundedFoldCountsOnceNotPerEdge) {
  for (const double turn : {0.0, 0.4}) {
    const auto ratio = [&](double radius) {
      const Sheet s = sheets::mapped(sheets::rectangle(0.2, 0.2, 80, 10), rounded_fold(radius));
      return length_of(sheets::turned_pattern(s, turn)) / 0.2;
    };
    EXPECT_NEAR(ratio(0.002), 1, 0.05);
    EXPECT_NEAR(ratio(0.004), 1, 0.1);
    // 5 mm turn by 36 degrees, but lines near the rulings and short links turn by less than 20.
    EXPECT_GT(ratio(0.008), 0.5);
    EXPECT_LT(ratio(0.008), 1);
    EXPECT_EQ(ratio(0.03), 0);
  }
}

TEST(CreaseLength, OfAFoldAcrossTheMeshIsThatOfItsZigzag) {
  const double slant = 0.4;
  const auto ratio = [&](int n) {
    const Eigen::Matrix2d turn = Eigen::Rotation2Dd(slant).toRotationMatrix();
    const Sheet s = sheets::mapped(sheets::rectangle(0.2, 0.2, n, n), [&](const auto& p) {
      return sheets::fold(60 * kDegree)(turn * p);
    });
    return length_of(s) / (0.2 / std::cos(slant));
  };
  EXPECT_NEAR(ratio(45), 1, 0.1);    // edges of 4.4 mm
  EXPECT_NEAR(ratio(20), 1.4, 0.1);  // 10 mm: two rows of folds too far apart to be one
}

TEST(CreaseLength, CountsFoldsAboveTwentyDegrees) {
  EXPECT_EQ(length_of(sheets::folded(0.2, 0.25, 8, 6, 19.9 * kDegree)), 0);
  EXPECT_GT(length_of(sheets::folded(0.2, 0.25, 8, 6, 20.1 * kDegree)), 0.2);
  EXPECT_EQ(length_of(sheets::folded(0.2, 0.25, 8, 6, -50 * kDegree)),
            length_of(sheets::folded(0.2, 0.25, 8, 6, 50 * kDegree)));
}

TEST(CreaseLength, OfASmoothCylinderIsNone) {
  for (const double turn : {0.0, 0.3, 0.8}) {
    const Sheet s = sheets::turned_pattern(
        sheets::mapped(sheets::rectangle(0.2, 0.2, 40, 10, 0.1), sheets::cylinder(0.04)), turn);
    EXPECT_EQ(length_of(s), 0);
    EXPECT_EQ(facet_areas(gridded(s)).size(), 1u);
    EXPECT_TRUE(cones_of(s).empty());
  }
}

/// Sides of about 45 mm, all folded by more than 20 degrees.
sheets::Miura wide_miura() {
  sheets::Miura m;
  m.S = 0.04;
  m.V = 0.024;
  m.L = 0.036;
  m.H = 0.02;
  return m;
}

TEST(CreaseLength, OfAMiuraOriIsThatOfItsSides) {
  // 9 zigzag and 9 straight folds of 10 sides each.
  const auto ratio = [](const sheets::Miura& m) {
    const double sides = 90 * (std::hypot(m.S, m.V) + std::hypot(m.L, m.H));
    return length_of(sheets::miura_ori(m)) / sides;
  };
  EXPECT_NEAR(ratio(wide_miura()), 1, 0.05);
  // Sides of 22 mm are five links long: where folds meet, one link crosses two of them and counts
  // once.
  EXPECT_NEAR(ratio({}), 0.92, 0.03);
}

TEST(Facets, OfAFoldAreItsSides) {
  for (const double turn : {0.0, 0.4, std::numbers::pi / 4}) {
    // The fold is a quarter of the width from the left.
    Sheet s = sheets::rectangle(0.2, 0.25, 8, 6);
    s = sheets::turned_pattern(sheets::mapped(s, sheets::fold(1, -0.05)), turn);
    std::vector<double> areas = facet_areas(gridded(s));
    ASSERT_EQ(areas.size(), 2u);
    std::sort(areas.begin(), areas.end());
    EXPECT_NEAR(areas[0], 0.05 * 0.25, 0.01 * 0.05);
    EXPECT_NEAR(areas[1], 0.15 * 0.25, 0.01 * 0.05);
  }
}

TEST(Facets, OfAMiuraOriAreItsParallelograms) {
  const sheets::Miura m;
  const Sheet s = sheets::miura_ori(m);
  const std::vector<double> areas = facet_areas(gridded(s));
  EXPECT_EQ(areas.size(), 100u);
  const double a = std::hypot(m.L, m.H);
  const double parallelogram = a * (s.pattern(11, 0) - s.pattern(0, 0));
  const double mean = std::accumulate(areas.begin(), areas.end(), 0.0) / 100;
  EXPECT_NEAR(mean / parallelogram, 1, 0.01);
}

TEST(Facets, LeaveDustOut) {
  // A pyramid of 8 mm on a plane: its four sides are 16 mm^2 each.
  Sheet s = sheets::rectangle(0.2, 0.2, 50, 50);
  s.x(25 * 51 + 25, 2) = 0.01;
  EXPECT_EQ(facet_areas(gridded(s)).size(), 1u);
  CreaseOptions fine;
  fine.smallest_facet = 0;
  EXPECT_GT(facet_areas(gridded(s), fine).size(), 3u);
}

TEST(DetectedCones, AreNoneOnPlaneAndFold) {
  EXPECT_TRUE(cones_of(sheets::rectangle(0.2, 0.2, 5, 5)).empty());
  EXPECT_TRUE(cones_of(sheets::folded(0.2, 0.25, 8, 6, 1.5, 0.3)).empty());
  // Two parallel folds within one ring.
  const auto twice = [](const Eigen::Vector2d& p) {
    const Eigen::Vector3d x = sheets::fold(0.8)(p);
    return p(0) < 0.01 ? x
                       : Eigen::Vector3d(sheets::fold(0.8)(Eigen::Vector2d(0.01, p(1))) +
                                         (p(0) - 0.01) * Eigen::Vector3d(-0.2, 0, 0.98));
  };
  EXPECT_TRUE(cones_of(sheets::mapped(sheets::rectangle(0.2, 0.2, 20, 5), twice)).empty());
}

TEST(DetectedCones, OfAnIsometricDConeIsOneAtItsApex) {
  for (const int lobes : {2, 3}) {
    for (const double turn : {0.0, 0.4}) {
      const Sheet s = sheets::turned_pattern(
          sheets::mapped(sheets::disc(0.1, 4, 120), sheets::DCone(0.3, lobes)), turn);
      const auto cones = cones_of(s);
      ASSERT_EQ(cones.size(), 1u) << lobes;
      EXPECT_LT(cones.front().position.norm(), 0.004);  // energies stand 5 mm apart
    }
  }
}

/// Cones of equal slope that stand on a plane, 0.07 m in radius.
Sheet cones_at(const std::vector<Eigen::Vector2d>& apexes, int n, double jitter) {
  Sheet s = sheets::rectangle(0.4, 0.4, n, n, jitter);
  for (const Eigen::Vector2d& apex : apexes) {  // every mesh has a vertex there
    Eigen::Index nearest = 0;
    (s.pattern.rowwise() - apex.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    s.pattern.row(nearest) = apex.transpose();
  }
  return sheets::mapped(s, [&](const Eigen::Vector2d& p) {
    double height = 0;
    for (const Eigen::Vector2d& apex : apexes) {
      height = std::max(height, 0.3 * (0.07 - (p - apex).norm()));
    }
    return Eigen::Vector3d(p(0), p(1), height);
  });
}

TEST(DetectedCones, CountApexesOnEveryMesh) {
  const std::vector<Eigen::Vector2d> four{{-0.1, -0.1}, {-0.1, 0.1}, {0.1, -0.1}, {0.1, 0.1}};
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{4}}) {
    const std::vector<Eigen::Vector2d> apexes(four.begin(), four.begin() + count);
    EXPECT_EQ(cones_of(cones_at(apexes, 40, 0)).size(), count);
    EXPECT_EQ(cones_of(cones_at(apexes, 80, 0)).size(), count);
    EXPECT_EQ(cones_of(cones_at(apexes, 40, 0.1)).size(), count);
  }
}

TEST(DetectedCones, CloserThanTheirDistanceAreOne) {
  EXPECT_EQ(cones_of(cones_at({{-0.02, 0}, {0.02, 0}}, 80, 0)).size(), 2u);
  EXPECT_EQ(cones_of(cones_at({{-0.005, 0}, {0.005, 0}}, 80, 0)).size(), 1u);
}

TEST(DetectedCones, OfAMiuraOriAreItsVertices) {
  // A ring sees one at a time; those on the border are not looked at.
  EXPECT_EQ(cones_of(sheets::miura_ori(wide_miura())).size(), 81u);
}

}  // namespace
}  // namespace geoprior
