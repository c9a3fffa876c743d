#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/geometry/curvature_fit.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "solvers/paper/meshing/ruling_field.h"
#include "solvers/paper/sheet/compression.h"
#include "solvers/paper/sheet/invariants.h"
#include "solvers/paper/sheet/pieces.h"
#include "solvers/paper/sheet/propagation.h"
#include "solvers/paper/sheet/singular_point.h"
#include "solvers/paper/sheet/tracking.h"
#include "solvers/paper/shell/plastic_apex.h"
#include "solvers/paper/shell/settled_energy.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// A sheet of 0.2 m by 0.2 m, its structure, mesh and flat state.
struct EventSheet {
  Sheet sheet;
  std::vector<Vector2d> anchors;
  PaperStructure structure;
  HybridOptions options;
  RulingMesh mesh;
  ShellState state;

  EventSheet() { sheet.pattern = rectangle_pattern(0.2, 0.2); }
  RulingEditor editor() { return {sheet.pattern, anchors, {4e-3, 0.1}, structure}; }
  void add_uprights() {
    for (int k = -2; k <= 2; ++k) editor().add(*editor().chord({0.02 * k, 0}, {0, 1}));
  }
  void lay_flat() {
    mesh = mesh_structure(structure, sheet.pattern, anchors, {0.1, 4, 0.04});
    derive_pieces(structure, sheet.pattern, mesh);
    state = resting(mesh.mesh);
  }
  /// Bends the sheet to a cylinder of radius R whose rulings have the given direction.
  void bend(double radius, const Vector2d& rulings) {
    const Vector2d across = -perpendicular(rulings);
    for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
      const Vector2d p = mesh.mesh.pattern.row(i);
      const double s = p.dot(across), angle = s / radius;
      const Vector2d q = radius * std::sin(angle) * across + p.dot(rulings) * rulings;
      state.x.row(i) << q.x(), q.y(), radius * (std::cos(angle) - 1);
    }
  }
  static ShellState resting(const ShellMesh& m) {
    ShellState s;
    s.mesh = m;
    s.x = Eigen::MatrixX3d::Zero(m.vertex_count(), 3);
    s.x.leftCols<2>() = m.pattern;
    s.v = Eigen::MatrixX3d::Zero(m.vertex_count(), 3);
    s.plastic_curvature = Eigen::MatrixX3d::Zero(m.triangle_count(), 3);
    s.damage = Eigen::VectorXd::Zero(m.triangle_count());
    return s;
  }
  [[nodiscard]] Eigen::MatrixX3d curvature() const {
    return shape_operators(fit_curvature(mesh.mesh.pattern, mesh.mesh.triangles), state.x);
  }
  std::vector<Demand> demands() {
    const RulingEditor looker = editor();
    return find_demands(sheet, state, curvature(), mesh, looker, options);
  }
};

/// A map x -> (1 - e) x along d has Green strain ((1 - e)^2 - 1) / 2 there and none across.
TEST(Compression, IsTheGreenStrainOfAUniformMapAndItsDirection) {
  EventSheet s;
  s.lay_flat();
  const double e = 1e-3;
  const Vector2d d(std::cos(0.4), std::sin(0.4));
  const Eigen::Matrix2d map = Eigen::Matrix2d::Identity() - e * d * d.transpose();
  s.state.x.leftCols<2>() = s.mesh.mesh.pattern * map;
  for (int f = 0; f < s.mesh.mesh.triangle_count(); ++f) {
    const Compression c = compression(s.state, f);
    EXPECT_NEAR(c.strain, (1 - (1 - e) * (1 - e)) / 2, 1e-12);
    EXPECT_NEAR(line_angle(c.direction, d), 0, 1e-6);
  }
}

/// A plate of span L buckles at 4 pi^2 D / (E h L^2) = pi^2 h^2 / (3 (1 - nu^2) L^2).
TEST(Compression, AsksForRulingsBeyondEulersStrain) {
  EventSheet s;
  s.lay_flat();
  s.options.least_slope_deg = 0;
  const double h = s.sheet.material.thickness, nu = s.sheet.material.poisson_ratio, L = 0.2;
  const double euler = std::pow(std::numbers::pi * h / L, 2) / (3 * (1 - nu * nu));
  for (const double factor : {0.9, 1.1}) {
    s.state.x.col(0) = (1 - factor * euler) * s.mesh.mesh.pattern.col(0);
    for (const Demand& demand : s.demands()) {
      EXPECT_EQ(demand.weight > 0, factor > 1);
      if (demand.weight > 0) {
        EXPECT_NEAR(demand.excess, factor, 1e-3);
      }
    }
  }
}

TEST(Compression, TheThresholdAloneDecidesInThePlainTest) {
  EventSheet s;
  s.lay_flat();
  s.state.x.col(0) = (1 - 1e-3) * s.mesh.mesh.pattern.col(0);
  s.options.test = CompressionTest::threshold;
  for (const double threshold : {1.1e-3, 0.9e-3}) {
    s.options.compression_threshold = threshold;
    for (const Demand& demand : s.demands()) EXPECT_EQ(demand.weight > 0, threshold < 1e-3);
  }
}

/// A group along y on a sheet with upright rulings: its candidates run along x across them.
DemandGroup crossing_group() {
  DemandGroup group;
  group.direction = {0, 1};
  group.low = -0.03;
  group.high = 0.03;
  group.strength = 1;
  group.excess = 100;
  return group;
}

TEST(Propagation, CandidatesAcrossACylinderMakeASingularPointInTheHullOfTheCrossings) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EventSheet s;
    s.add_uprights();
    s.lay_flat();
    RulingEditor pen = s.editor();
    std::uint64_t draw = 0;
    const PropagationReport report = resolve_group(
        crossing_group(), [](const Vector2d&) { return true; }, {}, 0.5, seed, draw, s.options,
        pen);
    ASSERT_EQ(report.new_singular_points, 1);
    // Seeds at every seeding distance of y = -0.03 ... 0.03; rulings at x = -0.04 ... 0.04.
    const SingularPoint& point = s.structure.singular_points.at(0);
    EXPECT_LE(std::abs(point.position.x()), 0.04 + 1e-12);
    EXPECT_LE(std::abs(point.position.y()), 2 * s.options.seeding_distance + 1e-12);
    EXPECT_EQ(point.birth, 0.5);
    s.lay_flat();
    EXPECT_TRUE(broken_invariants(s.structure, s.sheet.pattern, s.mesh.mesh).empty());
  }
}

TEST(Propagation, OnFlatGroundTheSameCandidatesAreACylinder) {
  EventSheet s;
  s.lay_flat();
  RulingEditor pen = s.editor();
  std::uint64_t draw = 0;
  const PropagationReport report = resolve_group(
      crossing_group(), [](const Vector2d&) { return true; }, {}, 0, 1, draw, s.options, pen);
  EXPECT_EQ(report.new_singular_points, 0);
  EXPECT_EQ(report.new_rulings, 1 + 2 * static_cast<int>(0.03 / s.options.seeding_distance));
  for (const Ruling& r : s.structure.rulings) {
    EXPECT_NEAR(line_angle(r.b - r.a, Vector2d(1, 0)), 0, 1e-9);
  }
}

TEST(RulingEditor, TurnsARulingIntoARowOfAnchors) {
  EventSheet s;
  s.anchors = {{0, -0.1}, {0, -0.05}, {0, 0.05}, {0, 0.1}};
  const auto ruling = s.editor().chord({0.001, 0}, {std::sin(2.5 * kDegree), 1});
  ASSERT_TRUE(ruling);
  EXPECT_NEAR(ruling->a.x(), 0, 1e-12);
  EXPECT_NEAR(ruling->b.x(), 0, 1e-12);
}

/// The bending of a cylinder of radius R whose rulings have the given direction, and of no more.
BendingField cylinder_field(const EventSheet& s, double radius, const Vector2d& rulings) {
  const ShellState even =
      EventSheet::resting(uniform_mesh(s.sheet.pattern, 400, UniformLayout::equilateral, {}, 1));
  const Vector2d d = perpendicular(rulings.normalized()) / std::sqrt(radius);
  Eigen::MatrixX3d curvature(even.mesh.vertex_count(), 3);
  curvature.rowwise() = Eigen::RowVector3d(d.x() * d.x(), d.x() * d.y(), d.y() * d.y());
  return {even, curvature};
}

double angle_from_upright(const Ruling& r) {
  const Vector2d d = r.b.y() > r.a.y() ? Vector2d(r.b - r.a) : Vector2d(r.a - r.b);
  return std::atan2(d.x(), d.y()) / kDegree;
}

TEST(FollowBending, TurnsRulingsTowardsThoseOfTheBentSheetNotFasterThanItsRate) {
  EventSheet s;
  s.add_uprights();
  const BendingField field =
      cylinder_field(s, 0.1, {std::sin(12 * kDegree), std::cos(12 * kDegree)});
  RulingEditor pen = s.editor();
  int added = 0;
  ASSERT_TRUE(follow_bending(field, s.options, pen, added));
  for (int k = 0; k < 5; ++k) {
    EXPECT_GT(angle_from_upright(s.structure.rulings[k]), 1);
    EXPECT_LE(angle_from_upright(s.structure.rulings[k]), s.options.tracking_rate_deg + 1e-6);
  }
  for (int frame = 0; frame < 5; ++frame) follow_bending(field, s.options, pen, added);
  for (const Ruling& r : s.structure.rulings) EXPECT_NEAR(angle_from_upright(r), 12, 4.1);
}

TEST(FollowBending, LaysRulingsAlongACylinderAsCloseAsItsCurvatureAsksFor) {
  for (const double radius : {0.2, 0.03}) {
    EventSheet s;
    s.options.seeding_distance = 0.02;
    const BendingField field = cylinder_field(s, radius, {1, 2});
    RulingEditor pen = s.editor();
    int added = 0;
    ASSERT_TRUE(follow_bending(field, s.options, pen, added));
    EXPECT_EQ(added, static_cast<int>(s.structure.rulings.size()));
    std::vector<double> offsets;
    const Vector2d across = perpendicular(Vector2d(1, 2).normalized());
    for (const Ruling& r : s.structure.rulings) {
      EXPECT_LT(line_angle(r.b - r.a, Vector2d(1, 2)), 8 * kDegree);
      offsets.push_back(across.dot(r.a + r.b) / 2);
    }
    std::sort(offsets.begin(), offsets.end());
    const double asked = std::min(0.02, radius * s.options.refine_angle_deg * kDegree);
    for (std::size_t k = 1; k < offsets.size(); ++k) {
      EXPECT_GT(offsets[k] - offsets[k - 1], 0.5 * asked) << radius;
      EXPECT_LT(offsets[k] - offsets[k - 1], 2 * asked) << radius;
    }
    EXPECT_GT(offsets.back() - offsets.front(), 0.7 * 0.2);
  }
}

TEST(FollowBending, LeavesAFlatSheetAloneAndTakesAwayWhatLiesAcrossTheBend) {
  EventSheet s;
  s.add_uprights();
  RulingEditor pen = s.editor();
  int added = 0;
  EXPECT_FALSE(follow_bending(cylinder_field(s, 100, {1, 0}), s.options, pen, added));
  ASSERT_TRUE(follow_bending(cylinder_field(s, 0.1, {1, 0}), s.options, pen, added));
  for (const Ruling& r : s.structure.rulings)
    EXPECT_LT(line_angle(r.b - r.a, Vector2d(1, 0)), s.options.follow_angle_deg * kDegree);
}

TEST(BendingGuide, SeesTheCylinderThatAnAccordionOfRulingsHides) {
  EventSheet s;
  s.add_uprights();
  s.lay_flat();
  // Rulings along v; the sheet is bent about lines at 30 degrees, which this mesh carries in folds
  // to both sides.
  const Vector2d rulings(std::sin(30 * kDegree), std::cos(30 * kDegree));
  s.bend(0.1, rulings);
  s.sheet.gravity.setZero();
  RunContext context(1);
  BendingGuide guide(s.sheet, s.sheet.pattern, 0.015, {}, 1);
  const BendingField field = guide.relaxed(s.state);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const double u : {-0.05, 0.0, 0.05})
    for (const double v : {-0.05, 0.0, 0.05}) sum += field.at({u, v});
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(sum / 9);
  // Hollow below: the larger eigenvalue in modulus is negative.
  const Vector2d across = eigen.eigenvectors().col(0);
  EXPECT_LT(line_angle(perpendicular(across), rulings), 15 * kDegree);
  EXPECT_NEAR(eigen.eigenvalues()[0], -10, 2.5);
}

TEST(RulingEditor, RemovesASingularPointWithItsRulingsAndRenumbersTheOthers) {
  EventSheet s;
  for (const double u : {-0.05, 0.05}) {
    SingularPoint point;
    point.id = static_cast<int>(s.structure.singular_points.size());
    point.position = {u, 0};
    s.structure.singular_points.push_back(point);
    RulingEditor pen = s.editor();
    fill_fan(point.id, s.options, pen);
  }
  const auto of_second = s.structure.rulings_at(1).size();
  ASSERT_GT(of_second, 3U);
  RulingEditor pen = s.editor();
  pen.remove_point(0);
  ASSERT_EQ(s.structure.singular_points.size(), 1U);
  EXPECT_EQ(s.structure.singular_points[0].id, 1);
  EXPECT_EQ(s.structure.rulings_at(0).size(), of_second);
  EXPECT_EQ(s.structure.rulings.size(), of_second);
  s.lay_flat();
  EXPECT_TRUE(broken_invariants(s.structure, s.sheet.pattern, s.mesh.mesh).empty());
}

TEST(SettledEnergy, OfABentSheetIsThatOfTheShapeItSettlesTo) {
  EventSheet s;
  s.add_uprights();
  s.lay_flat();
  s.sheet.gravity.setZero();
  RunContext context(1);
  EXPECT_NEAR(settled_energy(s.sheet, {}, 1, s.state), 0, 1e-15);
  // Free to move, a bent sheet springs back: less is left than it was bent with.
  s.bend(0.1, {0, 1});
  ShellStepper stepper(s.sheet, {}, 1);
  stepper.set_mesh(s.state);
  const ShellEnergies energies = stepper.energies(s.state);
  const double before = energies.bending + energies.membrane;
  const double settled = settled_energy(s.sheet, {}, 1, s.state);
  EXPECT_GT(settled, 0);
  EXPECT_LT(settled, before);
}

/// A fan of rays about the middle of the sheet, flat but for those that a test folds.
struct FanSheet : EventSheet {
  std::vector<double> folds;

  FanSheet() {
    SingularPoint point;
    point.position.setZero();
    structure.singular_points.push_back(point);
    RulingEditor pen = editor();
    fill_fan(0, options, pen);
    lay_flat();
    folds.assign(structure.rulings.size(), 0);
  }
  void wait(int frames) {
    RulingEditor pen = editor();
    for (int k = 0; k < frames; ++k) count_flat_frames(folds, options, pen);
  }
  bool retire(bool remeshed_anyway) {
    RulingEditor pen = editor();
    return retire_rulings(remeshed_anyway, options, pen);
  }
  /// Largest angle between neighbouring rays.
  [[nodiscard]] double widest_sector() const {
    std::vector<double> angles;
    for (const int r : structure.rulings_at(0)) {
      const Vector2d& end = structure.rulings[r].b;
      angles.push_back(std::atan2(end.y(), end.x()));
    }
    double widest = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t k = 1; k < angles.size(); ++k) {
      widest = std::max(widest, angles[k] - angles[k - 1]);
    }
    return widest;
  }
};

/// Rays at most a right angle apart hold the apex; all others go in one frame, once they have been
/// flat for `flat_frames`, and not before.
TEST(Tracking, RemovesAFlatFanAtOnceDownToRightAngles) {
  FanSheet s;
  const std::size_t before = s.structure.rulings.size();
  s.wait(s.options.flat_frames - 1);
  EXPECT_FALSE(s.retire(true));
  s.wait(1);
  EXPECT_TRUE(s.retire(false));
  EXPECT_LE(s.structure.rulings.size(), before / 2);
  EXPECT_LE(s.widest_sector(), std::numbers::pi / 2 + 1e-9);
  s.folds.assign(s.structure.rulings.size(), 0);
  EXPECT_FALSE(s.retire(true));
}

/// One flat ray of many does not make a new mesh, but goes with the next one.
TEST(Tracking, AFlatRayWaitsForANewMesh) {
  FanSheet s;
  s.folds.assign(s.folds.size(), 5 * kDegree);
  s.folds[3] = 0;
  const std::size_t before = s.structure.rulings.size();
  s.wait(s.options.flat_frames);
  EXPECT_FALSE(s.retire(false));
  EXPECT_EQ(s.structure.rulings.size(), before);
  EXPECT_TRUE(s.retire(true));
  EXPECT_EQ(s.structure.rulings.size(), before - 1);
}

/// Beside a fold beyond the refinement angle a ray would be put back as soon as it is gone.
TEST(Tracking, KeepsAFlatRayThatRefinementWouldPutBack) {
  FanSheet s;
  const PaperPiece& cone = s.structure.pieces.at(0);
  ASSERT_EQ(cone.kind, PaperPiece::Kind::cone);
  s.folds.assign(s.folds.size(), 5 * kDegree);
  s.folds[cone.rulings[2]] = 0;
  s.folds[cone.rulings[3]] = (s.options.refine_angle_deg + 1) * kDegree;
  s.wait(2 * s.options.flat_frames);
  EXPECT_FALSE(s.retire(true));
}

TEST(PlasticApex, YieldsOnlyWhereTheConeBendsBeyondTheYieldCurvature) {
  EventSheet s;
  SingularPoint point;
  point.position.setZero();
  s.structure.singular_points.push_back(point);
  RulingEditor pen = s.editor();
  ASSERT_GE(fill_fan(0, s.options, pen), 8);
  s.lay_flat();
  const double radius = 4e-3;
  Eigen::MatrixX3d curvature = Eigen::MatrixX3d::Zero(s.mesh.mesh.triangle_count(), 3);
  for (const double kappa : {1e-3, 200.0}) {
    curvature.col(0).setConstant(kappa);
    yield_at_apexes(s.sheet.material, radius, s.mesh.singular_vertices, curvature, s.state,
                    s.structure);
    EXPECT_EQ(s.structure.singular_points[0].weakening > 0, kappa > 1);
  }
  const int apex = s.mesh.singular_vertices[0];
  for (int f = 0; f < s.mesh.mesh.triangle_count(); ++f) {
    const bool beside = (s.mesh.mesh.triangles.row(f).array() == apex).any();
    EXPECT_EQ(s.state.plastic_curvature(f, 0) > 0, beside);
    EXPECT_LT(s.state.plastic_curvature(f, 0), 200);
  }
}

}  // namespace
}  // namespace geoprior::paper
