#include "metrics/spacing/plane_spectrum.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/error.h"

namespace geoprior {
namespace {

/// Two triangles on the corners (0, 0), (3, 0), (3, 2), (0, 2), moved by `shift`.
TriMesh rectangle(const Eigen::RowVector3d& shift) {
  TriMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0, 0, 0, 3, 0, 0, 3, 2, 0, 0, 2, 0;
  mesh.V.rowwise() += shift;
  mesh.F.resize(2, 3);
  mesh.F << 0, 1, 2, 0, 2, 3;
  return mesh;
}

TEST(FillsRectangle, OnlyFlatAndWithSidesAlongTheAxes) {
  EXPECT_TRUE(fills_rectangle(rectangle({5, -1, 2})));
  TriMesh lifted = rectangle({0, 0, 0});
  lifted.V(2, 2) = 1e-6;
  EXPECT_FALSE(fills_rectangle(lifted));
  TriMesh sheared = rectangle({0, 0, 0});
  sheared.V(2, 0) += 0.01;
  sheared.V(3, 0) += 0.01;
  EXPECT_FALSE(fills_rectangle(sheared));
}

// The grid of spacing 1/2 has its lowest spots at the frequency 2 along either axis: 1 cycle a
// spacing. Where the rectangle lies does not matter, nor which triangle holds a place.
TEST(PlaneSpectrum, IsThatOfThePlacesInTheRectangle) {
  const TriMesh mesh = rectangle({-7, 4, 1});
  std::vector<SurfacePoint> places;
  Eigen::MatrixX2d points(24, 2);
  for (int k = 0; k < 24; ++k) {
    const double x = 0.25 + 0.5 * (k % 6), y = 0.25 + 0.5 * (k / 6);
    points.row(k) << x, y;
    // Coordinates in (0, 0), (3, 0), (3, 2) below the diagonal, in (0, 0), (3, 2), (0, 2) above.
    const double u = x / 3, v = y / 2;
    places.push_back(u >= v ? SurfacePoint{0, {1 - u, u - v, v}}
                            : SurfacePoint{1, {1 - v, u, v - u}});
  }
  const RadialSpectrum is = plane_spectrum(mesh, places, 0.5);
  const RadialSpectrum expected = radial_spectrum(points, {0, 0}, {3, 2}, 0.5);
  EXPECT_LT((is.power - expected.power).cwiseAbs().maxCoeff(), 1e-9 * expected.power.maxCoeff());
  const auto one = static_cast<Eigen::Index>(1 / is.step + 1e-9);
  Eigen::Index first = 0;
  while (is.power(first) < 1e-6) ++first;
  EXPECT_EQ(first, one);
}

// Bins of middles 0.5, 1.5, 2.5 with 1, 3 and 10 frequencies: (1 x 0.2 + 3 x 0.6) / 4 below 2.
TEST(MeanElongation, CountsFrequenciesBelowTheHighest) {
  RadialSpectrum spectrum;
  spectrum.frequency = Eigen::Vector3d(0.5, 1.5, 2.5);
  spectrum.count = Eigen::Vector3i(1, 3, 10);
  spectrum.elongation = Eigen::Vector3d(0.2, 0.6, 1);
  EXPECT_NEAR(mean_elongation(spectrum, 2), 0.5, 1e-15);
  EXPECT_NEAR(mean_elongation(spectrum, 9), 12. / 14, 1e-15);
  EXPECT_THROW(mean_elongation(spectrum, 0.5), Error);
}

}  // namespace
}  // namespace geoprior
