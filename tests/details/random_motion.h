#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "core/mesh.h"
#include "core/random.h"
#include "models/details/mesh.h"

namespace geoprior::details::detail_scenes {

/// A surface that wanders: every frame a random axis is stretched or squeezed a little, with a
/// falloff around a random point; a pull to the rest shape keeps it from wandering off.
class RandomMotion {
 public:
  RandomMotion(const TriMesh& rest, std::uint64_t seed)
      : rest_(rest.V), now_(rest.V), random_(seed, "motion") {}

  const Eigen::MatrixX3d& next() {
    const auto pick = random_.below(static_cast<std::uint32_t>(now_.rows()));
    const Eigen::RowVector3d centre = now_.row(pick);
    Eigen::RowVector3d axis(random_.normal(), random_.normal(), random_.normal());
    axis.normalize();
    const double amount = 0.12 * (2 * random_.uniform() - 1), radius = 0.3 + random_.uniform();
    for (Eigen::Index v = 0; v < now_.rows(); ++v) {
      const Eigen::RowVector3d d = now_.row(v) - centre;
      const double fall = std::exp(-d.squaredNorm() / (radius * radius));
      now_.row(v) += amount * fall * d.dot(axis) * axis;
    }
    now_ += 0.03 * (rest_ - now_);
    return now_;
  }

 private:
  Eigen::MatrixX3d rest_, now_;
  RandomStream random_;
};

/// Sites and M_d fit each other; M_d is Delaunay, a manifold, and has the topology of the surface.
inline void expect_invariants(const DetailMesh& d, int frame) {
  const TriangulationReport report = d.mesh.check();
  ASSERT_TRUE(report.manifold()) << "frame " << frame;
  ASSERT_EQ(report.not_delaunay, 0) << "frame " << frame << ", " << report.worst_angle_sum;
  ASSERT_EQ(report.blocked, 0) << "frame " << frame;
  ASSERT_EQ(report.euler, d.surface->euler) << "frame " << frame;
  for (int i = 0; i < d.site_slots(); ++i) {
    const Detail& site = d.site[i];
    ASSERT_EQ(d.mesh.vertex_alive(i), d.kind[i] != SiteKind::empty);
    if (!d.is_detail(i)) continue;
    ASSERT_GE(site.weight, 0);
    ASSERT_LE(site.weight, 1);
    ASSERT_GE(site.at.barycentric.minCoeff(), 0);
    ASSERT_NEAR(site.at.barycentric.sum(), 1, 1e-9);
  }
}

}  // namespace geoprior::details::detail_scenes
