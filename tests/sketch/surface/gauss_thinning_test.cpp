#include "baselines/sketch/gauss_thinning/gauss_thinning.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sketch/surface/flow_shapes.h"

namespace geoprior::sketch {
namespace {

TEST(GaussThinning, LeavesCylindersAndFolds) {
  for (const TriMesh& mesh : {flow_shapes::cylinder(), flow_shapes::tent()}) {
    GaussThinning flow(mesh);
    for (int i = 0; i < 50; ++i) flow.step();
    EXPECT_EQ(flow.iterations(), 50);
    EXPECT_LT(flow_shapes::sum_of_defects(flow.surface()),
              flow_shapes::sum_of_defects(mesh) + 1e-9);
  }
}

TEST(GaussThinning, BendsAConeWhoseNormalsTraceASmallCircle) {
  // No great circle holds the normals of a cone: the method's own limit, here on one of 14 degrees.
  const TriMesh mesh = flow_shapes::cone();
  GaussThinning flow(mesh);
  for (int i = 0; i < 50; ++i) flow.step();
  const double rise =
      flow_shapes::sum_of_defects(flow.surface()) - flow_shapes::sum_of_defects(mesh);
  EXPECT_GT(rise, 0.1);
  EXPECT_LT(rise, 0.6);
  EXPECT_LT(hinge_energy(flow.surface()).sum(), 0.03);
}

TEST(GaussThinning, TakesTheHingeEnergyOffANoisyCylinder) {
  const TriMesh mesh = flow_shapes::noisy(flow_shapes::cylinder(), 0.002, true);
  GaussThinning flow(mesh);
  for (int i = 0; i < 100; ++i) flow.step();
  EXPECT_LT(hinge_energy(flow.surface()).sum(), hinge_energy(mesh).sum() / 10);
}

TEST(GaussThinning, ThinsTheGaussImageOfABumpySphere) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(4);
  GaussThinning flow(mesh);
  double last = hinge_energy(mesh).sum();
  const double start = last;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 10; ++i) flow.step();
    const double now = hinge_energy(flow.surface()).sum();
    EXPECT_LT(now, last) << round;
    last = now;
  }
  for (int i = 0; i < 50; ++i) flow.step();  // the cone is narrow by now: creases sharpen
  EXPECT_LT(hinge_energy(flow.surface()).sum(), 0.5 * start);
  EXPECT_GT(gauss_image_thinness(flow.surface(), 0.01), 2 * gauss_image_thinness(mesh, 0.01));
}

TEST(GaussThinning, ShrinksItsConeToTheFinalAngle) {
  GaussThinningOptions options;
  options.shrink = 0.5;
  GaussThinning flow(flow_shapes::bumpy_sphere(2), options);
  for (const double degrees : {25.0, 12.5, 6.25, 3.125, 2.5, 2.5}) {
    EXPECT_EQ(flow.cone_angle_deg(), degrees);
    flow.step();
  }
}

TEST(GaussThinning, NeighbourhoodsGrowWithTheRadius) {
  // Without a radius: the triangle and all that share a vertex with it; 13 where all vertices have
  // six neighbours.
  const TriMesh torus = ::geoprior::shapes::torus(2, 0.7, 24, 16);
  GaussThinningOptions options;
  options.radius = 0;
  const GaussThinning ring(torus, options);
  EXPECT_EQ(ring.neighbour_count(), 13U * static_cast<unsigned>(torus.triangle_count()));
  options.radius = 0.2;
  EXPECT_GT(GaussThinning(torus, options).neighbour_count(), 2 * ring.neighbour_count());
}

TEST(GaussThinning, HasTheSameBytesAtAnyThreadCount) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(4);
  EXPECT_TRUE(flow_shapes::same_bytes(flow_shapes::after_steps<GaussThinning>(mesh, 8, 1),
                                      flow_shapes::after_steps<GaussThinning>(mesh, 8, 2)));
}

TEST(GaussThinning, RefusesOptionsOutOfBounds) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(1);
  const auto refuses = [&](GaussThinningOptions options) {
    EXPECT_THROW((GaussThinning{mesh, options}), Error);
  };
  refuses({.radius = -1});
  refuses({.start_angle_deg = 0});
  refuses({.start_angle_deg = 2, .final_angle_deg = 3});
  refuses({.shrink = 1.5});
}

}  // namespace
}  // namespace geoprior::sketch
