#include "baselines/sketch/flatten/abf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "baselines/sketch/flatten/cgal_flatten.h"
#include "baselines/sketch/flatten/lscm.h"
#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "metrics/spacing/pattern_mesh.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/flatten/flatten.h"
#include "models/sketch/pattern/piece_borders.h"
#include "models/sketch/surface/cut_surface.h"
#include "tests/core/geometry/shapes.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

using ::geoprior::shapes::sphere;
using ::geoprior::shapes::square;

/// The baselines in their default settings, but CGAL's rigid one with more steps than its 50, which
/// do not bring a cone to rest from its start on a circle.
struct NamedBaseline {
  const char* name;
  std::function<Eigen::MatrixX2d(const TriMesh&)> flatten;
};

std::array<NamedBaseline, 4> baselines() {
  return {NamedBaseline{"lscm", [](const TriMesh& m) { return flatten_lscm(m); }},
          NamedBaseline{"abf", [](const TriMesh& m) { return flatten_abf(m); }},
          NamedBaseline{"cgal-arap",
                        [](const TriMesh& m) {
                          return flatten_cgal_arap(m, {.iterations = 1000, .tolerance = 1e-12});
                        }},
          NamedBaseline{"cgal-lscm", [](const TriMesh& m) { return flatten_cgal_lscm(m); }}};
}

/// Plane sheet of uneven triangles.
TriMesh uneven_plane() {
  return flats::grid(9, 7, [](int i, int j) {
    const double x = i + 0.3 * std::sin(2.0 * i + 3.0 * j), y = j + 0.3 * std::cos(3.0 * i - j);
    return Eigen::Vector3d(0.1 * x, 0.1 * y, 0);
  });
}

TriMesh cut_frustum() {
  constexpr int kSegments = 24, kRows = 6;
  return cut_surface(flats::tube(1, 0.6, 1.5, kSegments, kRows), flats::tube_seam(kSegments, kRows))
      .at(0)
      .mesh;
}

Eigen::MatrixX3d angles_of(const TriMesh& mesh) {
  Eigen::MatrixX3d angle(mesh.triangle_count(), 3);
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) angle(t, k) = triangles[t].angle[k];
  }
  return angle;
}

Eigen::MatrixX3d angles_of(const Eigen::MatrixX2d& points, const Eigen::MatrixX3i& F) {
  TriMesh flat;
  flat.V = Eigen::MatrixX3d::Zero(points.rows(), 3);
  flat.V.leftCols(2) = points;
  flat.F = F;
  return angles_of(flat);
}

TEST(Abf, LeavesTheAnglesOfAPlaneSheet) {
  const TriMesh plane = uneven_plane();
  const AbfAngles result = abf_angles(plane);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_LT((result.angle - angles_of(plane)).cwiseAbs().maxCoeff(), 1e-12);
}

// Sums and products are formed here anew, from the angles alone.
TEST(Abf, AnglesMeetTheirConstraints) {
  for (const TriMesh& mesh : {flats::hemisphere(4), flats::hemisphere(2), cut_frustum()}) {
    const AbfAngles result = abf_angles(mesh);
    ASSERT_TRUE(result.converged);
    EXPECT_GT(result.angle.minCoeff(), 0);
    const int n = mesh.vertex_count();
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(n), ahead = Eigen::VectorXd::Ones(n),
                    behind = Eigen::VectorXd::Ones(n);
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      EXPECT_NEAR(result.angle.row(t).sum(), std::numbers::pi, 1e-8);
      for (int k = 0; k < 3; ++k) {
        sum(mesh.F(t, k)) += result.angle(t, k);
        ahead(mesh.F(t, k)) *= std::sin(result.angle(t, (k + 1) % 3));
        behind(mesh.F(t, k)) *= std::sin(result.angle(t, (k + 2) % 3));
      }
    }
    const std::vector<bool> border = boundary_vertices(mesh.F, n);
    for (int v = 0; v < n; ++v) {
      if (border[v]) continue;
      EXPECT_NEAR(sum(v), kFullTurn, 1e-8);
      EXPECT_NEAR(ahead(v) / behind(v), 1, 1e-8);
    }
  }
}

// One inner vertex with n equal triangles around it, as a pyramid: by symmetry every angle at the
// apex becomes 2 pi / n and those at the base half of what is left.
TEST(Abf, PyramidOpensToARegularPolygon) {
  for (const int n : {3, 5, 8}) {
    TriMesh pyramid;
    pyramid.V.resize(n + 1, 3);
    pyramid.F.resize(n, 3);
    pyramid.V.row(n) << 0, 0, 0.8;
    for (int i = 0; i < n; ++i) {
      pyramid.V.row(i) << std::cos(kFullTurn * i / n), std::sin(kFullTurn * i / n), 0;
      pyramid.F.row(i) << i, (i + 1) % n, n;
    }
    const AbfAngles result = abf_angles(pyramid);
    ASSERT_TRUE(result.converged);
    for (int t = 0; t < n; ++t) {
      EXPECT_NEAR(result.angle(t, 2), kFullTurn / n, 1e-10);
      EXPECT_NEAR(result.angle(t, 0), (std::numbers::pi - kFullTurn / n) / 2, 1e-10);
    }
  }
}

// Karush, Kuhn, Tucker: to first order no change of the angles that respects the constraints lowers
// the objective. Perturbed layouts of the result give such changes.
TEST(Abf, AnglesAreNearestAmongThoseOfLayouts) {
  const TriMesh mesh = flats::hemisphere(2);
  const AbfAngles result = abf_angles(mesh);
  const Eigen::MatrixX2d points = flatten_abf(mesh);
  EXPECT_LT((angles_of(points, mesh.F) - result.angle).cwiseAbs().maxCoeff(), 1e-9)
      << "the layout has the angles";
  const Eigen::MatrixX3d own = angles_of(mesh);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) sum(mesh.F(t, k)) += own(t, k);
  }
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  const auto objective = [&](const Eigen::MatrixX2d& p) {
    const Eigen::MatrixX3d angle = angles_of(p, mesh.F);
    double total = 0;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.F(t, k);
        const double aim = border[v] ? own(t, k) : own(t, k) * kFullTurn / sum(v);
        total += std::pow(angle(t, k) / aim - 1, 2);
      }
    }
    return total;
  };
  const double least = objective(points);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    for (const Eigen::RowVector2d& d : {Eigen::RowVector2d(1e-3, 0), Eigen::RowVector2d(0, 1e-3)}) {
      for (const double sign : {-1.0, 1.0}) {
        Eigen::MatrixX2d moved = points;
        moved.row(v) += sign * d;
        EXPECT_GT(objective(moved), least);
      }
    }
  }
}

// An ear of no area: remeshing along a straight border leaves three points of one line.
TEST(FlattenBaselines, CornersOfTrianglesWithoutAreaStayOnTheirLine) {
  TriMesh sheet = uneven_plane();
  sheet.V.row(1) = 0.5 * (sheet.V.row(0) + sheet.V.row(2));  // the line that the ear is put on
  const Eigen::Index n = sheet.V.rows();
  sheet.V.conservativeResize(n + 1, Eigen::NoChange);
  sheet.V.row(n) = 0.75 * sheet.V.row(0) + 0.25 * sheet.V.row(1);
  sheet.F.conservativeResize(sheet.F.rows() + 1, Eigen::NoChange);
  const std::vector<int> border = disc_border(uneven_plane(), "sheet");
  const auto at = std::find(border.begin(), border.end(), 0);
  const bool ahead = (at + 1 == border.end() ? border.front() : *(at + 1)) == 1;
  sheet.F.bottomRows(1) << (ahead ? 1 : 0), (ahead ? 0 : 1), static_cast<int>(n);
  for (const auto& flatten : {baselines()[2], baselines()[3]}) {
    const Eigen::MatrixX2d points = flatten.flatten(sheet);
    ASSERT_TRUE(points.allFinite()) << flatten.name;
    const Eigen::RowVector2d on = 0.75 * points.row(0) + 0.25 * points.row(1);
    EXPECT_LT((points.row(n) - on).norm(), 1e-12) << flatten.name;
  }
}

TEST(FlattenBaselines, DevelopableSurfacesComeOutIsometric) {
  for (const NamedBaseline& baseline : baselines()) {
    for (const TriMesh& mesh : {uneven_plane(), cut_frustum()}) {
      const Eigen::MatrixX2d points = baseline.flatten(mesh);
      EXPECT_LT(flats::worst_edge(mesh, points), 1e-6) << baseline.name;
      EXPECT_GT(pattern_mesh(points, mesh.F).min_area, 0) << baseline.name;
    }
  }
}

// Conformal maps have the surface's area because they are scaled to it. Rigidity trades angles for
// lengths: ours has the least strain of all.
TEST(FlattenBaselines, KeepTheAreaOfAHemisphereAndStrainItMoreThanTheRigidLayout) {
  const TriMesh half = flats::hemisphere(3);
  const std::vector<FlatTriangle> triangles = flat_triangles(half);
  double area = 0;
  for (const FlatTriangle& t : triangles) area += t.area;
  // sum of the area times |J - R|^2: |a| and |b| of J v = a v + b conj(v) give 2 (|a| - 1)^2 + 2
  // |b|^2.
  const auto strain = [&](const Eigen::MatrixX2d& points) {
    const Eigen::VectorXcd z = to_complex(points);
    double total = 0;
    for (int t = 0; t < half.triangle_count(); ++t) {
      const Complex u = triangles[t].edge[0], v = -triangles[t].edge[2];
      const Complex p = z(half.F(t, 1)) - z(half.F(t, 0)), q = z(half.F(t, 2)) - z(half.F(t, 0));
      const Complex twice = u * std::conj(v) - v * std::conj(u);
      const Complex a = (p * std::conj(v) - q * std::conj(u)) / twice, b = (u * q - v * p) / twice;
      total += triangles[t].area * 2 * (std::pow(std::abs(a) - 1, 2) + std::norm(b));
    }
    return std::sqrt(total / area);
  };
  const Flattening ours = flatten(half);
  EXPECT_NEAR(strain(ours.points), ours.report.strain, 1e-9);
  for (const NamedBaseline& baseline : baselines()) {
    const Eigen::MatrixX2d points = baseline.flatten(half);
    const double flat_area = pattern_mesh(points, half.F).area;
    if (std::string(baseline.name) != "cgal-arap") {
      EXPECT_NEAR(flat_area, area, 1e-9) << baseline.name;
    }
    EXPECT_GT(strain(points), ours.report.strain) << baseline.name;
  }
}

TEST(FlattenBaselines, RefuseWhatIsNoDisc) {
  const CutPiece frame =
      cut_surface(square(4), flats::seam_along({6, 7, 8, 13, 18, 17, 16, 11, 6}, 0)).at(0);
  for (const NamedBaseline& baseline : baselines()) {
    EXPECT_THROW(baseline.flatten(sphere(1)), Error) << baseline.name;
    EXPECT_THROW(baseline.flatten(frame.mesh), Error) << baseline.name;
  }
}

TEST(Lscm, PinsTheFarthestPairOfTheBorder) {
  const TriMesh mesh = square(3);
  const std::vector<int> border{0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4};
  EXPECT_EQ(farthest_pair(mesh, border), (std::array<int, 2>{0, 15})) << "the first diagonal";
}

}  // namespace
}  // namespace geoprior::sketch
