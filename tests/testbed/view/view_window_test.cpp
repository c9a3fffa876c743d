// The window of a picture: what it holds and where it looks from.

#include "testbed/view/view_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/testbed/fake_run.h"
#include "tests/testbed/run_fixture.h"
#include "tests/testbed/view/views.h"

namespace geoprior {
namespace {

using testing::HasSubstr;

TEST(ViewWindow, HoldsEveryPointAndIsOrthonormal) {
  const Part a = make_box({0, 0, 0}, {1, 2, 3});
  const Part b = make_box({-2, 0.5, 0}, {-1, 1, 1});
  FigureView view;
  view.direction = {1, 0.5, 2};
  const ViewWindow window = fit_window({&a, &b}, view);
  Eigen::Matrix3d axes;
  axes << window.right, window.up, window.direction;
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  for (const Part* part : {&a, &b}) {
    for (Eigen::Index i = 0; i < part->points.rows(); ++i) {
      const Eigen::Vector3d p = part->points.row(i).transpose() - window.center;
      EXPECT_LE(std::abs(p.dot(window.right)), window.width_m / 2);
      EXPECT_LE(std::abs(p.dot(window.up)), window.height_m / 2);
      EXPECT_LE(std::abs(p.dot(window.direction)), window.depth_m);
    }
  }
}

TEST(ViewWindow, DirectionAlongUpIsAnError) {
  const Part part = make_box({0, 0, 0}, {1, 1, 1});
  FigureView view;
  view.direction = {0, 2, 0};
  EXPECT_THAT(test::error_of([&] { fit_window({&part}, view); }),
              HasSubstr("figure_view.direction"));
}

TEST(ViewWindow, SectionLooksAlongTheNormalAtThePlane) {
  SectionView section;
  section.origin = {3, 0, 0};
  section.normal = {-1, 0, 0};
  ViewWindow window = front_window();
  window.direction = Eigen::Vector3d(1, 0, 1).normalized();
  const ViewWindow plane = section_window(window, section);
  EXPECT_LT((plane.direction - Eigen::Vector3d::UnitX()).norm(), 1e-12);  // towards the eye
  EXPECT_NEAR(plane.center.x(), 3, 1e-12);
  EXPECT_NEAR(plane.center.z(), window.center.z(), 1e-12);
}

}  // namespace
}  // namespace geoprior
