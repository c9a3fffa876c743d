#include "solvers/fluid/features/base_surface.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/core/geometry/shapes.h"
#include "tests/fluid/features/map_waves.h"

namespace geoprior::fluid {
namespace {

using waves::tank;

std::vector<char> within(const TriMesh& mesh, const Eigen::Vector2d& centre, double radius) {
  std::vector<char> inside;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const bool near = (mesh.V.row(v).head<2>().transpose() - centre).norm() < radius;
    inside.push_back(near && mesh.V(v, 2) > -0.4 ? 1 : 0);
  }
  return inside;
}

TEST(BaseSurface, APlaneIsItsOwnBed) {
  // The cotangent Laplacian has linear precision: coordinates of a plane are biharmonic.
  const TriMesh mesh = tank(30, 1, 0.5, 0.2);
  const Eigen::MatrixX3d bed = base_under(mesh, within(mesh, {0.5, 0.5}, 0.3));
  EXPECT_LT((bed - mesh.V).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(BaseSurface, AHillLeavesTheTiltedPlaneItStandsOn) {
  TriMesh mesh = tank(40, 1, 0.5, 0.2);
  const TriMesh flat = mesh;
  const auto inside = within(mesh, {0.5, 0.5}, 0.3);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    const Eigen::Index i = v;
    const double tilt = 0.3 * mesh.V(i, 0) + 0.1 * mesh.V(i, 1);
    if (mesh.V(i, 2) > -0.4) mesh.V(i, 2) += tilt;
    if (inside[v] != 0) mesh.V(i, 2) += 0.1;
  }
  const Eigen::MatrixX3d bed = base_under(mesh, inside);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    const Eigen::Index i = v;
    if (inside[v] == 0) {
      EXPECT_EQ(bed.row(i), mesh.V.row(i));
      continue;
    }
    // In-plane coordinates slide with the hill's steep side; the plane is met exactly.
    EXPECT_NEAR(bed(i, 2), 0.3 * bed(i, 0) + 0.1 * bed(i, 1), 1e-11);
  }
}

TEST(BaseSurface, KeepsBiharmonicHeights) {
  // z = x^2 - 3 y^2 + x y is biharmonic; on a fine regular grid the discrete bed follows it.
  TriMesh mesh = shapes::square(60);
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const double x = mesh.V(v, 0) - 0.5, y = mesh.V(v, 1) - 0.5;
    mesh.V(v, 2) = 0.05 * (x * x - 3 * y * y + x * y);
  }
  const Eigen::MatrixX3d bed = base_under(mesh, within(mesh, {0.5, 0.5}, 0.25));
  // Heights over the region span 0.012; the surface's own metric is that of the plane to 1 %.
  EXPECT_LT((bed - mesh.V).cwiseAbs().maxCoeff(), 2e-4);
}

TEST(BaseSurface, MovesWithRigidMotions) {
  TriMesh mesh = tank(24, 1, 0.5, 0.2);
  const auto inside = within(mesh, {0.5, 0.5}, 0.3);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (inside[v] != 0) mesh.V(v, 2) += 0.05;
  }
  const Eigen::Isometry3d motion = Eigen::Translation3d(3, -2, 5) *
                                   Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized());
  TriMesh moved = mesh;
  moved.V = (mesh.V * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  const Eigen::MatrixX3d bed = base_under(mesh, inside);
  const Eigen::MatrixX3d expected =
      (bed * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  EXPECT_LT((base_under(moved, inside) - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(BaseSurface, UnfoldsWhatIsMuchLongerThanItsBed) {
  // A column four times as high as it is wide: its biharmonic bed folds over, the unfolded one does
  // not (harmonic coordinates of a round region with positive weights: Tutte).
  TriMesh mesh = tank(60, 1, 0.5, 0);
  const auto inside = within(mesh, {0.5, 0.5}, 0.3);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    const Eigen::Index i = v;
    const double r = (mesh.V.row(i).head<2>() - Eigen::RowVector2d(0.5, 0.5)).norm();
    if (inside[v] != 0) mesh.V(i, 2) += 1.2 * (0.5 - 0.5 * std::tanh((r - 0.15) / 0.02));
  }
  const auto upside_down = [&](const Eigen::MatrixX3d& V) {
    int count = 0;
    for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
      if (inside[mesh.F(t, 0)] == 0) continue;
      const Eigen::Vector3d a = V.row(mesh.F(t, 0)), b = V.row(mesh.F(t, 1)),
                            c = V.row(mesh.F(t, 2));
      count += (b - a).cross(c - a).z() <= 0 ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(upside_down(base_under(mesh, inside)), 0);
  EXPECT_EQ(upside_down(unfolded_base(mesh, inside)), 0);
}

TEST(BaseSurface, RefusesARegionWithoutABed) {
  const TriMesh sphere = shapes::sphere(2);
  const std::vector<char> all(sphere.vertex_count(), 1);
  try {
    base_under(sphere, all);
    FAIL() << "a closed component has nothing that holds it";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("vertex 0"), std::string::npos) << error.what();
  }
  EXPECT_THROW(base_under(sphere, {1, 0}), Error);
}

TEST(BaseSurface, HoldsTheBorderOfAnOpenMesh) {
  TriMesh mesh = shapes::square(20);
  std::vector<char> inside(mesh.vertex_count(), 0);
  for (std::size_t v = 0; v < inside.size(); ++v) {
    inside[v] = mesh.V(v, 0) < 0.5 ? 1 : 0;
  }
  const Eigen::MatrixX3d bed = base_under(mesh, inside);
  EXPECT_LT((bed - mesh.V).cwiseAbs().maxCoeff(), 1e-11);  // a plane, up to its border
}

}  // namespace
}  // namespace geoprior::fluid
