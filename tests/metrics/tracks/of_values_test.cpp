#include "metrics/tracks/of_values.h"

#include <gtest/gtest.h>

#include "metrics/spacing/plane_spectrum.h"
#include "metrics/volume/wave_modes.h"

namespace geoprior {
namespace {

TEST(OfValues, AreAbsentOfNothing) {
  EXPECT_FALSE(percentile_of({}, 50));
  EXPECT_FALSE(largest_of(Eigen::VectorXd(0)));
}

TEST(OfValues, AreThoseOfSortedValues) {
  EXPECT_EQ(percentile_of({7}, 99), 7);
  EXPECT_EQ(percentile_of({3, 1, 2}, 50), 2);
  EXPECT_EQ(percentile_of({4, 3, 1, 2}, 50), 3) << "the upper median";
  EXPECT_EQ(percentile_of({4, 3, 1, 2}, 0), 1);
  EXPECT_EQ(percentile_of({4, 3, 1, 2}, 75), 4);
  EXPECT_EQ(largest_of(Eigen::Vector3d(-3, -1, -2)), -1);
}

// What looked at the first or the largest of none.
TEST(MeasuresOfNothing, AreAbsentOrRefused) {
  EXPECT_FALSE(fills_rectangle(TriMesh{}));
  const Eigen::MatrixXcd none(0, 0);
  EXPECT_EQ(dispersion_error(none, none, none, 1, {}).modes, 0);
}

}  // namespace
}  // namespace geoprior
