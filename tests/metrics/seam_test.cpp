#include "metrics/seam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "tests/metrics/shapes.h"

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

}  // namespace
}  // namespace geoprior
