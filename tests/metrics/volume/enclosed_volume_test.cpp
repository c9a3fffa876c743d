#include "metrics/volume/enclosed_volume.h"

#include <gtest/gtest.h>

#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

TEST(EnclosedVolume, IsThatOfABoxAndAbsentOnceATriangleIsMissing) {
  TriMesh box = shapes::box({0, 0, 0}, {1, 2, 3});
  EXPECT_NEAR(enclosed_volume(box).value(), 6, 1e-14);
  EXPECT_NEAR(enclosed_volume(shapes::inverted(box)).value(), -6, 1e-14);
  box.F.conservativeResize(box.F.rows() - 1, 3);
  EXPECT_FALSE(enclosed_volume(box));
  EXPECT_FALSE(enclosed_volume(TriMesh{}));
}

TEST(LargestDrift, IsRelativeToTheFirstVolume) {
  EXPECT_DOUBLE_EQ(largest_drift({2.0, 2.5, 1.0}).value(), 0.5);
  EXPECT_DOUBLE_EQ(largest_drift({2.0}).value(), 0);
  EXPECT_FALSE(largest_drift({2.0, std::nullopt}));
  EXPECT_FALSE(largest_drift({0.0, 1.0}));
  EXPECT_FALSE(largest_drift({}));
}

}  // namespace
}  // namespace geoprior
