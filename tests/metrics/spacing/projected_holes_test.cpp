#include "metrics/spacing/projected_holes.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "metrics/shape/silhouette.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

TriMesh bars(std::initializer_list<std::array<double, 4>> rectangles) {
  TriMesh all;
  for (const auto& [x0, y0, x1, y1] : rectangles) {
    const TriMesh bar = shapes::box({x0, y0, 0}, {x1, y1, 0.1});
    all = all.V.rows() == 0 ? bar : shapes::together(all, bar);
  }
  return all;
}

double iou_with_square(const TriMesh& mesh) {
  const PlanarLoop square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  return silhouette_match(mesh, Eigen::Matrix3d::Identity(), {&square, 1}).iou;
}

// A frame of width 1 about a hole of 2 x 2 covers 12 of 16.
TEST(ProjectedHoles, TheWindowOfAFrameIsFilled) {
  const TriMesh frame = bars({{0, 0, 4, 1}, {0, 3, 4, 4}, {0, 0.5, 1, 3.5}, {3, 0.5, 4, 3.5}});
  EXPECT_NEAR(iou_with_square(frame), 0.75, 1e-6);
  const TriMesh filled = with_filled_holes(frame, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(iou_with_square(filled), 1, 1e-6);
  const PlanarLoop square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_LT(silhouette_match(filled, Eigen::Matrix3d::Identity(), {&square, 1}).hausdorff, 1e-6);
}

TEST(ProjectedHoles, ABayThatOpensToTheOutsideIsNone) {
  const TriMesh bay = bars({{0, 0, 4, 1}, {0, 0.5, 1, 4}, {3, 0.5, 4, 4}});
  const TriMesh same = with_filled_holes(bay, Eigen::Matrix3d::Identity());
  EXPECT_EQ(same.F.rows(), bay.F.rows());
  EXPECT_THROW(with_filled_holes(bay, Eigen::Matrix3d::Identity(), 1), Error);
}

}  // namespace
}  // namespace geoprior
