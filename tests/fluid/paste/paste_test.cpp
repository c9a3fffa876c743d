#include "solvers/fluid/paste/paste.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "solvers/fluid/lift/exponential_map.h"
#include "tests/core/geometry/shapes.h"
#include "tests/fluid/features/map_waves.h"

namespace geoprior::fluid {
namespace {

using namespace waves;

Labelled source(const Eigen::Affine3d& placed = Eigen::Affine3d::Identity(),
                const Hill& h = {.velocity = {1, 0}}) {
  return labelled(tank(40, 2, 1, 0.25), 41 * 41, hill(h), 5, 0.04, 0.05, placed);
}

/// A map made by formula: a Gaussian hill of height A and width 0.1 m on a map of 1 m.
Feature formula_hill(double height, int frames = 1) {
  Feature feature;
  feature.id = 2;
  feature.resolution = 64;
  feature.extent = 1;
  for (int f = 0; f < frames; ++f) {
    feature.times.push_back(0.1 * f);
    feature.placement.push_back(Eigen::Isometry3d::Identity());
    MapFrame map;
    map.displacement = Eigen::MatrixX3f::Zero(64 * 64, 3);
    map.alpha = Eigen::VectorXf::Zero(64 * 64);
    for (int k = 0; k < 64 * 64; ++k) {
      const double u = (k % 64 + 0.5) / 64 - 0.5, v = (k / 64 + 0.5) / 64 - 0.5;
      const double r = std::hypot(u, v) / 0.1;
      map.alpha[k] = r < 4.5 ? 1 : 0;
      map.displacement(k, 2) = static_cast<float>(height * (f + 1) * std::exp(-0.5 * r * r));
    }
    feature.maps.push_back(map);
    feature.area.push_back(0.2);
  }
  return feature;
}

/// Insertion of a feature somewhere at time 0.
Insertion at(const Feature& feature, double x, double y, double z = 0,
             const std::string& name = "hill") {
  Insertion insertion{&feature, {}};
  insertion.edit.name = name;
  insertion.edit.move = {x, y, z};
  return insertion;
}

SurfaceFrame still_frame(const TriMesh& mesh) {
  SurfaceFrame frame;
  frame.mesh = mesh;
  return frame;
}

TriMesh moved(const TriMesh& mesh, const Eigen::Isometry3d& motion) {
  TriMesh result = mesh;
  result.V = (mesh.V * motion.linear().transpose()).rowwise() + motion.translation().transpose();
  return result;
}

TEST(Paste, PutsTheFormulaOntoAPlane) {
  const Feature f = formula_hill(0.05);
  const SurfaceFrame target = still_frame(tank(40, 2, 1, 0.25));
  const SurfaceFrame out = paste(target, {at(f, 1.1, 0.9)}, 0, kUp, {});
  for (Eigen::Index v = 0; v < 41 * 41; ++v) {
    const double r = std::hypot(out.mesh.V(v, 0) - 1.1, out.mesh.V(v, 1) - 0.9) / 0.1;
    if (r > 4.2) continue;
    // Catmull-Rom on texels of 1/6.4 of the width: error below 1e-3 of the height.
    EXPECT_NEAR(out.mesh.V(v, 2), 0.05 * std::exp(-0.5 * r * r), 5e-5);
  }
  // The floor under the map and the sides stay.
  for (Eigen::Index v = 41 * 41; v < 2 * 41 * 41; ++v) {
    EXPECT_EQ(out.mesh.V.row(v), target.mesh.V.row(v));
  }
}

TEST(Paste, KeepsAClosedManifoldClosedAndCountsItsVolume) {
  const Feature f = formula_hill(0.05);
  const SurfaceFrame target = still_frame(tank(16, 2, 1, 0.25));  // edges of 8 texels
  PasteReport report;
  const SurfaceFrame out = paste(target, {at(f, 1, 1)}, 0, kUp, {}, &report);
  require_closed_manifold(out.mesh, "paste", "tank");
  EXPECT_GT(report.added_triangles, 1000);
  EXPECT_EQ(out.mesh.triangle_count(), target.mesh.triangle_count() + report.added_triangles);
  // Splitting changes neither surface nor volume, so the volume is that of the hill:
  // 2 pi sigma^2 A up to the triangles' facets and the cut at 4.5 sigma.
  EXPECT_NEAR(report.added_volume, 2 * std::numbers::pi * 0.01 * 0.05,
              0.01 * 2 * std::numbers::pi * 0.01 * 0.05);
  EXPECT_NEAR(signed_volume(out.mesh.V, out.mesh.F) - signed_volume(target.mesh.V, target.mesh.F),
              report.added_volume, 1e-12);
  EXPECT_EQ(report.min_jacobian, 1);  // heights never fold the plane
}

TEST(Paste, RefinesUntilEdgesHoldTheTexels) {
  const Feature f = formula_hill(0.0);  // flat: edges can be measured in the plane
  TriMesh two;  // two triangles of 4 m for a map of 1 m: no vertex lies under the map
  two.V.resize(4, 3);
  two.V << -2, -2, 0, 2, -2, 0, 2, 2, 0, -2, 2, 0;
  two.F.resize(2, 3);
  two.F << 0, 1, 2, 0, 2, 3;
  const SurfaceFrame out = paste(still_frame(two), {at(f, 0.2, 0.1)}, 0, kUp, {});
  const double limit = 2.0 / 64;
  for (Eigen::Index t = 0; t < out.mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector3d a = out.mesh.V.row(out.mesh.F(t, k)),
                               b = out.mesh.V.row(out.mesh.F(t, (k + 1) % 3));
      const double r = std::max((a - Eigen::RowVector3d(0.2, 0.1, 0)).norm(),
                                (b - Eigen::RowVector3d(0.2, 0.1, 0)).norm());
      if (r < 0.4) {
        EXPECT_LE((a - b).norm(), limit * (1 + 1e-12));
      }
    }
  }
  EXPECT_TRUE(non_manifold_edges(out.mesh.F).empty());
  double border = 0;  // no gap has opened: the only border is the square's
  for (const Edge& e : boundary_edges(out.mesh.F)) {
    border += (out.mesh.V.row(e[0]) - out.mesh.V.row(e[1])).norm();
  }
  EXPECT_NEAR(border, 16, 1e-9);
  EXPECT_NEAR(triangle_areas(out.mesh.V, out.mesh.F).sum(), 16, 1e-9);
}

TEST(Paste, SeveralFeaturesAddUpInAnyOrder) {
  const Feature f = formula_hill(0.05);
  const SurfaceFrame target = still_frame(tank(30, 2, 1, 0.25));
  const Insertion a = at(f, 0.9, 1, 0, "a"), b = at(f, 1.05, 1.02, 0, "b"),
                  c = at(f, 1, 0.8, 0, "c");
  const SurfaceFrame one = paste(target, {a, b, c}, 0, kUp, {});
  const SurfaceFrame two = paste(target, {c, a, b}, 0, kUp, {});
  EXPECT_EQ(one.mesh.V, two.mesh.V);  // to the last bit
  EXPECT_EQ(one.mesh.F, two.mesh.F);
  PasteOptions fixed;
  fixed.refine = false;  // same vertices: displacements can be compared
  fixed.refine_texels = 8;
  const auto shift = [&](const std::vector<Insertion>& list) -> Eigen::MatrixX3d {
    return paste(target, list, 0, kUp, fixed).mesh.V - target.mesh.V;
  };
  EXPECT_LT((shift({a, b, c}) - shift({a}) - shift({b}) - shift({c})).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Paste, WarnsOfEditsThatOverlap) {
  const Feature f = formula_hill(0.05);
  const SurfaceFrame target = still_frame(tank(30, 2, 1, 0.25));
  PasteReport report;
  paste(target, {at(f, 0.9, 1, 0, "left"), at(f, 1.1, 1, 0, "right")}, 0, kUp, {}, &report);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("'left' and 'right' overlap"), std::string::npos);
  paste(target, {at(f, 0.5, 0.5, 0, "left"), at(f, 1.5, 1.5, 0, "right")}, 0, kUp, {}, &report);
  EXPECT_TRUE(report.warnings.empty());
}

TEST(Paste, LeavesOutWhatLiesOffTheTarget) {
  const Feature f = formula_hill(0.05);
  const SurfaceFrame target = still_frame(tank(20, 2, 1, 0.25));
  PasteReport report;
  const SurfaceFrame out = paste(target, {at(f, 5, 5, 0, "lost")}, 0, kUp, {}, &report);
  EXPECT_EQ(out.mesh.V, target.mesh.V);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("edit 'lost' lies off the target"), std::string::npos);
  // Partly off is pasted as far as it goes.
  paste(target, {at(f, 2.1, 1, 0, "edge")}, 0, kUp, {}, &report);
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_GT(report.displaced_vertices, 0);
}

TEST(Paste, RefusesATargetTooCoarse) {
  const Feature f = formula_hill(0.05);
  const SurfaceFrame target = still_frame(tank(8, 2, 1, 0));  // edges of 16 texels
  PasteOptions options;
  options.refine = false;
  try {
    paste(target, {at(f, 1, 1)}, 0, kUp, options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("edges of about 0.0312 m"), std::string::npos)
        << error.what();
  }
  options.refine = true;
  options.max_triangles = 500;
  EXPECT_THROW(paste(target, {at(f, 1, 1)}, 0, kUp, options), Error);
}

TEST(Paste, VolumeLockAddsNoVolume) {
  const Feature f = formula_hill(0.05);
  TriMesh wavy = tank(40, 2, 1, 0.25);
  for (Eigen::Index v = 0; v < 41 * 41; ++v) wavy.V(v, 2) += 0.05 * std::sin(4 * wavy.V(v, 0));
  Insertion insertion = at(f, 1, 1);
  insertion.edit.volume_lock = true;
  PasteReport report;
  const SurfaceFrame out = paste(still_frame(wavy), {insertion}, 0, kUp, {}, &report);
  // The hill alone adds 3.1e-3 m^3.
  EXPECT_LT(std::abs(report.added_volume), 1e-12);
  EXPECT_NEAR(signed_volume(out.mesh.V, out.mesh.F), signed_volume(wavy.V, wavy.F), 1e-12);
  EXPECT_GT(report.displaced_vertices, 100);
}

TEST(Paste, MovesWithSourceAndTarget) {
  // Everything turned and shifted together, gravity too: the same surface, elsewhere.
  const Eigen::Isometry3d motion = Eigen::Translation3d(3, -2, 5) *
                                   Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized());
  Feature f = formula_hill(0.05);
  TriMesh wavy = tank(30, 2, 1, 0.25);
  for (Eigen::Index v = 0; v < 31 * 31; ++v) wavy.V(v, 2) += 0.05 * std::sin(4 * wavy.V(v, 0));
  f.placement[0] = Eigen::Translation3d(1, 1, 0) * Eigen::AngleAxisd(0.4, kUp);
  Feature turned = f;
  turned.placement[0] = motion * f.placement[0];
  Insertion plain = identity(f), other = identity(turned);
  for (const MappingKind mapping : {MappingKind::projection, MappingKind::exponential}) {
    PasteOptions options;
    options.mapping = mapping;
    const SurfaceFrame a = paste(still_frame(wavy), {plain}, 0, kUp, options);
    const SurfaceFrame b =
        paste(still_frame(moved(wavy, motion)), {other}, 0, motion.linear() * kUp, options);
    ASSERT_EQ(a.mesh.F, b.mesh.F);
    EXPECT_LT((moved(a.mesh, motion).V - b.mesh.V).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Paste, LiftedFeaturesMoveWithTheirSource) {
  // Maps are single precision relative to the feature: 1e-6 of its size (1 m).
  const Eigen::Isometry3d motion = Eigen::Translation3d(3, -2, 5) *
                                   Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized());
  const Labelled here = source(), there = source(Eigen::Affine3d(motion));
  const Feature a = here.lift(), b = there.lift();
  const SurfaceFrame bed = here.bed(2), other = there.bed(2);
  PasteOptions options;
  options.refine = false;
  options.refine_texels = 8;
  const auto pasted_a = paste(bed, {identity(a)}, bed.time, kUp, options);
  const auto pasted_b = paste(other, {identity(b)}, other.time, motion.linear() * kUp, options);
  EXPECT_LT((moved(pasted_a.mesh, motion).V - pasted_b.mesh.V).cwiseAbs().maxCoeff(), 2e-6);
}

TEST(Paste, MirroredMapsLieMirrored) {
  Feature f = formula_hill(0.05);
  for (int k = 0; k < 64 * 64; ++k) {  // a hill on one side only, pushed across
    if (k / 64 < 32) f.maps[0].displacement.row(k).setZero();
    f.maps[0].displacement(k, 1) = 0.5F * f.maps[0].displacement(k, 2);
  }
  const SurfaceFrame target = still_frame(tank(40, 2, 1, 0));  // symmetric about y = 1
  Insertion plain = at(f, 1, 1), mirrored = plain;
  mirrored.edit.mirror = true;
  PasteOptions options;
  options.refine = false;
  options.refine_texels = 8;
  const Eigen::MatrixX3d a = paste(target, {plain}, 0, kUp, options).mesh.V;
  const Eigen::MatrixX3d b = paste(target, {mirrored}, 0, kUp, options).mesh.V;
  for (int j = 0; j <= 40; ++j) {
    for (int i = 0; i <= 40; ++i) {
      const Eigen::RowVector3d p = a.row(j * 41 + i), q = b.row((40 - j) * 41 + i);
      EXPECT_LT((Eigen::RowVector3d(p.x(), 2 - p.y(), p.z()) - q).norm(), 1e-9);
    }
  }
  EXPECT_GT((a - b).cwiseAbs().maxCoeff(), 0.01);
}

TEST(Paste, HillsStandUprightOnABall) {
  // On a sphere of radius R the hill of a map adds its height along the normal, at geodesic
  // distances: a vertex at angle theta from the anchor is R + A exp(-(R theta / sigma)^2 / 2) from
  // the centre. The discrete exponential map meets that to the mesh's facets.
  const Feature f = formula_hill(0.05);
  TriMesh ball = shapes::sphere(5);
  const Eigen::Vector3d direction = Eigen::Vector3d(1, 0.3, 1).normalized();
  PasteOptions options;
  options.mapping = MappingKind::exponential;
  PasteReport report;
  const SurfaceFrame out =
      paste(still_frame(ball), {at(f, direction.x(), direction.y(), 2)}, 0, kUp, options, &report);
  require_closed_manifold(out.mesh, "paste", "ball");
  // The anchor is above the given point along up.
  const double z = std::sqrt(1 - direction.head<2>().squaredNorm());
  const Eigen::Vector3d anchor(direction.x(), direction.y(), z);
  double largest = 0;
  for (Eigen::Index v = 0; v < ball.V.rows(); ++v) {
    const double theta = std::acos(std::clamp(ball.V.row(v).dot(anchor), -1.0, 1.0));
    const double height = 0.05 * std::exp(-0.5 * std::pow(theta / 0.1, 2));
    if (theta > 0.4) continue;
    largest = std::max(largest, std::abs(out.mesh.V.row(v).norm() - 1 - height));
  }
  EXPECT_LT(largest, 0.05 * 0.05);  // 5 % of the height
}

TEST(Paste, ChoosesGeodesicsOnACurvedTarget) {
  const Feature f = formula_hill(0.05);
  TriMesh ball = shapes::sphere(4);
  ball.V *= 0.4;  // the map of 1 m covers far more than a cap
  const auto run = [&](MappingKind kind) {
    PasteOptions options;
    options.mapping = kind;
    return paste(still_frame(ball), {at(f, 0.1, 0, 0.5)}, 0, kUp, options).mesh;
  };
  EXPECT_EQ(run(MappingKind::automatic).V, run(MappingKind::exponential).V);
  const TriMesh plane = tank(30, 2, 1, 0.25);
  PasteOptions automatic, projection;
  projection.mapping = MappingKind::projection;
  EXPECT_EQ(paste(still_frame(plane), {at(f, 1, 1)}, 0, kUp, automatic).mesh.V,
            paste(still_frame(plane), {at(f, 1, 1)}, 0, kUp, projection).mesh.V);
}

TEST(ExponentialMap, UnrollsACylinder) {
  // A cylinder is developable: coordinates are arc length and height.
  const int rings = 60, around = 120;
  std::vector<Eigen::Vector3d> x;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j <= rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const double a = 2 * std::numbers::pi * i / around;
      x.emplace_back(std::cos(a), std::sin(a), 3.0 * j / rings - 1.5);
    }
  }
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around;
      triangles.push_back({a, b, b + around});
      triangles.push_back({a, b + around, a + around});
    }
  }
  const int triangle = 2 * (rings / 2 * around);  // at angle 0, height 0
  Eigen::Matrix3d axes;                           // u around, v up, normal outwards
  axes.col(0) = Eigen::Vector3d::UnitY();
  axes.col(1) = Eigen::Vector3d::UnitZ();
  axes.col(2) = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d anchor = x[triangles[triangle][0]];
  const ExponentialMap map = exponential_map(x, triangles, triangle, anchor, axes, 1.2);
  double largest = 0;
  for (std::size_t i = 0; i < map.vertices.size(); ++i) {
    const Eigen::Vector3d& p = x[map.vertices[i]];
    const Eigen::Vector2d truth(std::atan2(p.y(), p.x()), p.z());
    if (truth.norm() > 1) continue;
    largest = std::max(largest, (map.uv[i] - truth).norm());
    EXPECT_NEAR(map.axes[i].determinant(), 1, 1e-9);
  }
  EXPECT_LT(largest, 0.01);  // 1 % of the radius reached, edges of 0.05
}

TEST(Paste, VelocityIsTheRateOfTheDisplacement) {
  // A hill that grows by its first height every 0.1 s on a target that moves with (0.2, 0, 0):
  // the map stands still, so points that pass under it rise with A f' + 0.2 df/dx.
  const Feature f = formula_hill(0.01, 5);
  SurfaceFrame target = still_frame(tank(40, 2, 1, 0.25));
  target.velocity = Eigen::MatrixX3d::Zero(target.mesh.V.rows(), 3);
  target.velocity.col(0).setConstant(0.2);
  const SurfaceFrame out = paste(target, {at(f, 1, 1)}, 0.2, kUp, {});
  ASSERT_EQ(out.velocity.rows(), out.mesh.V.rows());
  for (Eigen::Index v = 0; v < 41 * 41; ++v) {
    const Eigen::Vector2d p(target.mesh.V(v, 0) - 1, target.mesh.V(v, 1) - 1);
    if (p.norm() > 0.4) continue;
    const double g = std::exp(-0.5 * p.squaredNorm() / 0.01);
    const double rate = 0.1 * g + 0.03 * 0.2 * (-p.x() / 0.01) * g;  // height is 0.03 g at 0.2 s
    EXPECT_NEAR(out.velocity(v, 2), rate, 4e-3);
    EXPECT_NEAR(out.velocity(v, 0), 0.2, 1e-9);
  }
}

TEST(Paste, IsolatedMeshesAreInsertedOrUnited) {
  Feature drop;
  drop.id = 5;
  drop.kind = RegionKind::isolated;
  drop.times = {0, 0.1};
  drop.meshes.assign(2, shapes::sphere(3));
  for (TriMesh& m : drop.meshes) m.V *= 0.2;
  drop.placement = {Eigen::Isometry3d::Identity(),
                    Eigen::Isometry3d(Eigen::Translation3d(0, 0, -0.3))};
  SurfaceFrame target = still_frame(tank(20, 2, 1, 0.25));
  target.velocity = Eigen::MatrixX3d::Zero(target.mesh.V.rows(), 3);
  const double before = signed_volume(target.mesh.V, target.mesh.F);
  const double sphere = signed_volume(drop.meshes[0].V, drop.meshes[0].F);
  Insertion insertion = at(drop, 1, 1, 0.5);
  PasteReport report;
  SurfaceFrame out = paste(target, {insertion}, 0, kUp, {}, &report);
  EXPECT_EQ(out.mesh.triangle_count(),
            target.mesh.triangle_count() + drop.meshes[0].triangle_count());
  EXPECT_NEAR(signed_volume(out.mesh.V, out.mesh.F), before + sphere, 1e-12);
  EXPECT_NEAR(out.velocity(out.velocity.rows() - 1, 2), -3, 1e-9);  // 0.3 m in 0.1 s
  EXPECT_EQ(report.vertex_feature.back(), 5);
  EXPECT_EQ(report.vertex_feature.front(), 0);
  // United half way in: volume of tank and upper half of the sphere, one closed component.
  insertion.edit.unite = true;
  insertion.edit.move = {1, 1, 0};
  out = paste(target, {insertion}, 0, kUp, {}, &report);
  require_closed_manifold(out.mesh, "union", "tank with drop");
  EXPECT_NEAR(signed_volume(out.mesh.V, out.mesh.F), before + 0.5 * sphere, 1e-3 * sphere);
  ASSERT_EQ(static_cast<int>(report.vertex_feature.size()), out.mesh.vertex_count());
  ASSERT_EQ(out.velocity.rows(), out.mesh.V.rows());
  // An open target cannot be united: said, and inserted.
  out = paste(still_frame(shapes::square(4)), {insertion}, 0, kUp, {}, &report);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("cannot be united"), std::string::npos);
}

TEST(Paste, IsTheSameForAnyNumberOfThreads) {
  const Feature f = formula_hill(0.05, 3);
  SurfaceFrame target = still_frame(tank(60, 2, 1, 0.25));
  target.velocity = Eigen::MatrixX3d::Ones(target.mesh.V.rows(), 3);
  SurfaceFrame one, two;
  const std::vector<Insertion> list{at(f, 1, 1, 0, "a"), at(f, 1.2, 1, 0, "b")};
  with_threads(1, [&] { one = paste(target, list, 0.15, kUp, {}); });
  with_threads(2, [&] { two = paste(target, list, 0.15, kUp, {}); });
  EXPECT_EQ(one.mesh.V, two.mesh.V);
  EXPECT_EQ(one.mesh.F, two.mesh.F);
  EXPECT_EQ(one.velocity, two.velocity);
}

}  // namespace
}  // namespace geoprior::fluid
