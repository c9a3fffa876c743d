#include "models/sketch/surface/taubin.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/sketch/surface/flow_shapes.h"

namespace geoprior::sketch {
namespace {

TEST(Taubin, KeepsTheVolumeOfASphereAsItsTransferFunctionSays) {
  const TriMesh sphere = geoprior::shapes::sphere(1, {0, 0, 0}, 4);
  const double volume = signed_volume(sphere.V, sphere.F);
  // The coordinates of a sphere are nearly eigenvectors: L x = -k x, k the mean of 1 - x_i . x_j.
  const VertexGraph rings = one_rings(sphere.F, sphere.vertex_count());
  double frequency = 0;
  for (int v = 0; v < sphere.vertex_count(); ++v) {
    Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
    for (const int neighbour : rings.of(v)) mean += sphere.V.row(neighbour);
    frequency += 1 - sphere.V.row(v).dot(mean) / static_cast<double>(rings.of(v).size());
  }
  frequency /= sphere.vertex_count();
  for (const double mu : {-0.53, -0.6}) {
    TaubinOptions options;
    options.mu = mu;
    const double gain = std::pow((1 - options.lambda * frequency) * (1 - mu * frequency), 50);
    const double ratio = signed_volume(taubin_smoothed(sphere, options), sphere.F) / volume;
    EXPECT_NEAR(ratio, gain * gain * gain, 0.1 * std::abs(1 - ratio));  // k varies a little
  }
  EXPECT_NEAR(signed_volume(taubin_smoothed(sphere), sphere.F) / volume, 1, 0.035);
  TaubinOptions cotangent;
  cotangent.weight = NeighbourWeight::cotangent;
  EXPECT_NEAR(signed_volume(taubin_smoothed(sphere, cotangent), sphere.F) / volume, 1, 0.035);
}

TEST(Taubin, MultipliesAFrequencyByItsTransferFunction) {
  // On a closed ring of prisms (a torus grid) umbrella weights have plane waves for eigenvectors.
  const int n = 24, m = 18, waves = 5;
  TriMesh torus = geoprior::shapes::torus(2, 0.5, n, m);
  // Neighbours of (i, j) are (+-1, 0), (0, +-1), +-(1, 1); a wave along i has
  // -L = 1 - (4 cos(a) + 2) / 6, a = 2 pi waves / n.
  const double a = 2 * std::numbers::pi * waves / n;
  const double frequency = 1 - (4 * std::cos(a) + 2) / 6;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) torus.V.row(i * m + j).setConstant(std::cos(a * i));
  TaubinOptions options;
  options.double_steps = 3;
  const double gain = std::pow((1 - options.lambda * frequency) * (1 - options.mu * frequency), 3);
  EXPECT_LT(gain, 0.9);
  EXPECT_LT((taubin_smoothed(torus, options) - gain * torus.V).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Taubin, TakesNoiseOffASphere) {
  const TriMesh noisy = flow_shapes::noisy(geoprior::shapes::sphere(1, {0, 0, 0}, 4), 0.02);
  const auto deviation = [](const Eigen::MatrixX3d& x) {
    const Eigen::ArrayXd r = x.rowwise().norm();
    return std::sqrt((r - r.mean()).square().mean());
  };
  EXPECT_LT(deviation(taubin_smoothed(noisy)), 0.4 * deviation(noisy.V));
}

TEST(Taubin, LeavesTheBorderOrSmoothsItAlongItself) {
  const TriMesh cone = flow_shapes::noisy(flow_shapes::cone(), 0.01, true);
  const std::vector<bool> border = boundary_vertices(cone.F, cone.vertex_count());
  const Eigen::MatrixX3d fixed = taubin_smoothed(cone);
  TaubinOptions options;
  options.fixed_border = false;
  const Eigen::MatrixX3d loose = taubin_smoothed(cone, options);
  double rough = 0, smooth = 0;
  for (int v = 0; v < cone.vertex_count(); ++v) {
    if (!border[v]) continue;
    EXPECT_EQ(fixed.row(v), cone.V.row(v));
    const double z = v < 40 ? 0 : 0.6;  // the two rims
    rough += std::pow(cone.V(v, 2) - z, 2);
    smooth += std::pow(loose(v, 2) - z, 2);
  }
  EXPECT_LT(smooth, 0.3 * rough);
}

TEST(Taubin, RefusesFactorsThatDoNotMakeAFilter) {
  const TriMesh sphere = geoprior::shapes::sphere(1, {0, 0, 0}, 1);
  TaubinOptions options;
  options.mu = -0.5;
  EXPECT_THROW(taubin_smoothed(sphere, options), Error);
  options = {};
  options.lambda = 0;
  EXPECT_THROW(taubin_smoothed(sphere, options), Error);
  options = {};
  options.double_steps = -1;
  EXPECT_THROW(taubin_smoothed(sphere, options), Error);
}

}  // namespace
}  // namespace geoprior::sketch
