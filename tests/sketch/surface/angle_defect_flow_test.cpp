#include "baselines/sketch/angle_defect_flow.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sketch/surface/flow_shapes.h"

namespace geoprior::sketch {
namespace {

TEST(AngleDefectEnergy, IsTheMetricsSumOfSquares) {
  for (const TriMesh& mesh :
       {flow_shapes::bumpy_sphere(3), flow_shapes::noisy(flow_shapes::cone(), 0.01)}) {
    AngleDefectEnergy energy(mesh, 0);
    EXPECT_NEAR(energy(mesh.V, nullptr), angle_defect(mesh).squaredNorm(), 1e-12);
  }
}

TEST(AngleDefectEnergy, HasTheGradientOfItsDifferences) {
  for (const TriMesh& mesh :
       {flow_shapes::noisy(flow_shapes::bumpy_sphere(1), 0.05),
        flow_shapes::noisy(flow_shapes::frustum(0.5, 0.3, 0.6, 8, 4), 0.05)}) {
    for (const double closeness : {0.0, 0.7}) {
      AngleDefectEnergy energy(mesh, closeness);
      const Eigen::MatrixX3d x = flow_shapes::noisy(mesh, 0.02).V;
      EXPECT_LT(flow_shapes::gradient_error(energy, x, 1e-5), 1e-6);
    }
  }
}

TEST(AngleDefectFlow, LeavesDevelopableSurfaces) {
  for (const TriMesh& mesh : {flow_shapes::cylinder(), flow_shapes::cone(), flow_shapes::tent()}) {
    AngleDefectFlow flow(mesh);
    EXPECT_LT(flow.energy(), 1e-20);
    for (int i = 0; i < 20; ++i) flow.step();
    EXPECT_LT(flow_shapes::sum_of_defects(flow.surface()),
              flow_shapes::sum_of_defects(mesh) + 1e-3);
  }
}

TEST(AngleDefectFlow, TakesTheDefectsOffANoisyCylinder) {
  const TriMesh mesh = flow_shapes::noisy(flow_shapes::cylinder(), 0.002);
  AngleDefectFlow flow(mesh);
  const double start = flow.energy();
  for (int i = 0; i < 100; ++i) flow.step();
  EXPECT_LT(flow.energy(), start / 1000);
  EXPECT_NEAR(flow.energy(), angle_defect(flow.surface()).squaredNorm(), 1e-12);
}

TEST(AngleDefectFlow, SpreadsTheFourPiOfAClosedSurfaceEvenly) {
  // Gauss-Bonnet: the defects add up to 4 pi, so their squares to at least (4 pi)^2 / n.
  const TriMesh mesh = flow_shapes::bumpy_sphere(3);
  const double least = std::pow(4 * std::numbers::pi, 2) / mesh.vertex_count();
  AngleDefectFlow flow(mesh);
  const double start = flow.energy();
  for (int i = 0; i < 200; ++i) flow.step();
  EXPECT_NEAR(angle_defect(flow.surface()).sum(), 4 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(flow.energy() / least, 1, 1e-6);
  EXPECT_GT(start, 1.5 * least);
}

TEST(AngleDefectFlow, ClosenessHoldsVertices) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(3);
  double last = std::numeric_limits<double>::infinity();
  for (const double closeness : {0.0, 1.0, 100.0}) {
    AngleDefectFlowOptions options;
    options.closeness = closeness;
    AngleDefectFlow flow(mesh, options);
    for (int i = 0; i < 60; ++i) flow.step();
    const double moved = (flow.surface().V - mesh.V).norm();
    EXPECT_LT(moved, 0.7 * last);
    last = moved;
  }
  AngleDefectFlowOptions options;
  options.closeness = -1;
  EXPECT_THROW((AngleDefectFlow{mesh, options}), Error);
}

TEST(AngleDefectFlow, HasTheSameBytesAtAnyThreadCount) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(4);
  EXPECT_TRUE(flow_shapes::same_bytes(flow_shapes::after_steps<AngleDefectFlow>(mesh, 8, 1),
                                      flow_shapes::after_steps<AngleDefectFlow>(mesh, 8, 2)));
}

}  // namespace
}  // namespace geoprior::sketch
