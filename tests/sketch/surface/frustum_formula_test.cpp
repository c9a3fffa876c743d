#include "baselines/sketch/frustum_formula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "experiments/sketch/truth/synthetic_views.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

// Two circles drawn without noise: D / tan phi is the truth, h cos phi.
TEST(FrustumFormula, IsExactForADrawingWithoutNoise) {
  const SyntheticViewOptions options;
  const SyntheticView drawn = synthetic_view(options);
  const auto circles = frustum_formula(drawn.view, {});
  ASSERT_EQ(circles.size(), 2U);
  EXPECT_NEAR(circles[0].radius, options.radius, 1e-8);
  EXPECT_NEAR(circles[1].radius, options.top_radius, 1e-8);
  EXPECT_NEAR((circles[1].centre - circles[0].centre - options.height * drawn.axis).norm(), 0,
              1e-7);
}

// The other reading has the picture of the first, and depths of the other sign.
TEST(FrustumFormula, ReadingMirrorsDepth) {
  const SyntheticView drawn = synthetic_view({});
  const auto towards = frustum_formula(drawn.view, {});
  const auto away = frustum_formula(drawn.view, {.reading = FrustumReading::away});
  EXPECT_GT(towards[1].centre.z(), 0.1);
  EXPECT_EQ(towards[1].centre.z(), -away[1].centre.z());
}

TEST(FrustumFormula, WantsTwoCircles) {
  SyntheticView drawn = synthetic_view({});
  drawn.view.strokes.erase(drawn.view.strokes.begin());
  EXPECT_THAT(test::error_of([&] { frustum_formula(drawn.view, {}); }),
              ::testing::HasSubstr("has 1 circles"));
}

}  // namespace
}  // namespace geoprior::sketch
