#include "baselines/paper/adaptive/adaptive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "baselines/paper/adaptive/editable_sheet.h"
#include "baselines/paper/adaptive/remesh.h"
#include "baselines/paper/adaptive/sizing.h"
#include "baselines/paper/dense.h"
#include "core/random.h"
#include "models/paper/meshing/uniform_mesh.h"
#include "tests/paper/contact/plane_shapes.h"
#include "tests/paper/meshes.h"
#include "tests/support/recording.h"

namespace geoprior::paper {
namespace {

using test::Recording;

using meshes::flat_state;

Sheet sheet_of(const Pattern& pattern) {
  Sheet sheet;
  sheet.pattern = pattern;
  return sheet;
}

/// Rolls the pattern onto a cylinder of this radius, its axis turned by `angle` from v towards -u.
void roll(ShellState& state, double radius, double angle) {
  const Eigen::RowVector2d around(std::cos(angle), std::sin(angle)),
      along(-std::sin(angle), std::cos(angle));
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    const double s = state.mesh.pattern.row(v).dot(around) / radius;
    const double t = state.mesh.pattern.row(v).dot(along);
    state.x.row(v) << radius * std::sin(s), t, radius * (1 - std::cos(s));
  }
}

void remesh_on_cylinder(const Sheet& sheet, const SizingOptions& options, double radius,
                        double angle, int rounds, ShellState& state) {
  for (int i = 0; i < rounds; ++i) {
    roll(state, radius, angle);
    remesh(sheet, sizing_tensors(state, {}, options), state);
  }
  roll(state, radius, angle);
}

std::vector<Eigen::Vector2d> interior_edges(const ShellMesh& mesh) {
  const auto directed = plane_shapes::directed_edges(mesh);
  std::vector<Eigen::Vector2d> edges;
  for (const auto& [edge, count] : directed) {
    if (edge.first > edge.second || !directed.contains({edge.second, edge.first})) continue;
    edges.emplace_back(mesh.pattern.row(edge.second) - mesh.pattern.row(edge.first));
  }
  return edges;
}

TEST(TensorMax, OfCommonAxesTakesTheGreaterEigenvalues) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const auto tensor = [&](double a, double b) -> SizeTensor {
    return turn * Eigen::Vector2d(a, b).asDiagonal() * turn.transpose();
  };
  EXPECT_LT((tensor_max(tensor(3, 1), tensor(2, 5)) - tensor(3, 5)).norm(), 1e-14);
}

TEST(TensorMax, IsNotBelowEither) {
  RandomStream random(1, "tensors");
  for (int i = 0; i < 100; ++i) {
    Eigen::Matrix2d a, b;
    for (int k = 0; k < 4; ++k) {
      a(k) = random.normal();
      b(k) = random.normal();
    }
    const SizeTensor p = a * a.transpose(), q = b * b.transpose(), m = tensor_max(p, q);
    const Eigen::Vector2d e(random.normal(), random.normal());
    EXPECT_GE(e.dot(m * e), std::max(e.dot(p * e), e.dot(q * e)) - 1e-12);
  }
}

TEST(Sizing, IsLimitedInSizeAndAspect) {
  SizingOptions options;
  options.size_min = 0.01;
  options.size_max = 0.2;
  options.aspect_min = 0.1;
  const SizeTensor wild = limited(Eigen::Vector2d(1e9, 0).asDiagonal(), options);
  EXPECT_NEAR(wild(0, 0), 1e4, 1e-9);  // 1 / size_min^2
  EXPECT_NEAR(wild(1, 1), 1e2, 1e-9);  // aspect_min^2 of it
  const SizeTensor calm = limited(SizeTensor::Zero(), options);
  EXPECT_LT((calm - 25 * SizeTensor::Identity()).norm(), 1e-12);  // 1 / size_max^2
}

// On a cylinder of radius R the normal turns by l / R along an edge of length l around it.
TEST(Sizing, OfACylinderIsRefineAngleTimesRadius) {
  const Sheet sheet = sheet_of(rectangle_pattern(0.3, 0.3));
  SizingOptions options;
  options.size_min = 1e-4;
  options.size_max = 0.2;
  options.aspect_min = 0.01;
  options.refine_angle = 0.4;
  options.refine_compression = 1;  // chords of the cylinder are shorter than their arcs
  ShellState state =
      flat_state(uniform_mesh(sheet.pattern, 3000, UniformLayout::structured, {}, 1));
  roll(state, 0.1, 0.3);
  const std::vector<SizeTensor> sizes = sizing_tensors(state, {}, options);
  const Eigen::Vector2d around(std::cos(0.3), std::sin(0.3)), along(-around.y(), around.x());
  const double wanted = 1 / std::pow(0.4 * 0.1, 2);
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    if (state.mesh.pattern.row(v).cwiseAbs().maxCoeff() > 0.12) continue;
    const SizeTensor& m = sizes[v];
    EXPECT_NEAR(around.dot(m * around), wanted, 0.1 * wanted);
    EXPECT_LT(along.dot(m * along), 0.1 * wanted);
  }
}

TEST(Sizing, FollowsCompressionVelocityAndObstacles) {
  const Sheet sheet = sheet_of(rectangle_pattern(0.3, 0.3));
  SizingOptions options;
  options.size_min = 1e-4;
  options.size_max = 10;
  options.aspect_min = 0.01;
  const ShellState flat =
      flat_state(uniform_mesh(sheet.pattern, 50, UniformLayout::delaunay, {}, 1));
  const auto size_along_u = [&](const ShellState& state, const std::vector<Obstacle>& obstacles) {
    const std::vector<SizeTensor> sizes = sizing_tensors(state, obstacles, options);
    return 1 / std::sqrt(sizes[20](0, 0));
  };
  EXPECT_NEAR(size_along_u(flat, {}), 10, 1e-9);

  // Stretch 0.998 along u: Green strain (0.998^2 - 1) / 2 = -1.998e-3.
  ShellState pressed = flat;
  pressed.x.col(0) *= 0.998;
  EXPECT_NEAR(size_along_u(pressed, {}), options.refine_compression / std::sqrt(1.998e-3), 1e-9);

  // Velocity gradient 4 / s: half a metre per second over an eighth of a metre.
  ShellState sheared = flat;
  sheared.v.col(2) = 4 * flat.x.col(0);
  EXPECT_NEAR(size_along_u(sheared, {}), options.refine_velocity / 4, 1e-9);

  // Far from a wall through u = -1 the size is the distance to it (here that of a triangle's mean).
  Obstacle wall;
  wall.centre = {-1, 0, 0};
  wall.axis = {1, 0, 0};
  EXPECT_NEAR(size_along_u(flat, {wall}), 1 + flat.x(20, 0), 0.03);
}

// A sheet with holes is rolled and unrolled: coarse, fine and coarse again, its borders stay.
TEST(Remesh, KeepsTheBordersOfHoles) {
  Pattern pierced = plane_shapes::pierced_square();
  for (Eigen::Vector2d& p : pierced.border) p *= 0.05;
  for (auto& hole : pierced.holes) {
    for (Eigen::Vector2d& p : hole) p *= 0.05;
  }
  for (const Pattern& pattern : {pierced, plane_shapes::ring_pattern()}) {
    const Sheet sheet = sheet_of(pattern);
    SizingOptions options;
    options.size_min = 1e-3;
    options.size_max = 0.1;
    ShellState state = flat_state(uniform_mesh(pattern, 400, UniformLayout::equilateral, {}, 1));
    remesh_on_cylinder(sheet, options, 1e3, 0, 3, state);
    plane_shapes::expect_covers(state.mesh, pattern);
    const int coarse = state.mesh.triangle_count();
    remesh_on_cylinder(sheet, options, 0.03, 0.4, 3, state);
    plane_shapes::expect_covers(state.mesh, pattern);
    EXPECT_GT(state.mesh.triangle_count(), 2 * coarse);
    remesh_on_cylinder(sheet, options, 1e3, 0, 6, state);
    plane_shapes::expect_covers(state.mesh, pattern);
    EXPECT_LT(state.mesh.triangle_count(), 2 * coarse);
  }
}

/// Of plastic curvature and damage over the pattern.
Eigen::Vector4d integral(const ShellState& s) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int f = 0; f < s.mesh.triangle_count(); ++f) {
    const double area = plane_shapes::twice_area(s.mesh, f) / 2;
    sum.head<3>() += area * s.plastic_curvature.row(f).transpose();
    sum[3] += area * s.damage[f];
  }
  return sum;
}

struct Edits {
  int splits = 0, flips = 0, collapses = 0;
};

/// 400 operations in all, at random edges.
Edits edit_at_random(RandomStream& random, EditableSheet& sheet) {
  Edits done;
  while (done.splits + done.flips + done.collapses < 400) {
    const auto t =
        static_cast<int>(random.below(static_cast<std::uint32_t>(sheet.triangles().size())));
    if (sheet.triangles()[t].vertex[0] < 0) continue;
    const EditableSheet::Side side{t, static_cast<int>(random.below(3))};
    const std::uint32_t operation = random.below(3);
    if (operation == 0 && done.splits < 150) {
      sheet.split(side);
      ++done.splits;
    } else if (operation == 1 && sheet.can_flip(side, 0.02)) {
      sheet.flip(side);
      ++done.flips;
    } else if (operation == 2) {
      const int a = sheet.start(side), b = sheet.end(side);
      if (!sheet.can_collapse(a, b, 0.02, 1)) continue;
      sheet.collapse(a, b);
      ++done.collapses;
    }
  }
  return done;
}

TEST(EditableSheet, SurvivesRandomOperations) {
  for (const Pattern& pattern : {rectangle_pattern(0.2, 0.3), disc_pattern(0.1, 24),
                                 plane_shapes::ell_pattern(), plane_shapes::ring_pattern()}) {
    ShellState state = flat_state(uniform_mesh(pattern, 60, UniformLayout::delaunay, {}, 1));
    RandomStream random(3, "operations");
    for (int f = 0; f < state.mesh.triangle_count(); ++f) {
      for (int k = 0; k < 3; ++k) state.plastic_curvature(f, k) = random.normal();
      state.damage[f] = random.uniform();
    }
    const Eigen::Vector4d before = integral(state);
    EditableSheet sheet(state);
    for (auto& v : sheet.vertices()) {
      if (nearest_on_border(pattern, v.pattern).distance < 1e-12) {
        v.kind = EditableSheet::Kind::side;
      }
      for (const Eigen::Vector2d& corner : corners(pattern)) {
        if (v.pattern == corner) v.kind = EditableSheet::Kind::fixed;
      }
    }
    const Edits done = edit_at_random(random, sheet);
    EXPECT_GT(done.splits, 50);
    EXPECT_GT(done.flips, 50);
    EXPECT_GT(done.collapses, 50);
    const ShellState after = sheet.state(0);
    plane_shapes::expect_covers(after.mesh, pattern);
    EXPECT_LT((integral(after) - before).norm(), 1e-11 * before.norm());
    // Linear interpolation keeps a flat sheet flat.
    EXPECT_LT((after.x.leftCols<2>() - after.mesh.pattern).cwiseAbs().maxCoeff(), 1e-15);
    // A second sheet made from the result has the same neighbours: links were kept up.
    const EditableSheet again(after);
    EXPECT_EQ(again.vertices().size(), static_cast<std::size_t>(after.mesh.vertex_count()));
  }
}

TEST(Remesh, CoarsensAFlatSheetToTheLargestSize) {
  for (const Pattern& pattern :
       {rectangle_pattern(1, 0.7), disc_pattern(0.5, 24), plane_shapes::ell_pattern()}) {
    const Sheet sheet = sheet_of(pattern);
    SizingOptions options;
    options.size_max = 0.25 * width(pattern);
    ShellState state = flat_state(uniform_mesh(pattern, 1000, UniformLayout::delaunay, {}, 1));
    remesh(sheet, sizing_tensors(state, {}, options), state);
    plane_shapes::expect_covers(state.mesh, pattern);
    EXPECT_LT(state.mesh.triangle_count(), 200);
    for (const Eigen::Vector2d& e : interior_edges(state.mesh)) {
      EXPECT_LE(e.norm(), 1.0001 * options.size_max);
    }
  }
}

TEST(Remesh, RefinesACoarseSheetToTheSizeAskedFor) {
  const Sheet sheet = sheet_of(rectangle_pattern(1, 0.7));
  SizingOptions options;
  options.size_max = 0.1;
  ShellState state = flat_state(uniform_mesh(sheet.pattern, 4, UniformLayout::structured, {}, 1));
  remesh(sheet, sizing_tensors(state, {}, options), state);
  plane_shapes::expect_covers(state.mesh, sheet.pattern);
  for (const Eigen::Vector2d& e : interior_edges(state.mesh)) EXPECT_LE(e.norm(), 0.10001);
}

// Around a cylinder of radius R an edge of length refine_angle R turns the normal by refine_angle;
// along it only size_max and aspect_min bound the length.
TEST(Remesh, MakesLongTrianglesAlongACylinder) {
  for (const double angle : {0.0, 0.6}) {
    const Sheet sheet = sheet_of(rectangle_pattern(0.4, 0.4));
    SizingOptions options;
    options.size_min = 1e-3;
    options.size_max = 0.2;
    options.refine_angle = 0.3;
    options.refine_compression = 1;  // chords of the cylinder are shorter than their arcs
    const double radius = 0.08, size = options.refine_angle * radius;
    ShellState state = flat_state(uniform_mesh(sheet.pattern, 400, UniformLayout::delaunay, {}, 1));
    remesh_on_cylinder(sheet, options, radius, angle, 10, state);
    plane_shapes::expect_covers(state.mesh, sheet.pattern);
    const Eigen::Vector2d around(std::cos(angle), std::sin(angle)), along(-around.y(), around.x());
    double widest = 0, longest = 0;
    for (const Eigen::Vector2d& e : interior_edges(state.mesh)) {
      widest = std::max(widest, std::abs(e.dot(around)));
      longest = std::max(longest, std::abs(e.dot(along)));
    }
    // Near the border fewer hinges see the bend: a quarter longer there.
    EXPECT_LT(widest, 1.25 * size);
    EXPECT_GT(longest, 3 * size);
    // Equilateral triangles of edge 1 in the metric (1 / size^2, 1 / size_max^2), or at most seven
    // times as many: a collapse that would leave an edge of 0.6 is not made.
    const double fewest = 0.16 / (size * options.size_max) * 4 / std::sqrt(3.0);
    EXPECT_LT(state.mesh.triangle_count(), 7 * fewest);
    EXPECT_GT(state.mesh.triangle_count(), fewest);
  }
}

TEST(Remesh, ChangesNothingOnceItIsDone) {
  const Sheet sheet = sheet_of(rectangle_pattern(1, 0.7));
  SizingOptions options;
  ShellState state = flat_state(uniform_mesh(sheet.pattern, 500, UniformLayout::delaunay, {}, 1));
  remesh(sheet, sizing_tensors(state, {}, options), state);
  const RemeshReport again = remesh(sheet, sizing_tensors(state, {}, options), state);
  EXPECT_FALSE(again.any());
}

Sheet sheet_with_handles() {
  Sheet sheet = sheet_of(rectangle_pattern(0.4, 0.4));
  Handle point, segment, disc;
  point.points = {{0.05, 0.07}};
  segment.segment = {{-0.1, -0.2}, {-0.1, 0.1}};
  disc.points = {{0.1, -0.1}};
  disc.disc_radius = 0.02;
  sheet.handles = {point, segment, disc};
  return sheet;
}

TEST(Remesh, KeepsHandles) {
  const Sheet sheet = sheet_with_handles();
  SizingOptions options;
  ShellState state = flat_state(
      uniform_mesh(sheet.pattern, 800, UniformLayout::delaunay, handle_points(sheet, 0.02), 1));
  const auto expect_handles = [&] {
    plane_shapes::expect_covers(state.mesh, sheet.pattern);
    for (const Handle& handle : sheet.handles) {
      for (const Eigen::Vector2d& p : handle.anchors()) {
        EXPECT_LT(plane_shapes::distance_to_vertices(state.mesh, p), 1e-12);
      }
    }
    // The edges on the segment add up to its length.
    double length = 0;
    for (const auto& [edge, count] : plane_shapes::directed_edges(state.mesh)) {
      const Eigen::Vector2d a = state.mesh.pattern.row(edge.first),
                            b = state.mesh.pattern.row(edge.second);
      if (edge.first < edge.second && sheet.handles[1].covers(a) && sheet.handles[1].covers(b)) {
        length += (b - a).norm();
      }
    }
    EXPECT_NEAR(length, 0.3, 1e-12);
  };
  remesh(sheet, sizing_tensors(state, {}, options), state);
  expect_handles();
  remesh_on_cylinder(sheet, options, 0.06, 0.8, 4, state);
  expect_handles();
}

// A fold by a right angle: its edges must not be flipped, whatever the metric says.
TEST(Remesh, NeverFlipsAcrossAFold) {
  const Sheet sheet = sheet_of(rectangle_pattern(0.4, 0.4));
  ShellState state = flat_state(uniform_mesh(sheet.pattern, 128, UniformLayout::structured, {}, 1));
  std::set<double> fold_points;
  for (int v = 0; v < state.mesh.vertex_count(); ++v) {
    const double u = state.mesh.pattern(v, 0);
    if (std::abs(u) < 1e-12) fold_points.insert(state.mesh.pattern(v, 1));
    if (u > 0) state.x.row(v) << 0, state.mesh.pattern(v, 1), u;
  }
  ASSERT_GT(fold_points.size(), 4U);
  // Long sizes along u ask for edges across the fold.
  const std::vector<SizeTensor> sizes(state.mesh.vertex_count(),
                                      SizeTensor(Eigen::Vector2d(100, 2500).asDiagonal()));
  remesh(sheet, sizes, state);
  for (const Eigen::Vector2d& e : interior_edges(state.mesh)) EXPECT_TRUE(e.allFinite());
  double across = 0;
  for (const auto& [edge, count] : plane_shapes::directed_edges(state.mesh)) {
    const double u = state.mesh.pattern(edge.first, 0), w = state.mesh.pattern(edge.second, 0);
    if (u < -1e-12 && w > 1e-12) ++across;
  }
  EXPECT_EQ(across, 0);
}

TEST(Remesh, IsReproducible) {
  const Sheet sheet = sheet_with_handles();
  SizingOptions options;
  const auto run = [&] {
    ShellState state = flat_state(
        uniform_mesh(sheet.pattern, 300, UniformLayout::delaunay, handle_points(sheet, 0.03), 1));
    remesh_on_cylinder(sheet, options, 0.05, 0.5, 3, state);
    return state;
  };
  const ShellState a = run(), b = run();
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.pattern, b.mesh.pattern);
  EXPECT_EQ(a.x, b.x);
}

/// Root mean square of the change of length of all edges, relative.
double rms_edge_strain(const Frame& frame) {
  const Part& surface = frame.require_part("surface");
  const Eigen::MatrixXd& pattern = surface.arrays[0].values;
  double sum = 0;
  for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int a = surface.triangles(f, k), b = surface.triangles(f, (k + 1) % 3);
      const double flat = (pattern.row(b) - pattern.row(a)).norm();
      sum += std::pow((surface.points.row(b) - surface.points.row(a)).norm() / flat - 1, 2);
    }
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(surface.triangles.rows())));
}

Recording run_adaptive(const Sheet& sheet, const AdaptiveOptions& options = {}) {
  Recording recording;
  RunContext context(1);
  make_adaptive_sheet(sheet, options)->run(recording, context, {});
  return recording;
}

double worst_strain(const Recording& recording) {
  double worst = 0;
  for (const Frame& frame : recording.frames) worst = std::max(worst, rms_edge_strain(frame));
  return worst;
}

/// A square of 12 cm, one edge of which is held and one corner lifted and pushed inwards.
Sheet lifted_corner() {
  Sheet sheet = sheet_of(rectangle_pattern(0.12, 0.12));
  Handle edge;
  edge.segment = {Eigen::Vector2d(-0.06, -0.06), Eigen::Vector2d(-0.06, 0.06)};
  edge.motion = Trajectory{{Keyframe{}}};
  Handle corner;
  corner.points = {Eigen::Vector2d(0.06, 0.06)};
  Keyframe end;
  end.time = 0.6;
  end.shift = {-0.03, -0.01, 0.05};
  corner.motion = Trajectory{{Keyframe{}, end}};
  sheet.handles = {edge, corner};
  sheet.duration = 0.8;
  return sheet;
}

TEST(AdaptiveSheet, SettlesAfterItsMeshHasChanged) {
  const Sheet sheet = lifted_corner();
  AdaptiveOptions options;
  options.size_max = 0.2;  // so long that every change of the mesh strains the sheet
  const Recording settled = run_adaptive(sheet, options);
  EXPECT_LT(worst_strain(settled), 3e-4);
  double steps = 0;
  for (const Frame& frame : settled.frames) steps += frame.diagnostics.at("settle_steps");
  EXPECT_GT(steps, 0);
  AdaptiveOptions as_it_is = options;
  as_it_is.settle.steps = 0;
  EXPECT_GT(worst_strain(run_adaptive(sheet, as_it_is)), 6e-4) << "what settling takes away";
}

/// The right edge is pushed towards the left one, which is held, at once.
Sheet pushed_sheet() {
  Sheet sheet = sheet_of(rectangle_pattern(0.21, 0.148));
  sheet.gravity.setZero();
  for (const double side : {-1.0, 1.0}) {
    Handle edge;
    edge.segment = {Eigen::Vector2d(side * 0.105, -0.074), Eigen::Vector2d(side * 0.105, 0.074)};
    Keyframe end;
    end.time = 0.4;
    end.shift = {-0.03 * std::max(side, 0.0), 0, 0};
    edge.motion = Trajectory{{Keyframe{}, end}};
    sheet.handles.push_back(edge);
  }
  sheet.duration = 0.2;
  return sheet;
}

/// Largest sum of forces of one of two hands, in any frame (N).
double largest_force(const Recording& recording) {
  double largest = 0;
  for (const Frame& frame : recording.frames) {
    const Part& hands = frame.require_part("handles");
    const Eigen::MatrixXd& handle = hands.arrays[0].values;
    const Eigen::MatrixXd& force = hands.arrays[1].values;
    for (const int which : {0, 1}) {
      Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
      for (Eigen::Index i = 0; i < handle.rows(); ++i) {
        if (handle(i, 0) == which) sum += force.row(i);
      }
      largest = std::max(largest, sum.norm());
    }
  }
  return largest;
}

TEST(AdaptiveSheet, PullsAtHandsLikeTheDenseSheetWhenTheyBeginToMove) {
  const Sheet sheet = pushed_sheet();
  DenseOptions dense;
  dense.triangles = 600;
  Recording reference;
  RunContext context(1);
  make_dense_sheet(sheet, dense)->run(reference, context, {});
  const double expected = largest_force(reference);
  EXPECT_LT(largest_force(run_adaptive(sheet)), 2 * expected);
  AdaptiveOptions long_edges;
  long_edges.size_max = 0.2;
  EXPECT_GT(largest_force(run_adaptive(sheet, long_edges)), 2 * expected);
}

TEST(AdaptiveSheet, ComesToRestOnABall) {
  Sheet sheet = sheet_of(rectangle_pattern(0.21, 0.21));
  Obstacle ball;
  ball.kind = Obstacle::Kind::sphere;
  ball.centre = {0, 0, -0.053};
  ball.radius = 0.05;
  sheet.obstacles = {ball};
  sheet.duration = 3;
  const Recording recording = run_adaptive(sheet);
  for (std::size_t i = recording.frames.size() - 10; i < recording.frames.size(); ++i) {
    const Frame& frame = recording.frames[i];
    for (const char* change : {"splits", "collapses", "flips"}) {
      EXPECT_EQ(frame.diagnostics.at(change), 0) << i << change;
    }
    const Eigen::MatrixX3d& now = frame.require_part("surface").points;
    const Eigen::MatrixX3d& before = recording.frames[i - 1].require_part("surface").points;
    ASSERT_EQ(now.rows(), before.rows());
    EXPECT_LT((now - before).rowwise().norm().maxCoeff(), 2e-4) << i;
  }
}

}  // namespace
}  // namespace geoprior::paper
