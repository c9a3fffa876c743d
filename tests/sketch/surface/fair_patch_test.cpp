#include "solvers/sketch/surface/fair_patch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/angles.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::HasSubstr;

/// Border of [-1, 1]^2 with `count` chords a side, lifted by a height.
template <class Height>
Eigen::MatrixX3d lifted_square(int count, const Height& height) {
  Eigen::MatrixX3d border(4 * count, 3);
  const Eigen::Vector2d corner[4] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int s = 0; s < 4; ++s) {
    for (int k = 0; k < count; ++k) {
      const double t = static_cast<double>(k) / count;
      const Eigen::Vector2d p = (1 - t) * corner[s] + t * corner[(s + 1) % 4];
      border.row(s * count + k) << p.x(), p.y(), height(p.x(), p.y());
    }
  }
  return border;
}

TEST(FairPatch, PlaneBorderIsFilledByItsPlane) {
  const auto plane = [](double x, double y) { return 0.3 * x - 0.7 * y + 2; };
  const TriMesh mesh = fair_patch(lifted_square(10, plane), 0.2, 5, "square");
  ASSERT_GT(mesh.vertex_count(), 80) << "has inner vertices";
  for (const auto& v : mesh.V.rowwise()) EXPECT_NEAR(v.z(), plane(v.x(), v.y()), 1e-12);
  EXPECT_NEAR(triangle_areas(mesh.V, mesh.F).sum(), 4 * std::sqrt(1 + 0.09 + 0.49), 1e-12);
}

// Scherk's minimal surface z = log(cos(a x) / cos(a y)) / a.
TEST(FairPatch, ApproachesScherksMinimalSurface) {
  const auto scherk = [](double x, double y) { return std::log(std::cos(x) / std::cos(y)); };
  double last = 0;
  for (const int count : {8, 16}) {
    const TriMesh mesh = fair_patch(lifted_square(count, scherk), 2.0 / count, 20, "Scherk");
    double worst = 0;
    for (const auto& v : mesh.V.rowwise())
      worst = std::max(worst, std::abs(v.z() - scherk(v.x(), v.y())));
    EXPECT_LT(worst, 0.02);
    if (last > 0) {
      EXPECT_LT(worst, last / 2) << "at least first order";
    }
    last = worst;
  }
  // The harmonic surface of the flat layout is another one.
  const TriMesh harmonic = fair_patch(lifted_square(16, scherk), 0.125, 0, "harmonic");
  double off = 0;
  for (const auto& v : harmonic.V.rowwise())
    off = std::max(off, std::abs(v.z() - scherk(v.x(), v.y())));
  EXPECT_GT(off, 2 * last);
}

TEST(FairPatch, RefusesABorderThatCrossesItself) {
  Eigen::MatrixX3d bow(5, 3);
  bow << 0, 0, 0, 2, 2, 0, 2, 0, 0, 0, 2, 0, -3, 1, 0;
  EXPECT_THAT(test::error_of([&] { fair_patch(bow, 0.2, 1, "panel 'bow'"); }),
              testing::AllOf(HasSubstr("crosses itself"), HasSubstr("bow")));
  EXPECT_THAT(test::error_of([&] { fair_patch(bow.topRows(2), 0.2, 1, "panel 'bow'"); }),
              HasSubstr("three points"));
}

}  // namespace
}  // namespace geoprior::sketch
