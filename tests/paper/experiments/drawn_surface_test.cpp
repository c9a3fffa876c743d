#include "experiments/paper/scene/drawn_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/geometry/topology.h"
#include "tests/paper/meshes.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector3d;

/// The part "surface" of a sheet that has the given shape.
Part surface_of(const ShellMesh& mesh, const Eigen::MatrixX3d& x) {
  Part part;
  part.points = x;
  part.triangles = mesh.triangles;
  part.arrays.push_back({"pattern", "m", NamedArray::On::points, mesh.pattern});
  part.arrays.push_back({"plastic_curvature", "1/m", NamedArray::On::cells,
                         Eigen::MatrixX3d::Zero(mesh.triangle_count(), 3)});
  return part;
}

/// Rulings between vertices of a sheet.
Part rulings_of(const Part& surface, const std::vector<Edge>& rulings) {
  Part part;
  part.kind = Part::Kind::lines;
  part.points.resize(2 * std::ssize(rulings), 3);
  for (int i = 0; i < std::ssize(rulings); ++i) {
    for (const int k : {0, 1}) part.points.row(2 * i + k) = surface.points.row(rulings[i][k]);
    part.lines.push_back({2 * i, 2 * i + 1});
  }
  return part;
}

CurvedSurface drawn(const Part& surface, const Part* rulings, const CurvedSampling& sampling) {
  return curved_surface({surface.points, surface.triangles}, paper_normals(surface, rulings),
                        sampling);
}

CurvedSurface drawn(const Part& surface, const Part* rulings = nullptr) {
  return drawn(surface, rulings, paper_sampling(surface));
}

/// Strips of a sheet rolled about the v axis, with the rulings between them.
struct Rolled {
  static constexpr int kStrips = 12;
  static constexpr double kWidth = 0.18, kHeight = 0.1;  // m
  double curvature = 10;                                 // 1/m
  ShellMesh mesh = meshes::ruling_strips(kStrips, kWidth, kHeight);
  Part surface, rulings;

  explicit Rolled(double kappa) : curvature(kappa) {
    surface = surface_of(mesh, meshes::rolled(mesh.pattern, kappa, 0));
    std::vector<Edge> lines;
    for (int i = 1; i < kStrips; ++i) lines.push_back({i, i + kStrips + 1});
    rulings = rulings_of(surface, lines);
  }

  /// Of the half chord of a strip (m).
  [[nodiscard]] double sagitta() const {
    return (1 - std::cos(curvature * kWidth / kStrips / 2)) / curvature;
  }

  /// Farthest of the samples between the first ruling and the last from the cylinder (m).
  [[nodiscard]] double error(const CurvedSurface& curved) const {
    double most = 0;
    for (int t = 0; t < curved.mesh.triangle_count(); ++t) {
      const int strip = curved.parent[t] / 2;
      if (strip == 0 || strip == kStrips - 1) continue;
      for (const int v : curved.mesh.F.row(t)) {
        const Vector3d p = curved.mesh.V.row(v);
        most = std::max(most, std::abs(std::hypot(p.x(), p.z() - 1 / curvature) - 1 / curvature));
      }
    }
    return most;
  }
};

// Strips of 15 mm on a radius of 100 mm: a sagitta of 0.28 mm, half of what is allowed.
TEST(DrawnSurface, ACylinderOfFewStripsIsDrawnOnTheCylinder) {
  const Rolled sheet(10);
  const CurvedSurface with = drawn(sheet.surface, &sheet.rulings);
  EXPECT_GT(with.mesh.triangle_count(), 2 * 2 * Rolled::kStrips);
  EXPECT_GT(sheet.sagitta(), 2.5e-4);
  EXPECT_LT(sheet.error(with), sheet.sagitta() / 100);
  EXPECT_NEAR(with.distance, sheet.sagitta(), 0.1 * sheet.sagitta());
  // Without rulings, as on the meshes of other methods, corners at the border lean a little.
  EXPECT_LT(sheet.error(drawn(sheet.surface)), sheet.sagitta() / 3);
}

// 25 mm of radius: strips with a sagitta of 1.1 mm.
TEST(DrawnSurface, StaysWithinHalfAMillimetreWhichItWouldLeave) {
  const Rolled sheet(40);
  EXPECT_GT(sheet.sagitta(), 1e-3);
  EXPECT_LE(drawn(sheet.surface, &sheet.rulings).distance, DrawnSurface::kFarthest);
  CurvedSampling unbounded = paper_sampling(sheet.surface);
  unbounded.farthest.reset();
  EXPECT_GT(drawn(sheet.surface, &sheet.rulings, unbounded).distance, 1e-3);
}

TEST(DrawnSurface, APlaneStaysAPlane) {
  const Eigen::AngleAxisd turn(0.7, Vector3d(1, 2, 3).normalized());
  for (const auto& [name, mesh] : meshes::every_kind()) {
    Part surface = surface_of(mesh, Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3));
    surface.points.leftCols(2) = mesh.pattern;
    surface.points = (surface.points * turn.toRotationMatrix().transpose()).eval();
    const CurvedSurface curved = drawn(surface);
    EXPECT_LT((curved.mesh.V * turn.toRotationMatrix()).col(2).cwiseAbs().maxCoeff(), 1e-14)
        << name;
    EXPECT_LT(curved.distance, 1e-14) << name;
  }
}

/// Two rows of squares of 2 cm, folded about the line between them by 40 degrees.
Part folded() {
  const ShellMesh mesh = meshes::grid(2, 4, 0.04, 0.08, false);
  Eigen::MatrixX3d x = Eigen::MatrixX3d::Zero(mesh.vertex_count(), 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const double beyond = std::max(0.0, mesh.pattern(v, 0) - 0.02), angle = 40 * kDegree;
    x.row(v) << std::min(mesh.pattern(v, 0), 0.02) + beyond * std::cos(angle), mesh.pattern(v, 1),
        beyond * std::sin(angle);
  }
  return surface_of(mesh, x);
}

// It has yielded where its rest shape folds by the same 40 degrees over the 13 mm between the
// centres of the triangles.
TEST(DrawnSurface, AFoldIsSharpWhereThePaperHasYielded) {
  Part surface = folded();
  EXPECT_GT(drawn(surface).distance, 1e-4) << "elastic: a smooth bend";
  surface.arrays[1].values.col(0).setConstant(40 * kDegree / 0.0133);
  const CurvedSurface sharp = drawn(surface);
  EXPECT_LT(sharp.distance, 1e-15);
  EXPECT_EQ(sharp.mesh.triangle_count(), surface.triangles.rows());
  EXPECT_EQ(sharp.mesh.vertex_count(), surface.points.rows() + 5) << "the fold, from both sides";
}

TEST(DrawnSurface, AFoldIsSharpWhereNoSheetOfPaperBendsSoFar) {
  Part surface = folded();
  for (int v = 0; v < surface.points.rows(); ++v) {
    const double beyond = std::max(0.0, surface.points(v, 0) - 0.02) / std::cos(40 * kDegree);
    if (beyond > 0) surface.points.row(v) << 0.02, surface.points(v, 1), beyond;
  }
  EXPECT_LT(drawn(surface).distance, 1e-15);
}

// Lips of a cut are two borders: what one does the other does not feel.
TEST(DrawnSurface, LipsAreBorders) {
  Part surface = folded();
  // Open along the fold: the triangles beyond it get vertices of their own.
  Eigen::MatrixX3d points(surface.points.rows() + 5, 3);
  Eigen::MatrixXd pattern(points.rows(), 2);
  points << surface.points, surface.points(Eigen::seqN(1, 5, 3), Eigen::all);
  pattern << surface.arrays[0].values, surface.arrays[0].values(Eigen::seqN(1, 5, 3), Eigen::all);
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    if (t % 4 < 2) continue;
    for (int& v : surface.triangles.row(t))
      if (v % 3 == 1) v = static_cast<int>(surface.points.rows()) + v / 3;
  }
  surface.points = points;
  surface.arrays[0].values = pattern;
  EXPECT_LT(drawn(surface).distance, 1e-15);
}

/// A fan of a cone with rulings from its apex to its rim.
TEST(DrawnSurface, RulingsOfAConeAreStraightFromTheApex) {
  constexpr int kSectors = 14;
  constexpr double kRadius = 0.08, kCurvature = 0.6;
  const ShellMesh mesh = meshes::fan(kSectors, kRadius, 3.0);
  const Part surface = surface_of(mesh, meshes::coned(mesh.pattern, kCurvature));
  std::vector<Edge> lines;
  for (int i = 2; i <= kSectors; ++i) lines.push_back({0, i});
  const Part rulings = rulings_of(surface, lines);
  const CurvedSurface curved = drawn(surface, &rulings);
  EXPECT_GT(curved.mesh.triangle_count(), kSectors);
  for (int t = 0; t < curved.mesh.triangle_count(); ++t) {
    if (curved.parent[t] == 0 || curved.parent[t] == kSectors - 1) continue;
    int at_apex = 0;
    for (const int v : curved.mesh.F.row(t)) {
      const Vector3d p = curved.mesh.V.row(v);
      at_apex += p.norm() == 0 ? 1 : 0;
      // On the cone z = curvature * distance from the axis; the chords leave it by 0.3 mm.
      EXPECT_NEAR(p.z(), kCurvature * std::hypot(p.x(), p.y()), 1e-5);
    }
    EXPECT_EQ(at_apex, 1);
  }
}

// A sheet of two rows that is bent across its rulings, which have a vertex in their middle: with
// one normal from end to end each half would be an S.
TEST(DrawnSurface, ARulingThatTheSheetHasBentAcrossIsDrawnAsAnyEdge) {
  ShellMesh mesh = meshes::grid(6, 2, 0.12, 0.06, false);
  // Uneven strips and rows: on even ones the weights of both rules are the same.
  mesh.pattern.col(0) = mesh.pattern.col(0).cwiseAbs2() / 0.12;
  for (int i = 0; i < 7; ++i) mesh.pattern(i + 7, 1) += 0.01 * (i % 2);
  const Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 8, std::numbers::pi / 2);
  const Part surface = surface_of(mesh, x);
  Part rulings;
  rulings.kind = Part::Kind::lines;
  rulings.points = surface.points;
  for (int i = 1; i < 6; ++i) rulings.lines.push_back({i, i + 7, i + 14});
  EXPECT_EQ(drawn(surface, &rulings).mesh.V, drawn(surface).mesh.V);
  // Bent about them it has their normals.
  const Part right = surface_of(mesh, meshes::rolled(mesh.pattern, 8, 0));
  rulings.points = right.points;
  const EdgeNormals with = paper_normals(right, &rulings), without = paper_normals(right, nullptr);
  EXPECT_GT((with.origin - without.origin).cwiseAbs().maxCoeff(), 1e-3);
}

// A wavy sheet of irregular triangles with yielded ones among them.
TEST(DrawnSurface, HasNoCracks) {
  const ShellMesh mesh = meshes::delaunay(8, 8, 0.2, 0.2);
  Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 12, 0.4);
  for (int v = 0; v < mesh.vertex_count(); ++v) x(v, 2) += 4e-3 * std::sin(5.0 * v);
  Part surface = surface_of(mesh, x);
  surface.arrays[1].values.topRows(60).col(0).setConstant(100);
  const CurvedSurface curved = drawn(surface);
  EXPECT_LE(curved.distance, DrawnSurface::kFarthest);
  const Weld weld = weld_by_position(curved.mesh);
  EXPECT_LT(weld.mesh.vertex_count(), curved.mesh.vertex_count()) << "some edges are sharp";
  EXPECT_TRUE(non_manifold_edges(weld.mesh.F).empty());
  // Each border edge is a border line still, and there is no other: a loop as long as before.
  double before = 0, after = 0;
  for (const auto& [a, b] : boundary_edges(surface.triangles))
    before += (x.row(a) - x.row(b)).norm();
  for (const auto& [a, b] : boundary_edges(weld.mesh.F))
    after += (weld.mesh.V.row(a) - weld.mesh.V.row(b)).norm();
  EXPECT_GE(after, before);
  EXPECT_LT(after, 1.05 * before);
}

TEST(DrawnSurface, IsAPartBesideTheSimulatedMeshWhichStaysAsItIs) {
  const Rolled sheet(10);
  Frame frame;
  frame.parts["surface"] = sheet.surface;
  frame.parts["rulings"] = sheet.rulings;
  Eigen::MatrixXd kind = Eigen::MatrixXd::Ones(sheet.mesh.triangle_count(), 1);
  kind.topRows(2).setZero();
  frame.parts["surface"].arrays.push_back({"kind", "1", NamedArray::On::cells, kind});
  frame.parts["surface"].arrays.push_back({"piece", "1", NamedArray::On::cells, kind});
  const Part before = frame.parts["surface"];
  add_drawn_surface(frame);
  const Part& after = frame.require_part("surface");
  EXPECT_EQ(after.points, before.points);
  EXPECT_EQ(after.triangles, before.triangles);
  ASSERT_EQ(after.arrays.size(), before.arrays.size());
  const Part& drawn = frame.require_part("drawn", Part::Kind::triangles);
  const Eigen::MatrixXd& n = drawn.require_array("normal", NamedArray::On::points, 3).values;
  EXPECT_LT((n.rowwise().norm().array() - 1).abs().maxCoeff(), 2 * DrawnSurface::kNormalUnit);
  EXPECT_NE(drawn.find_array("piece"), nullptr);
  // The plane at the edge is as many triangles as before: it is one.
  const Eigen::VectorXd kinds = drawn.require_array("kind", NamedArray::On::cells, 1).values;
  EXPECT_EQ((kinds.array() == 0).count(), 2);
  EXPECT_GT(frame.diagnostics.at("drawn_distance"), 1e-4);
}

}  // namespace
}  // namespace geoprior::paper
