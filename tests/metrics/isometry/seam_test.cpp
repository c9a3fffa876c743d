#include "metrics/isometry/seam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

/// Two squares of two triangles that meet at x = 1, the second one turned up by `angle`.
TriMesh folded(double angle) {
  TriMesh mesh;
  mesh.V.resize(6, 3);
  const double x = 1 + std::cos(angle), z = std::sin(angle);
  mesh.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, x, 0, z, x, 1, z;
  mesh.F.resize(4, 3);
  mesh.F << 0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2;
  return mesh;
}

TEST(SeamAngle, IsTheFoldAtTheBorderOfWhatIsMarked) {
  for (const double degrees : {0.0, 10.0, 90.0, 150.0}) {
    const double angle = degrees * std::numbers::pi / 180;
    EXPECT_NEAR(largest_seam_angle(folded(angle), {0, 0, 0, 0, 1, 1}), angle, 1e-14);
  }
}

TEST(SeamAngle, LooksNowhereElse) {
  const TriMesh box = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(largest_seam_angle(box, std::vector<char>(8, 0)), 0);
  EXPECT_EQ(largest_seam_angle(box, std::vector<char>(8, 1)), 0);
  // Around one corner the seam crosses faces and edges of the box.
  std::vector<char> corner(8, 0);
  corner[0] = 1;
  EXPECT_LE(largest_seam_angle(box, corner), std::numbers::pi / 2 + 1e-14);
  EXPECT_THROW(largest_seam_angle(box, {1, 0}), Error);
}

/// A height over a rectangle 0.2 x 0.1 of random triangles with edges of about 0.2 / n, marked
/// where u > 0.
struct Seamed {
  TriMesh mesh;
  std::vector<char> marked;
};
Seamed seamed(int n, const sheets::Map& map) {
  const sheets::Sheet s = sheets::mapped(sheets::rectangle(0.2, 0.1, n, n / 2, 0.2), map);
  Seamed result{s.mesh(), {}};
  for (Eigen::Index v = 0; v < s.pattern.rows(); ++v)
    result.marked.push_back(s.pattern(v, 0) > 1e-9 ? 1 : 0);
  return result;
}
SeamJumps jumps_of(const Seamed& s) { return seam_jumps(s.mesh, s.marked); }

TEST(SeamJumps, OfAStepBetweenPlanesIsItsHeight) {
  const SeamJumps jumps = jumps_of(seamed(40, [](const Eigen::Vector2d& p) {
    return Eigen::Vector3d(p(0), p(1), p(0) > 1e-9 ? 0.001 : 0.0);
  }));
  // The common plane is that of the two sides; bridging triangles do not tilt it.
  EXPECT_GT(jumps.places, 20);
  EXPECT_NEAR(jumps.largest.position, 0.001, 1e-12);
  EXPECT_NEAR(jumps.rms.position, 0.001, 1e-12);
  EXPECT_LT(jumps.largest.angle, 1e-9);
  EXPECT_LT(jumps.largest.curvature, 1e-8);
}

TEST(SeamJumps, OfAFoldIsItsAngle) {
  // The planes meet at u = 0, up to half an edge from where they are compared.
  const double angle = 0.3;
  const SeamJumps jumps = jumps_of(seamed(40, sheets::fold(angle)));
  EXPECT_NEAR(jumps.rms.angle, angle, 1e-9);
  EXPECT_LT(jumps.largest.position, 0.005 * std::tan(angle));
}

TEST(SeamJumps, OfACylinderOnAPlaneIsHalfItsCurvature) {
  // Tangent where they meet: position and normal are continuous, the mean curvature goes from 0 to
  // 1 / (2 R). A quadric of one side errs in it by
  // its edge over the radius, here 1 % and 0.5 % of the jump.
  const double radius = 0.1;
  const auto map = [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    return p(0) > 0 ? sheets::cylinder(radius)(p) : sheets::flat(p);
  };
  const SeamJumps coarse = jumps_of(seamed(40, map)), fine = jumps_of(seamed(80, map));
  // They part as u^2 / (2 R), and are compared up to half an edge from where they touch.
  EXPECT_LT(coarse.largest.position, 2 * 0.0025 * 0.0025 / (2 * radius));
  EXPECT_NEAR(coarse.rms.curvature, 5, 0.05);
  EXPECT_NEAR(fine.rms.curvature, 5, 0.025);
}

TEST(SeamJumps, OfTwoTangentCylindersIsHalfTheDifferenceOfTheirCurvatures) {
  const auto map = [](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    return sheets::cylinder(p(0) > 0 ? 0.1 : -0.2)(p);
  };
  const SeamJumps jumps = jumps_of(seamed(80, map));
  EXPECT_NEAR(jumps.rms.curvature, (1 / 0.1 + 1 / 0.2) / 2, 0.075);
}

/// Spheres of radius 100 and 70 mm about the z axis that share the circle 30 degrees from the first
/// one's pole, 45.6 degrees from the second one's; the second one is marked.
Seamed glued_spheres(int n) {
  const double R = 0.1, r = 0.07, polar = std::numbers::pi / 6;
  const double inner = std::asin(R * std::sin(polar) / r);  // polar angle of the circle on it
  const double shift = R * std::cos(polar) - r * std::cos(inner);
  return seamed(n, [=](const Eigen::Vector2d& p) -> Eigen::Vector3d {
    const double azimuth = 10 * p(1);
    const bool second = p(0) > 1e-9;
    const double radius = second ? r : R;
    const double theta =
        (second ? inner : polar) + (second ? -1 : 1) * std::abs(p(0)) / radius * 0.5;
    const double ring = radius * std::sin(theta);
    return {ring * std::cos(azimuth), ring * std::sin(azimuth),
            radius * std::cos(theta) + (second ? shift : 0)};
  });
}

TEST(SeamJumps, OfSpheresOnACommonCircleAreTheClosedForm) {
  // The mean curvatures are 1 / R and 1 / r whatever the tilt; the normals differ by the difference
  // of the polar angles.
  const double curvature = 1 / 0.07 - 1 / 0.1;
  const double angle = std::asin(0.05 / 0.07) - std::numbers::pi / 6;
  const SeamJumps coarse = jumps_of(glued_spheres(80)), fine = jumps_of(glued_spheres(160));
  EXPECT_NEAR(fine.rms.angle, angle, 1e-3 * angle);
  EXPECT_LT(std::abs(fine.rms.curvature - curvature),
            0.6 * std::abs(coarse.rms.curvature - curvature));
  EXPECT_NEAR(fine.rms.curvature, curvature, 0.01 * curvature);
}

TEST(SeamJumps, OfASmoothSurfaceVanishWithTheEdges) {
  const auto wave = [](const Eigen::Vector2d& p) {
    return Eigen::Vector3d(p(0), p(1), 0.01 * std::sin(30 * p(0) + 20 * p(1) + 0.5));
  };
  const SeamJumps coarse = jumps_of(seamed(40, wave)), fine = jumps_of(seamed(80, wave));
  EXPECT_LT(fine.rms.position, coarse.rms.position / 6);      // third order: 8
  EXPECT_LT(fine.rms.angle, coarse.rms.angle / 3);            // second: 4
  EXPECT_LT(fine.rms.curvature, coarse.rms.curvature / 1.8);  // first: 2
  EXPECT_LT(fine.rms.position, 0.003 * 0.0025);               // of an edge
}

TEST(SeamJumps, WithoutASeamAreNone) {
  Seamed s = seamed(10, sheets::flat);
  s.marked.assign(s.marked.size(), 1);
  EXPECT_EQ(jumps_of(s).places, 0);
  EXPECT_EQ(jumps_of(s).largest.position, 0);
  s.marked.pop_back();
  EXPECT_THROW(jumps_of(s), Error);
}

}  // namespace
}  // namespace geoprior
