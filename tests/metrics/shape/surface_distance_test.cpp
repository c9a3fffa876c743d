#include "metrics/shape/surface_distance.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

TEST(HausdorffDistance, OfShiftedPlanes) {
  const TriMesh plane = sheets::rectangle(1, 1, 5, 5).mesh();
  TriMesh other = sheets::rectangle(1, 1, 3, 4, 0.2).mesh();
  other.V.col(2).array() += 0.07;
  EXPECT_NEAR(hausdorff_distance(plane, other, 0.05), 0.07, 1e-15);
  // Slid along itself, the border is what is away.
  other.V.col(2).setZero();
  other.V.col(0).array() += 0.2;
  EXPECT_NEAR(hausdorff_distance(plane, other, 0.05), 0.2, 1e-15);
  EXPECT_EQ(hausdorff_distance(plane, plane, 0.05), 0);
}

TEST(HausdorffDistance, OfConcentricSpheres) {
  // Inscribed polyhedra: farthest is a vertex of the outer from a face centre of the inner, which
  // lies below the sphere by up to its sagitta.
  const TriMesh inner = shapes::sphere(0.8, {0, 0, 0}, 4);
  const TriMesh outer = shapes::sphere(1, {0, 0, 0}, 5);
  const double distance = hausdorff_distance(inner, outer, 0.1);
  EXPECT_GT(distance, 0.2 - 1e-12);
  EXPECT_LT(distance, 0.2 + 0.004);  // sagitta of an edge of 0.12 at radius 0.8: 0.0023
}

TEST(HausdorffDistance, IsSymmetricThoughEachWayIsNot) {
  // A corner of the plane against a small plane inside it: one way 0, the other the diagonal.
  const TriMesh plane = sheets::rectangle(1, 1, 2, 2).mesh();
  const TriMesh inside = sheets::rectangle(0.2, 0.2, 2, 2).mesh();
  const double gap = 0.4 * std::sqrt(2.0);
  EXPECT_NEAR(hausdorff_distance(plane, inside, 0.05), gap, 1e-15);
  EXPECT_NEAR(hausdorff_distance(inside, plane, 0.05), gap, 1e-15);
}

TEST(HausdorffDistance, SeesTheMiddleOfALargeTriangle) {
  // No vertex of either is away from the other; the hole of the ring is inside the base.
  TriMesh base;
  base.V.resize(4, 3);
  base.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  base.F.resize(2, 3);
  base.F << 0, 1, 2, 0, 2, 3;
  TriMesh ring;  // the square without its inner part [0.3, 0.7]^2
  ring.V.resize(8, 3);
  ring.V << base.V, 0.3, 0.3, 0, 0.7, 0.3, 0, 0.7, 0.7, 0, 0.3, 0.7, 0;
  ring.F.resize(8, 3);
  ring.F << 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7;
  // The centre of the square is 0.2 from the ring; sampled every 0.01.
  EXPECT_NEAR(hausdorff_distance(base, ring, 0.01), 0.2, 0.01);
  EXPECT_LE(hausdorff_distance(base, ring, 0.01), 0.2 + 1e-12);
}

TEST(HausdorffDistance, RefusesWhatItCannotMeasure) {
  const TriMesh plane = sheets::rectangle(1, 1, 2, 2).mesh();
  EXPECT_THROW(hausdorff_distance(plane, TriMesh{}, 0.1), Error);
  EXPECT_THROW(hausdorff_distance(plane, plane, 0), Error);
  TriMesh broken = plane;
  broken.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(hausdorff_distance(broken, plane, 0.1), Error);
}

TEST(SurfaceDeviation, OfTiltedPlanesIsTheAnalyticMean) {
  // Plane z = 0 against z = x / 10 on [-1/2, 1/2] (the centred rectangle): the distance from (x, y,
  // 0) is |x| / sqrt(101), so mean 1/4 and RMS 1 / (2 sqrt 3) of 1 / sqrt(101).
  const TriMesh plane = sheets::rectangle(1, 1, 4, 4).mesh();
  TriMesh tilted = sheets::rectangle(2, 2, 4, 4).mesh();
  const Eigen::RowVector3d middle =
      (plane.V.colwise().minCoeff() + plane.V.colwise().maxCoeff()) / 2;
  const Eigen::RowVector3d other =
      (tilted.V.colwise().minCoeff() + tilted.V.colwise().maxCoeff()) / 2;
  tilted.V.rowwise() += middle - other;
  tilted.V.col(2) = (tilted.V.col(0).array() - middle.x()) / 10;
  const SurfaceDeviation d = surface_deviation(plane, tilted, 0.01);
  EXPECT_NEAR(d.mean, 0.25 / std::sqrt(101.0), 1e-4);
  EXPECT_NEAR(d.rms, 1 / (2 * std::sqrt(3.0)) / std::sqrt(101.0), 1e-4);
  EXPECT_LE(d.max, 0.5 / std::sqrt(101.0) + 1e-12);
}

TEST(SurfaceDeviation, TrianglesInCommonCountWithDistanceZero) {
  // Half of a square is lifted by 0.1 m as a whole: the RMS of 0 and 0.1 in equal parts, however
  // the triangles that stayed are numbered.
  const TriMesh square = sheets::rectangle(1, 1, 2, 2).mesh();
  TriMesh a, b;
  a.V.resize(12, 3);
  a.V << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0,  //
      3, 0, 0, 4, 0, 0, 4, 1, 0, 3, 0, 0, 4, 1, 0, 3, 1, 0;
  a.F.resize(4, 3);
  a.F << 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11;
  b = a;
  b.V.bottomRows(6).col(2).setConstant(0.1);
  b.F.row(0) << 2, 0, 1;
  b.F.row(1).swap(b.F.row(3));
  const SurfaceDeviation d = surface_deviation(a, b, 0.05);
  EXPECT_NEAR(d.rms, 0.1 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(d.mean, 0.05, 1e-12);
  EXPECT_NEAR(d.max, 0.1, 1e-12);
  EXPECT_EQ(surface_deviation(square, square, 0.05).max, 0);
}

TEST(SurfaceDeviation, MutualIsTheLargerOfBothWays) {
  // A square and half of it: from the half nothing is missing, from the whole half of it is.
  const TriMesh whole = sheets::rectangle(2, 1, 4, 2).mesh();
  TriMesh half = sheets::rectangle(1, 1, 2, 2).mesh();
  half.V.col(0).array() -= 0.5;
  EXPECT_LT(surface_deviation(half, whole, 0.05).max, 1e-12);
  const SurfaceDeviation far = surface_deviation(whole, half, 0.05),
                         mutual = mutual_deviation(half, whole, 0.05);
  EXPECT_EQ(mutual.rms, far.rms);
  EXPECT_EQ(mutual.mean, far.mean);
  EXPECT_EQ(mutual.max, far.max);
  EXPECT_NEAR(mutual.mean, 0.25, 0.01);  // 0 … 1 over one half, 0 over the other
}

TEST(LargestDistance, OfPointsIsThatOfTheFarthest) {
  const TriMesh square = sheets::rectangle(1, 1, 2, 2).mesh();
  Eigen::MatrixX3d points(3, 3);
  points << 0.1, 0.2, 0.3, 0.5, 0.5, 0, 0.8, 0.9, 0;
  EXPECT_NEAR(largest_distance(points, square), 0.5, 1e-12);  // (0.3, 0.4) beyond the corner
  EXPECT_EQ(largest_distance(Eigen::MatrixX3d(0, 3), square), 0);
}

}  // namespace
}  // namespace geoprior
