#include "models/sketch/ridges/drawn_ridges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "models/sketch/drawing/align_views.h"
#include "models/sketch/sketch_process.h"
#include "solvers/sketch/several_views.h"
#include "tests/sketch/surface/drawn_solids.h"

namespace geoprior::sketch {
namespace {

double length_of(const std::vector<Edge>& edges, const Eigen::MatrixX3d& V) {
  double length = 0;
  for (const auto& [a, b] : edges) length += (V.row(a) - V.row(b)).norm();
  return length;
}

Drawing drawn_box(bool from_top) {
  Drawing box = solids::drawn_box(0.3, 0.2, 0.1);
  if (from_top) box.views.push_back(View{ViewKind::top, {solids::rectangle(0.3, 0.1)}});
  return box;
}

TEST(DrawnRidges, OfABoxAreThoseThatAViewSeesAsCorners) {
  const VisualHull two = visual_hull(align_views(drawn_box(false)), {2000});
  EXPECT_NEAR(length_of(edges_of(drawn_ridges(two)), two.mesh.V), 4 * (0.3 + 0.1), 1e-9);
  const VisualHull three = visual_hull(align_views(drawn_box(true)), {2000});
  EXPECT_NEAR(length_of(edges_of(drawn_ridges(three)), three.mesh.V), 4 * (0.3 + 0.2 + 0.1), 1e-9);
}

/// Of all points the largest distance from the box's surface.
double off_box(const Eigen::MatrixX3d& X) {
  const Eigen::Array3d half(0.15, 0.1, 0.05), middle(0, 0.1, 0);
  double most = 0;
  for (Eigen::Index v = 0; v < X.rows(); ++v) {
    const Eigen::Array3d out = (X.row(v).transpose().array() - middle).abs() - half;
    most = std::max({most, out.maxCoeff(), -out.maxCoeff()});
  }
  return most;
}

TEST(DrawnRidges, KeepABoxAsItIs) {
  SketchInput input;
  input.drawing = drawn_box(true);
  input.hull.triangles = 2000;
  const PreparedSketch prepared = prepare_sketch(input);
  EXPECT_LT(off_box(prepared.start), 1e-12);
  const std::unique_ptr<SketchMethod> method = make_several_views(prepared, {});
  RunContext context;
  for (int i = 0; i < 10; ++i) {
    method->step(context);
    EXPECT_LT(off_box(method->positions()), 1e-12) << i;
  }
}

// From the front and the side a cylinder's caps have corners, which go into the depth only as far
// as the caps are flat: round ones touch them in points.
TEST(DrawnRidges, OfARoundThingAreNone) {
  Drawing cylinder = solids::drawn_cylinder(0.2, 0.3, 180);
  const VisualHull hull = visual_hull(align_views(cylinder), {4000});
  EXPECT_LT(length_of(edges_of(drawn_ridges(hull)), hull.mesh.V), 0.1);
}

}  // namespace
}  // namespace geoprior::sketch
