#include "metrics/shape/roughness.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/geometry/procedural.h"
#include "metrics/developability/bend_side.h"
#include "tests/metrics/motions.h"

namespace geoprior {
namespace {

using std::numbers::pi;

/// Equilateral triangles of edge h in the plane z = 0: `n` x `n` vertices, rows along x.
TriMesh hexagonal_patch(int n, double h) {
  TriMesh m;
  m.V.resize(n * n, 3);
  m.F.resize(2 * (n - 1) * (n - 1), 3);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int v = j * n + i;
      m.V.row(v) << h * (i + 0.5 * j), h * std::sqrt(0.75) * j, 0;
      if (i == n - 1 || j == n - 1) continue;
      const int t = 2 * (j * (n - 1) + i);
      m.F.row(t) << v, v + 1, v + n;
      m.F.row(t + 1) << v + 1, v + n + 1, v + n;
    }
  }
  return m;
}

/// An open tube of radius 1 and length 8 along x, and the same bent smoothly by 1 rad.
struct BentTube {
  explicit BentTube(int around) : segments(around), rings(around) {
    const int rows = rings + 1;
    rest.V.resize(rows * segments, 3);
    posed.resize(rows * segments, 3);
    rest.F.resize(2 * rings * segments, 3);
    for (int i = 0; i < rows; ++i) {
      const Section bent = section(8.0 * i / rings - 4);
      for (int j = 0; j < segments; ++j) {
        const double x = 8.0 * i / rings - 4;
        const double angle = 2 * pi * j / segments;
        rest.V.row(id(i, j)) << x, std::cos(angle), std::sin(angle);
        const double y = std::cos(angle), z = std::sin(angle);
        posed.row(id(i, j)) << bent.along + z * std::sin(bent.angle), y,
            z * std::cos(bent.angle) - bent.down;
        if (i == rings) continue;
        const int t = 2 * (i * segments + j);
        rest.F.row(t) << id(i, j), id(i + 1, j + 1), id(i + 1, j);
        rest.F.row(t + 1) << id(i, j), id(i, j + 1), id(i + 1, j + 1);
      }
    }
  }
  [[nodiscard]] int id(int i, int j) const { return i * segments + j % segments; }
  /// The axis becomes an arc whose curvature rises from 0 at the ends to its largest in the middle:
  /// place of the axis and angle of the section at x.
  struct Section {
    double along = 0, down = 0, angle = 0;
  };
  static Section section(double x) {
    const auto angle = [](double at) {
      return (at + 4) / 8 - std::sin(2 * pi * (at + 4) / 8) / (2 * pi);
    };
    const int steps = 4000;  // of the integral along the axis: far finer than what is measured
    Section s{0, 0, angle(x)};
    for (int k = 0; k < steps; ++k) {
      const double turn = angle(-4 + (x + 4) * (k + 0.5) / steps);
      s.along += std::cos(turn) * (x + 4) / steps;
      s.down += std::sin(turn) * (x + 4) / steps;
    }
    return s;
  }
  /// A ridge around the middle of the tube: a tent of the given height, 0.5 wide to either side.
  void add_ridge(double height) {
    const Eigen::MatrixX3d normals = vertex_normals({posed, rest.F});
    for (Eigen::Index v = 0; v < posed.rows(); ++v) {
      posed.row(v) += height * std::max(1 - std::abs(rest.V(v, 0)) / 0.5, 0.0) * normals.row(v);
    }
  }
  /// The vertex on top of the middle ring pulled out along its normal.
  void add_bump(double height) {
    const int v = id(rings / 2, segments / 4);
    posed.row(v) += height * vertex_normals({posed, rest.F}).row(v);
  }
  [[nodiscard]] RoughnessSummary summary() const {
    const Roughness roughness(rest);
    return summarize(roughness, roughness.folds(posed), roughness.lumps(posed)).value();
  }

  int segments, rings;
  TriMesh rest;
  Eigen::MatrixX3d posed;
};

constexpr int kResolutions[] = {32, 64, 128};

TEST(Roughness, OfARigidMotionIsZero) {
  BentTube tube(32);
  const Eigen::Affine3d T =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(2, Eigen::Vector3d(1, 1, 0).normalized());
  for (Eigen::Index v = 0; v < tube.posed.rows(); ++v) {
    tube.posed.row(v) = (T * tube.rest.V.row(v).transpose().eval()).transpose();
  }
  EXPECT_NEAR(tube.summary().fold_max, 0, 1e-12);
  EXPECT_NEAR(tube.summary().lump_max, 0, 1e-12);
}

TEST(Roughness, OfASmoothBendFallsWithTheEdges) {
  // Folds as h; lumps, the second difference of what falls as h^2, as h^4.
  for (const int n : {32, 64}) {
    const RoughnessSummary coarse = BentTube(n).summary();
    const RoughnessSummary fine = BentTube(2 * n).summary();
    EXPECT_NEAR(std::log2(coarse.fold_max / fine.fold_max), 1, 0.2) << n;
    EXPECT_NEAR(std::log2(coarse.fold_p95 / fine.fold_p95), 1, 0.2) << n;
    EXPECT_GT(std::log2(coarse.lump_max / fine.lump_max), 2.8) << n;
    EXPECT_GT(std::log2(coarse.lump_rms / fine.lump_rms), 2.8) << n;
  }
  EXPECT_LT(BentTube(128).summary().fold_max, 2 * pi / 180);
  EXPECT_LT(BentTube(128).summary().lump_max, 1e-5);
}

TEST(Roughness, OfACreaseIsItsAngleAtAnyResolution) {
  // On the inner side the tube is shortened by 1/4, its curvature in the middle times its radius.
  const double angle = 2 * std::atan(0.05 / (0.5 * 0.75));
  for (const int n : kResolutions) {
    BentTube tube(n);
    const double smooth = tube.summary().fold_max;
    tube.add_ridge(0.05);
    EXPECT_NEAR(tube.summary().fold_max, angle, 1.5 * smooth) << n;
  }
}

TEST(Roughness, OfOneVertexPulledOutIsSevenSixthsOfItsHeightOnATube) {
  for (const int n : kResolutions) {
    for (const double height : {0.01, 0.05}) {
      BentTube tube(n);
      const double smooth = tube.summary().lump_max;
      tube.add_bump(height);
      // The normals of the neighbours tilt, by height / edge: cosine of their part.
      EXPECT_NEAR(tube.summary().lump_max, 7.0 / 6 * height, smooth + 0.1 * height) << n;
    }
  }
}

TEST(Roughness, OfABumpOfFixedWidthStandsOutAtAnyResolution) {
  // A height of 0.1 over a width of 0.5: its curvature, 0.8, is three times that of the bend.
  for (const int n : kResolutions) {
    BentTube tube(n);
    const RoughnessSummary smooth = tube.summary();
    const Eigen::MatrixX3d normals = vertex_normals({tube.posed, tube.rest.F});
    const Eigen::RowVector3d top(0, 0, 1);
    for (Eigen::Index v = 0; v < tube.posed.rows(); ++v) {
      const double r2 = (tube.rest.V.row(v) - top).squaredNorm();
      tube.posed.row(v) += 0.1 * std::exp(-r2 / (2 * 0.25)) * normals.row(v);
    }
    EXPECT_GT(tube.summary().fold_max, 1.5 * smooth.fold_max) << n;
    EXPECT_GT(tube.summary().lump_max, 3 * smooth.lump_max) << n;
  }
}

TEST(Roughness, OnARegularPatchFollowsClosedForms) {
  const int n = 21;
  const double h = 0.25;
  const TriMesh flat = hexagonal_patch(n, h);
  const Roughness roughness(flat);
  const int middle = n / 2 * n + n / 2;
  Eigen::MatrixX3d bump = flat.V;
  bump(middle, 2) = 1e-4;  // tilts by 1e-4 / h: cosines are 1 to 1e-7
  EXPECT_NEAR(roughness.lumps(bump)(middle), 7.0 / 6 * 1e-4, 1e-10);

  const double angle = 0.4;
  Eigen::MatrixX3d crease = flat.V;
  const double y0 = flat.V(middle, 1);
  for (Eigen::Index v = 0; v < crease.rows(); ++v) {
    const double y = flat.V(v, 1) - y0;
    crease(v, 1) = y0 + std::cos(angle / 2) * y;
    crease(v, 2) = -std::sin(angle / 2) * std::abs(y);
  }
  const Eigen::VectorXd folds = roughness.folds(crease);
  EXPECT_NEAR(folds(*roughness.edges().find(middle, middle + 1)), angle, 1e-12);
  EXPECT_NEAR(folds(*roughness.edges().find(middle, middle + n)), 0, 1e-12);
  EXPECT_NEAR(roughness.lumps(crease)(middle), 2 * h * std::sin(angle / 2) / std::sqrt(27), 1e-12);
}

TEST(Roughness, PercentilesAreByRestArea) {
  // Rows of the patch from the tenth on are pleated by 0.2: their edges along x fold. Those are a
  // third of the edges on half of the area.
  const int n = 21;
  const TriMesh flat = hexagonal_patch(n, 1);
  const Roughness roughness(flat);
  Eigen::MatrixX3d pleated = flat.V;
  const double row_height = std::sqrt(0.75);
  for (int v = 0; v < flat.vertex_count(); ++v) {
    const int row = v / n;
    if (row <= 10) continue;
    pleated(v, 1) = flat.V(10 * n, 1) + (row - 10) * row_height * std::cos(0.1);
    pleated(v, 2) = row % 2 == 1 ? row_height * std::sin(0.1) : 0;
  }
  const auto s = summarize(roughness, roughness.folds(pleated), roughness.lumps(pleated)).value();
  EXPECT_NEAR(s.fold_p50, 0, 1e-12);
  EXPECT_NEAR(s.fold_p95, 0.2, 1e-12);
  EXPECT_NEAR(s.fold_max, 0.2, 1e-12);
  // The smooth half alone has none, whatever lies beside it.
  std::vector<int> smooth(9 * n);
  for (int v = 0; v < 9 * n; ++v) smooth[v] = v;
  const auto part =
      summarize(roughness, roughness.folds(pleated), roughness.lumps(pleated), smooth).value();
  EXPECT_NEAR(part.fold_max, 0, 1e-12);
  EXPECT_NEAR(part.lump_max, 0, 1e-12);
}

TEST(Roughness, ATurnThroughIsNoSmallChange) {
  // Two triangles folded almost shut one way and the other: nearly a whole turn apart.
  TriMesh hinge;
  hinge.V.resize(4, 3);
  hinge.V << 0, 0, 0, 1, 0, 0, 0.5, std::cos(3.0), std::sin(3.0), 0.5, -1, 0;
  hinge.F.resize(2, 3);
  hinge.F << 0, 1, 2, 1, 0, 3;
  Eigen::MatrixX3d posed = hinge.V;
  posed(2, 2) = -posed(2, 2);
  const Roughness roughness(hinge);
  EXPECT_NEAR(roughness.folds(posed)(*roughness.edges().find(0, 1)), 6, 1e-12);
}

TEST(Roughness, LeavesOutBordersAndTrianglesWithoutArea) {
  const TriMesh flat = hexagonal_patch(5, 1);
  const Roughness roughness(flat);
  EXPECT_TRUE(std::isnan(roughness.folds(flat.V)(*roughness.edges().find(0, 1))));
  // A vertex that falls onto its neighbour takes the area of two triangles.
  Eigen::MatrixX3d collapsed = flat.V;
  collapsed.row(12) = collapsed.row(13);
  EXPECT_EQ(roughness.folds(collapsed)(*roughness.edges().find(12, 17)), pi);
  // The same at rest: no measure.
  const Roughness degenerate({collapsed, flat.F});
  EXPECT_TRUE(std::isnan(degenerate.folds(flat.V)(*degenerate.edges().find(12, 17))));
  EXPECT_THROW((void)roughness.folds(flat.V.topRows(3)), Error);
  EXPECT_THROW((void)roughness.lumps(flat.V.topRows(3)), Error);
  const Eigen::VectorXd folds = roughness.folds(flat.V), lumps = roughness.lumps(flat.V);
  EXPECT_FALSE(summarize(roughness, folds, lumps, {0, 1}).has_value());
}

TEST(BendSide, OfABentTubeIsAwayFromTheBend) {
  // Flexion about +y carries +x towards -z: the outside is +z; extension turns it round.
  const RiggedMesh rig = two_bone_cylinder();
  const Eigen::Vector3d flexion(0, 1, 0);
  const JointRegion region = make_joint_region(rig, "joint", {1}, {flexion});
  for (const double angle : {0.8, -0.8}) {
    const std::vector<int> outer =
        outer_vertices(region, rig.mesh.F, rig.mesh.V, motions::turned(angle, flexion));
    EXPECT_FALSE(outer.empty());
    for (const int v : outer) EXPECT_GT(rig.mesh.V(v, 2) * angle, 0);
  }
  const JointRegion twisted =
      make_joint_region(rig, "joint", {1}, {Eigen::Vector3d::UnitX().eval()});
  EXPECT_TRUE(outer_vertices(twisted, rig.mesh.F, rig.mesh.V, rest_pose(2)).empty());
}

}  // namespace
}  // namespace geoprior
