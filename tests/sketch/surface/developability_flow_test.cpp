#include "baselines/sketch/developability_flow.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sketch/surface/flow_shapes.h"

namespace geoprior::sketch {
namespace {

TEST(HingeEnergy, IsTheMetricsSum) {
  for (const TriMesh& mesh :
       {flow_shapes::bumpy_sphere(3), flow_shapes::noisy(flow_shapes::cone(), 0.01)}) {
    HingeEnergy energy(mesh.F, mesh.vertex_count());
    EXPECT_NEAR(energy(mesh.V, nullptr), hinge_energy(mesh).sum(), 1e-12);
  }
}

TEST(HingeEnergy, HasTheGradientOfItsDifferences) {
  // Closed and open; central differences with a step of 1e-5 are exact to about 1e-9.
  for (const TriMesh& mesh :
       {flow_shapes::noisy(flow_shapes::bumpy_sphere(1), 0.05),
        flow_shapes::noisy(flow_shapes::frustum(0.5, 0.3, 0.6, 8, 4), 0.05)}) {
    HingeEnergy energy(mesh.F, mesh.vertex_count());
    EXPECT_LT(flow_shapes::gradient_error(energy, mesh.V, 1e-5), 1e-6);
  }
}

TEST(DevelopabilityFlow, LeavesDevelopableSurfaces) {
  for (const TriMesh& mesh : {flow_shapes::cylinder(), flow_shapes::cone(), flow_shapes::tent()}) {
    for (const bool fixed : {true, false}) {
      DevelopabilityFlowOptions options;
      options.descent.fixed_border = fixed;
      DevelopabilityFlow flow(mesh, options);
      EXPECT_LT(flow.energy(), 1e-12);
      for (int i = 0; i < 20; ++i) flow.step();
      EXPECT_LT(flow_shapes::sum_of_defects(flow.surface()),
                flow_shapes::sum_of_defects(mesh) + 1e-3);
      EXPECT_LT((flow.surface().V - mesh.V).cwiseAbs().maxCoeff(), 1e-4);
    }
  }
}

TEST(DevelopabilityFlow, TakesNoiseOffACylinder) {
  const TriMesh mesh = flow_shapes::noisy(flow_shapes::cylinder(), 0.002);
  DevelopabilityFlow flow(mesh);
  const double start = flow.energy();
  for (int i = 0; i < 100; ++i) flow.step();
  EXPECT_LT(flow.energy(), start / 50);
}

TEST(DevelopabilityFlow, FallsMonotonicallyOnABumpySphereWithoutSpoilingTriangles) {
  DevelopabilityFlow flow(flow_shapes::bumpy_sphere(3));
  double last = hinge_energy(flow.surface()).sum();
  const double start = last;
  for (int i = 0; i < 60; ++i) {
    const Eigen::MatrixX3d before = triangle_normals(flow.surface());
    flow.step();
    const double now = hinge_energy(flow.surface()).sum();
    EXPECT_LE(now, last * (1 + 1e-14)) << i;
    last = now;
    const Eigen::MatrixX3d after = triangle_normals(flow.surface());
    EXPECT_GT(before.cwiseProduct(after).rowwise().sum().minCoeff(), std::sqrt(0.5) - 1e-12) << i;
  }
  EXPECT_LT(last, 0.3 * start);
}

TEST(DevelopabilityFlow, HoldsTheBorderOrNot) {
  const TriMesh mesh = flow_shapes::noisy(flow_shapes::cone(), 0.005, true);
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  for (const bool fixed : {true, false}) {
    DevelopabilityFlowOptions options;
    options.descent.fixed_border = fixed;
    DevelopabilityFlow flow(mesh, options);
    for (int i = 0; i < 5; ++i) flow.step();
    double moved = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
      if (border[v]) moved += (flow.surface().V.row(v) - mesh.V.row(v)).norm();
    EXPECT_EQ(moved == 0, fixed);
  }
}

TEST(DevelopabilityFlow, EveryMetricLeadsDown) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(2);
  for (const DescentMetric metric :
       {DescentMetric::flat, DescentMetric::laplacian, DescentMetric::bilaplacian}) {
    for (const int memory : {0, 10}) {
      DevelopabilityFlowOptions options;
      options.descent.metric = metric;
      options.descent.memory = memory;
      DevelopabilityFlow flow(mesh, options);
      const double start = flow.energy();
      for (int i = 0; i < 30; ++i) flow.step();
      EXPECT_LT(flow.energy(), 0.8 * start);
    }
  }
}

TEST(DevelopabilityFlow, HasTheSameBytesAtAnyThreadCount) {
  const TriMesh mesh = flow_shapes::bumpy_sphere(4);
  EXPECT_TRUE(flow_shapes::same_bytes(flow_shapes::after_steps<DevelopabilityFlow>(mesh, 8, 1),
                                      flow_shapes::after_steps<DevelopabilityFlow>(mesh, 8, 2)));
}

TEST(DevelopabilityFlow, RefusesADegenerateTriangle) {
  TriMesh mesh = flow_shapes::bumpy_sphere(1);
  mesh.V.row(mesh.F(3, 0)) = mesh.V.row(mesh.F(3, 1));
  EXPECT_THROW(DevelopabilityFlow{mesh}, Error);
}

}  // namespace
}  // namespace geoprior::sketch
