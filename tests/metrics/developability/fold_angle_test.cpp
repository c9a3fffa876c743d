#include "metrics/developability/fold_angle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

std::vector<int> numbers_of_triangles(const TriMesh& mesh) {
  std::vector<int> all;
  for (int t = 0; t < mesh.triangle_count(); ++t) all.push_back(t);
  return all;
}

TEST(FoldAngle, OfATentIsTheSlopeOfItsSides) {
  // Flat on one side of the ridge, 50 degrees up on the other, seen from above.
  const sheets::Sheet s = sheets::folded(2, 1, 4, 3, 50 * kDegree);
  const TriMesh mesh = s.mesh();
  const Eigen::Vector3d up(0, 0, 2);
  std::vector<int> flat, sloped;
  for (const int t : numbers_of_triangles(mesh)) {
    const double middle =
        (mesh.V(mesh.F(t, 0), 0) + mesh.V(mesh.F(t, 1), 0) + mesh.V(mesh.F(t, 2), 0));
    (middle < 0 ? flat : sloped).push_back(t);
  }
  EXPECT_NEAR(fold_angle(mesh, sloped, up, 60 * kDegree).max, 10 * kDegree, 1e-12);
  EXPECT_NEAR(fold_angle(mesh, sloped, up, 60 * kDegree).mean, 10 * kDegree, 1e-12);
  EXPECT_NEAR(fold_angle(mesh, flat, up, 60 * kDegree).mean, 60 * kDegree, 1e-12);
  // Both sides have the same area.
  const FoldAngle both = fold_angle(mesh, numbers_of_triangles(mesh), up, 60 * kDegree);
  EXPECT_NEAR(both.mean, 35 * kDegree, 1e-12);
  EXPECT_NEAR(both.max, 60 * kDegree, 1e-12);
  // From below the back is seen: 130 degrees.
  EXPECT_NEAR(fold_angle(mesh, sloped, -up, 60 * kDegree).max, 70 * kDegree, 1e-12);
}

TEST(FoldAngle, OnACylinderIsTheAzimuth) {
  // Facets of 3 degrees about the y axis; the one about 60 degrees is exact.
  const double radius = 0.1;
  const sheets::Sheet s = sheets::mapped(sheets::rectangle(radius * 150 * kDegree, 0.2, 50, 2),
                                         sheets::cylinder(radius));
  const TriMesh mesh = s.mesh();
  for (const int t : numbers_of_triangles(mesh)) {
    const int facet = t / 4;  // four triangles each
    const double azimuth = std::abs(-75 + 3 * (facet + 0.5)) * kDegree;
    EXPECT_NEAR(fold_angle(mesh, std::array{t}, {0, 0, 1}, 60 * kDegree).max,
                std::abs(azimuth - 60 * kDegree), 1e-12);
  }
}

TEST(FoldAngle, RefusesWhatHasNoAngle) {
  TriMesh mesh = sheets::rectangle(1, 1, 1, 1).mesh();
  EXPECT_THROW(fold_angle(mesh, {}, {0, 0, 1}, 1), Error);
  EXPECT_THROW(fold_angle(mesh, std::array{0}, {0, 0, 0}, 1), Error);
  EXPECT_THROW(fold_angle(mesh, std::array{0}, {0, 0, 1}, 4), Error);
  mesh.V.setZero();
  EXPECT_THROW(fold_angle(mesh, std::array{0, 1}, {0, 0, 1}, 1), Error);
}

TEST(FoldAngles, OfSidesAreWeighedByTheirArea) {
  // The ridge at 0.5 of -1 … 1: three quarters of the sheet are flat, a quarter rises by 50.
  const sheets::Sheet s =
      sheets::mapped(sheets::rectangle(2, 1, 8, 3), sheets::fold(50 * kDegree, 0.5));
  const TriMesh mesh = s.mesh();
  SeenFold flat{{}, Eigen::Vector3d::UnitZ(), 60 * kDegree}, sloped = flat;
  for (const int t : numbers_of_triangles(mesh)) {
    double middle = 0;
    for (int k = 0; k < 3; ++k) middle += s.pattern(mesh.F(t, k), 0) / 3;
    (middle < 0.5 ? flat : sloped).triangles.push_back(t);
  }
  const std::vector<SeenFold> sides{flat, sloped};
  const FoldAngle both = fold_angles(mesh, sides);
  EXPECT_NEAR(both.mean, (0.75 * 60 + 0.25 * 10) * kDegree, 1e-12);
  EXPECT_NEAR(both.max, 60 * kDegree, 1e-12);
  // From below, the flat side shows its back: 180 degrees.
  flat.to_eye = -flat.to_eye;
  EXPECT_NEAR(fold_angles(mesh, {&flat, 1}).mean, 120 * kDegree, 1e-12);
  EXPECT_THROW(fold_angles(mesh, {}), Error);
}

}  // namespace
}  // namespace geoprior
