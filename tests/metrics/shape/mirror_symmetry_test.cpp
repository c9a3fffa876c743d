#include "metrics/shape/mirror_symmetry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

TEST(MirrorSymmetry, OfASphereAboutAnyPlaneThroughItsCentre) {
  // Only the mesh is not symmetric about this plane: farthest apart is a sagitta.
  const TriMesh sphere = shapes::sphere(1, {1, 2, 3}, 4);
  const MirrorSymmetry m = mirror_symmetry(sphere, {1, 2, 3}, {1, 2, 5}, 0.1);
  EXPECT_GT(m.hausdorff, 0);
  EXPECT_LT(m.hausdorff, 0.01);
  EXPECT_LE(m.rms, m.hausdorff);
  // About a plane of symmetry of the mesh itself: round-off.
  EXPECT_LT(mirror_symmetry(sphere, {1, 2, 3}, {0, -3, 0}, 0.1).hausdorff, 1e-12);
}

TEST(MirrorSymmetry, APlaneThatIsOffAddsTwiceThat) {
  // A plate stood off by d from the plane is 2 d from its image, everywhere.
  TriMesh plate = sheets::rectangle(1, 1, 5, 5, 0.2).mesh();
  plate.V.col(2).setConstant(0.03);
  const MirrorSymmetry m = mirror_symmetry(plate, {7, 7, 0}, {0, 0, 2}, 0.1);
  EXPECT_NEAR(m.hausdorff, 0.06, 1e-14);
  EXPECT_NEAR(m.rms, 0.06, 1e-14);
}

TEST(MirrorSymmetry, OfATiltedPlateInClosedForm) {
  // z = t x on |x| <= 1/2 and its image z = -t x: a point is |x| sin(2 a) / cos(a) = 2 |x| sin(a)
  // from the other plane, tan a = t; the foot is on the plate but near its ends.
  TriMesh plate = sheets::rectangle(1, 1, 40, 4).mesh();
  const double t = 0.1, sine = t / std::sqrt(1 + t * t);
  plate.V.col(2) = t * plate.V.col(0);
  const MirrorSymmetry m = mirror_symmetry(plate, {0, 0, 0}, {0, 0, 1}, 0.01);
  EXPECT_NEAR(m.hausdorff, sine, 1e-12);  // its end, above whose foot the image goes on
  EXPECT_NEAR(m.rms, 2 * sine / std::sqrt(12.0), 1e-4);
}

TEST(MirrorSymmetry, RefusesAPlaneWithoutANormal) {
  EXPECT_THROW(mirror_symmetry(sheets::rectangle(1, 1, 1, 1).mesh(), {0, 0, 0}, {0, 0, 0}, 0.1),
               Error);
}

}  // namespace
}  // namespace geoprior
