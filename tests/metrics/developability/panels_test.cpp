#include "metrics/developability/panels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "metrics/developability/developability.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

TEST(PanelImages, OfASphereBesideACylinderAreWeighedByArea) {
  // A cylinder has a great circle, thinness 0; a sphere none, thinness 1.
  const TriMesh cylinder =
      sheets::mapped(sheets::rectangle(0.3, 0.2, 24, 6), sheets::cylinder(0.06)).mesh();
  const TriMesh both = shapes::together(cylinder, shapes::sphere(0.1, {1, 0, 0}, 4));
  std::vector<std::vector<int>> panels(2);
  panels[0].resize(cylinder.triangle_count());
  std::iota(panels[0].begin(), panels[0].end(), 0);
  panels[1].resize(both.triangle_count() - cylinder.triangle_count());
  std::iota(panels[1].begin(), panels[1].end(), cylinder.triangle_count());
  const double bent = panel_area(both, panels[0]), round = panel_area(both, panels[1]);
  EXPECT_NEAR(bent, 0.06, 1e-3 * 0.06);                       // 0.3 x 0.2
  EXPECT_NEAR(round, 0.04 * std::numbers::pi, 5e-3 * round);  // 4 pi r^2
  const PanelImages images = panel_images(both, panels);
  EXPECT_NEAR(images.great_circle_thinness, round / (bent + round), 1e-9);
  EXPECT_NEAR(images.small_circle_thinness, round / (bent + round), 1e-9);
  const GaussImage sphere = gauss_image(both, panels[1]);
  EXPECT_NEAR(images.circle_rms,
              std::min(sphere.great_circle_rms, sphere.small_circle_rms) * round / (bent + round),
              1e-7);
  EXPECT_THROW(panel_images(both, {}), Error);
}

}  // namespace
}  // namespace geoprior
