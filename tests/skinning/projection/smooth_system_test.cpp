#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "core/geometry/procedural.h"
#include "core/geometry/topology.h"
#include "core/random.h"
#include "models/skinning/surface_diffusion.h"
#include "solvers/skinning/smooth/system.h"
#include "tests/skinning/fixtures.h"

namespace geoprior::skinning {
namespace {

constexpr double kRadius = 0.05;
constexpr double kCutoff = 2.5;
constexpr double kAnchor = 0.02;

/// A tube, half of whose vertices are asked to move.
struct Asked {
  RiggedMesh rig = two_bone_cylinder(fixtures::fine_cylinder_options(24, 30));
  SkinState state{rig, one_rings(rig.mesh.F, rig.mesh.vertex_count()),
                  std::vector<int>(rig.mesh.vertex_count(), 0)};
  std::vector<float> radius = std::vector<float>(state.size(), static_cast<float>(kRadius));
  std::vector<Demand> demands = std::vector<Demand>(state.size());
  std::vector<Float4> u = std::vector<Float4>(state.size());

  Asked() {
    RandomStream random(1, "demands");
    for (std::size_t s = 0; s < state.size(); ++s) {
      const Eigen::Vector3d at = rig.mesh.V.row(state.vertex[s]);
      if (at.x() < 0) continue;
      const Eigen::Vector3d n =
          Eigen::Vector3d(0.3 * random.uniform(), at.y(), at.z()).normalized();
      const Eigen::Vector3f way = n.cast<float>();
      demands[s].direction = Float4{way.x(), way.y(), way.z(), 0};
      demands[s].amount = static_cast<float>(0.004 * random.uniform());
      demands[s].weight = static_cast<float>(random.uniform());
    }
  }

  /// The minimiser of what smooth/system.h states, by a dense factorisation.
  [[nodiscard]] Eigen::VectorXd exact() const {
    const Eigen::Index n = state.size();
    const Eigen::MatrixXd L(positive_cotangent_laplacian(rig.mesh));
    const Eigen::VectorXd A = vertex_areas(rig.mesh);
    const double kappa = std::pow(kCutoff / 7.85, 4) * std::pow(kRadius, 4);
    const Eigen::MatrixXd bend = kappa * L.transpose() * A.cwiseInverse().asDiagonal() * L;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(3 * n);
    for (int k = 0; k < 3; ++k) {
      K.block(k * n, k * n, n, n) = bend;
      K.block(k * n, k * n, n, n).diagonal() += kAnchor * A;
    }
    for (std::size_t s = 0; s < state.size(); ++s) {
      const Demand& demand = demands[s];
      const Eigen::Index v = state.vertex[s];
      for (int k = 0; k < 3; ++k) {
        const double along = A(v) * static_cast<double>(demand.weight * demand.direction[k]);
        b(k * n + v) += along * static_cast<double>(demand.amount);
        for (int l = 0; l < 3; ++l)
          K(k * n + v, l * n + v) += along * static_cast<double>(demand.direction[l]);
      }
    }
    return K.llt().solve(b);
  }

  /// Root mean square of the difference from `exact`, over that of `exact`.
  [[nodiscard]] double error(const Eigen::VectorXd& exact) const {
    const Eigen::Index n = state.size();
    double sum = 0;
    for (std::size_t s = 0; s < state.size(); ++s) {
      for (int k = 0; k < 3; ++k) {
        const double off = static_cast<double>(u[s][k]) - exact(k * n + state.vertex[s]);
        sum += off * off;
      }
    }
    return std::sqrt(sum / exact.squaredNorm());
  }
};

TEST(SmoothSystem, SolvesWhatItStates) {
  Asked asked;
  const Eigen::VectorXd exact = asked.exact();
  SmoothSystem system(asked.rig.mesh, asked.state, asked.radius);
  const SmoothSystem::Options few{kCutoff, kAnchor, 6};
  std::vector<int> all(asked.state.block_count());
  std::iota(all.begin(), all.end(), 0);
  system.open(all);
  system.solve(asked.demands, few, asked.u);
  EXPECT_LE(asked.error(exact), 0.12) << "the coarse level and six steps, of noise";
  // From there, as often as it takes.
  for (int i = 0; i < 20; ++i) system.solve(asked.demands, {kCutoff, kAnchor, 50}, asked.u);
  EXPECT_LE(asked.error(exact), 0.01);
  system.close(asked.u);
  EXPECT_NEAR(asked.error(exact), 1, 1e-12) << "closed blocks stand still";
}

TEST(SmoothSystem, OpensWhatIsNearADemandAlone) {
  Asked asked;
  std::fill(asked.demands.begin(), asked.demands.end(), Demand{});
  SmoothSystem system(asked.rig.mesh, asked.state, asked.radius);
  const SmoothSystem::Options options{0.3, 1, 6};
  system.open(asked.demands, options);
  EXPECT_TRUE(system.open_blocks().empty());
  EXPECT_EQ(system.solve(asked.demands, options, asked.u), 0);
  asked.demands[0].direction = Float4{0, 0, 1, 0};
  asked.demands[0].amount = 0.001F;
  asked.demands[0].weight = 1;
  system.open(asked.demands, options);
  EXPECT_LT(system.open_blocks().size(), asked.state.block_count() / 2);
  EXPECT_EQ(system.open_blocks().front(), 0);
}

}  // namespace
}  // namespace geoprior::skinning
