#include "metrics/volume/overlap_volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/metrics/shapes.h"

namespace geoprior {
namespace {

using std::numbers::pi;

/// Volume common to two spheres of radius r whose centres are d apart.
double lens(double r, double d) { return pi / 12 * (4 * r + d) * (2 * r - d) * (2 * r - d); }

OverlapVolume whole(const TriMesh& m, double spacing, int axis) {
  return overlap_volume(m.V, m.F, shapes::bounds(m.V), spacing, axis);
}

TEST(OverlapVolume, EmbeddedSurfacesHaveNone) {
  for (int axis = 0; axis < 3; ++axis) {
    const OverlapVolume sphere = whole(shapes::sphere(1, {0, 0, 0}, 4), 0.02, axis);
    EXPECT_EQ(sphere.volume, 0);
    EXPECT_EQ(sphere.unbalanced_columns, 0);
    EXPECT_GT(sphere.columns, 7000);  // pi / 0.02^2 = 7854
    EXPECT_EQ(whole(shapes::torus(1, 0.4, 48, 24), 0.03, axis).volume, 0);
  }
}

// Columns of 1/768 of the diagonal: the lens of two unit spheres to a thousandth.
TEST(BodyOverlap, OfTwoSpheresIsTheirLens) {
  const double d = 1.2;
  const TriMesh m =
      shapes::together(shapes::sphere(1, {0, 0, 0}, 5), shapes::sphere(1, {d, 0, 0}, 5));
  const double spacing = body_column_spacing(m.V);
  EXPECT_NEAR(spacing, std::hypot(2 + d, 2, 2) / 768, 1e-5);
  const OverlapStudy study = body_overlap_study(m.V, m.F, spacing);
  EXPECT_NEAR(study.volume / lens(1, d), 1, 4e-3);
  EXPECT_LT(study.noise_floor, 1e-3 * study.volume);
  EXPECT_EQ(study.cut_area, 0);
}

// About a joint in the middle of one sphere alone, whose box the lens passes through.
TEST(RegionOverlap, CountsWhatIsInTheBoxOfTheJoints) {
  const double d = 1.2;
  const TriMesh m =
      shapes::together(shapes::sphere(1, {0, 0, 0}, 5), shapes::sphere(1, {d, 0, 0}, 5));
  JointRegion region;
  region.extent = 1;
  JointRegion::Hinge hinge;
  hinge.joint = 0;
  hinge.head = Eigen::Vector3d::Zero();
  hinge.radius = 1;
  region.hinges = {hinge};
  const OverlapStudy all = region_overlap_study(m.V, m.F, region, rest_pose(1));
  EXPECT_NEAR(all.volume / lens(1, d), 1, 1e-2);
  // The box of twice 0.3 about the joint ends at x = 0.6, the plane that halves the lens.
  region.hinges[0].radius = 0.3;
  const OverlapStudy half = region_overlap_study(m.V, m.F, region, rest_pose(1));
  EXPECT_GT(half.cut_area, 0);
  EXPECT_LT(half.volume, 0.5 * lens(1, d));
}

TEST(OverlapVolume, TwoBoxesAgreeWithinTheBorderColumns) {
  const TriMesh m =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({0.6, 0.3, 0.5}, {2, 2, 2}));
  const double exact = 0.4 * 0.7 * 0.5;
  const double h = 0.01;
  for (int axis = 0; axis < 3; ++axis) {
    const OverlapVolume o = whole(m, h, axis);
    // Depth is exact; each side of the overlap's rectangle may be off by less than one column.
    const Eigen::Vector3d side(0.4, 0.7, 0.5);
    const double perimeter = 2 * (side.sum() - side(axis));
    EXPECT_NEAR(o.volume, exact, h * perimeter / 2 * side(axis)) << "axis " << axis;
    EXPECT_EQ(o.unbalanced_columns, 0);
  }
}

TEST(OverlapVolume, TwoSpheresGiveTheirLens) {
  const TriMesh m =
      shapes::together(shapes::sphere(1, {0, 0, 0}, 5), shapes::sphere(1, {0.9, 0.7, 0.4}, 5));
  const double d = Eigen::Vector3d(0.9, 0.7, 0.4).norm();
  for (int axis = 0; axis < 3; ++axis) {
    // 8 * 4^5 triangles inscribed: the sphere's volume falls short by 0.1 %, its lens by less
    // than three times that; the columns' error at 0.01 is smaller.
    EXPECT_NEAR(whole(m, 0.01, axis).volume / lens(1, d), 1, 3e-3) << "axis " << axis;
  }
}

TEST(OverlapVolume, DoesNotDependOnTheTessellation) {
  const double coarse = whole(shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}),
                                               shapes::box({.5, .5, .5}, {2, 2, 2})),
                              0.013, 2)
                            .volume;
  // The same boxes, every triangle split at its centroid.
  TriMesh m =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({.5, .5, .5}, {2, 2, 2}));
  const Eigen::Index n = m.V.rows();
  TriMesh split;
  split.V.resize(n + m.F.rows(), 3);
  split.V.topRows(n) = m.V;
  split.F.resize(3 * m.F.rows(), 3);
  for (Eigen::Index t = 0; t < m.F.rows(); ++t) {
    const Eigen::RowVector3i f = m.F.row(t);
    const int c = static_cast<int>(n + t);
    split.V.row(c) = (m.V.row(f(0)) + m.V.row(f(1)) + m.V.row(f(2))) / 3;
    split.F.row(3 * t) << f(0), f(1), c;
    split.F.row(3 * t + 1) << f(1), f(2), c;
    split.F.row(3 * t + 2) << f(2), f(0), c;
  }
  EXPECT_NEAR(whole(split, 0.013, 2).volume, coarse, 1e-12);
}

TEST(OverlapVolume, ThreeLayersCountTwice) {
  const TriMesh one = shapes::box({0, 0, 0}, {1, 1, 1});
  const TriMesh three = shapes::together(shapes::together(one, one), one);
  // w = 3 inside: max(0, w - 1) = 2; the columns fill the box exactly when 1 / h is whole.
  EXPECT_NEAR(whole(three, 1.0 / 64, 1).volume, 2, 1e-12);
}

TEST(OverlapVolume, InsideOutLayersCountNothing) {
  const TriMesh inside_out = shapes::inverted(shapes::sphere(1, {0, 0, 0}, 3));
  EXPECT_EQ(whole(inside_out, 0.05, 0).volume, 0);
  EXPECT_EQ(whole(shapes::together(inside_out, inside_out), 0.05, 0).volume, 0);
  // w = 1 - 1 = 0 in a hollow shell.
  const TriMesh shell = shapes::together(shapes::sphere(2, {0, 0, 0}, 3),
                                         shapes::inverted(shapes::sphere(1, {0, 0, 0}, 3)));
  EXPECT_EQ(whole(shell, 0.05, 2).volume, 0);
}

TEST(OverlapVolume, SpindleTorusHasAHollowCore) {
  // A tube wider than its ring, r > R, covers its core once from either side of the axis with
  // opposite orientation: w = 1 - 1 = 0 there, so nothing overlaps although the surface crosses
  // itself, and Pappus' volume 2 pi^2 R r^2 counts the core as nothing too.
  const TriMesh torus = shapes::torus(0.6, 1, 256, 128);
  EXPECT_NEAR(signed_volume(torus.V, torus.F) / (2 * pi * pi * 0.6), 1, 2e-3);
  // Crossings that coincide at the rim may change places by round-off.
  EXPECT_LT(whole(torus, 0.01, 0).volume, 1e-15);
}

TEST(OverlapVolume, TubeThatCrossesItselfOverlapsByTheCrossedCylinders) {
  // A tube of radius a about the figure eight x = sin(2u), y = sin(u), z = 0 crosses itself once at
  // the origin, its two branches straight there to second order and meeting at the angle of the
  // tangents (2, 1) and (2, -1). Two straight cylinders share 16 a^3 / (3 sin angle).
  const double a = 0.03;
  const TriMesh tube = shapes::periodic_grid(1200, 48, [a](double u, double v) {
    const Eigen::Vector3d centre(std::sin(2 * u), std::sin(u), 0);
    const Eigen::Vector3d side = Eigen::Vector3d(2 * std::cos(2 * u), std::cos(u), 0)
                                     .normalized()
                                     .cross(Eigen::Vector3d::UnitZ());
    return Eigen::Vector3d(centre +
                           a * (std::cos(v) * side + std::sin(v) * Eigen::Vector3d::UnitZ()));
  });
  const TriMesh outward = signed_volume(tube.V, tube.F) > 0 ? tube : shapes::inverted(tube);
  const double sine = std::abs(Eigen::Vector3d(2, 1, 0).cross(Eigen::Vector3d(2, -1, 0)).z()) / 5;
  const double exact = 16 * a * a * a / (3 * sine);
  const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-0.3), Eigen::Vector3d::Constant(0.3));
  for (int axis = 0; axis < 3; ++axis) {
    const double o = overlap_volume(outward.V, outward.F, box, 0.0012, axis).volume;
    // The 48-gon's area is 0.3 % short, the cube of its width up to 0.9 %; curvature and columns
    // add less than 0.5 %.
    EXPECT_NEAR(o / exact, 1, 0.012) << "axis " << axis;
  }
}

TEST(OverlapVolume, CountsOnlyInsideTheBox) {
  const TriMesh m =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({0, 0, 0}, {1, 1, 1}));
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.25, -1, 0.5), Eigen::Vector3d(0.75, 0.125, 3));
  // 0.5 x 0.125 x 0.5 of the doubled cube; columns along y are clipped at exactly y = 0.125.
  EXPECT_NEAR(overlap_volume(m.V, m.F, box, 1.0 / 64, 1).volume, 0.5 * 0.125 * 0.5, 1e-12);
}

TEST(OverlapVolume, SaysWhereTheBoxCutsIt) {
  // Boxes that share [0.6, 1] x [0.3, 1] x [0.5, 1].
  const TriMesh m =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({0.6, 0.3, 0.5}, {2, 2, 2}));
  const double h = 0.01;
  const auto cut_area = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high, int axis) {
    return overlap_volume(m.V, m.F, {low, high}, h, axis).cut_area;
  };
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(cut_area({0.5, 0.2, 0.4}, {1.1, 1.1, 1.1}, axis), 0) << axis;
    // Ended at x = 0.8 the overlap goes on through a face of 0.7 x 0.5; at z = 0.6 of 0.4 x 0.7.
    EXPECT_NEAR(cut_area({0.5, 0.2, 0.4}, {0.8, 1.1, 1.1}, axis), 0.35, 0.02) << axis;
    EXPECT_NEAR(cut_area({0.5, 0.2, 0.6}, {1.1, 1.1, 1.1}, axis), 0.28, 0.02) << axis;
  }
}

TEST(OverlapVolume, TrianglesAboutItAreThoseThatBoundIt) {
  const TriMesh m =
      shapes::together(shapes::sphere(1, {0, 0, 0}, 4), shapes::sphere(1, {1.2, 0, 0}, 4));
  const double h = 0.02;
  const std::vector<int> found = triangles_about_overlap(m.V, m.F, h);
  std::vector<bool> is_found(m.F.rows(), false);
  for (const int t : found) is_found[t] = true;
  for (int t = 0; t < m.triangle_count(); ++t) {
    // Inside the other sphere, or outside of it, by more than an edge.
    const Eigen::RowVector3d other(t < m.triangle_count() / 2 ? 1.2 : 0, 0, 0);
    const Eigen::RowVector3d middle =
        (m.V.row(m.F(t, 0)) + m.V.row(m.F(t, 1)) + m.V.row(m.F(t, 2))) / 3;
    const double depth = 1 - (middle - other).norm();
    if (depth < -0.1) {
      EXPECT_FALSE(is_found[t]) << t;
    }
    // Nearly parallel to the columns a triangle may lie between them.
    const bool is_steep = std::abs(middle.x() - (t < m.triangle_count() / 2 ? 0 : 1.2)) < 0.3;
    if (depth > 0.1 && !is_steep) {
      EXPECT_TRUE(is_found[t]) << t;
    }
  }
  EXPECT_TRUE(triangles_about_overlap(m.V, m.F.topRows(m.F.rows() / 2), h).empty());
  EXPECT_THROW((void)triangles_about_overlap(m.V, m.F, 0), Error);
}

TEST(UnionVolume, CountsWhatIsInsideTwiceOnce) {
  const TriMesh a = shapes::sphere(1, {0, 0, 0}, 5);
  const TriMesh b = shapes::sphere(1, {1.1, 0.2, 0.1}, 5);
  const TriMesh m = shapes::together(a, b);
  const double sphere = signed_volume(a.V, a.F);
  const double d = Eigen::Vector3d(1.1, 0.2, 0.1).norm();
  EXPECT_NEAR(union_volume(m.V, m.F, 0.01), 2 * sphere - lens(1, d), 5e-3);
  EXPECT_NEAR(union_volume(a.V, a.F, 0.01), sphere, 1e-12);
  // An inside-out box beside the sphere holds nothing; its signed volume is -1.
  const TriMesh beside = shapes::together(a, shapes::inverted(shapes::box({2, 0, 0}, {3, 1, 1})));
  EXPECT_NEAR(signed_volume(beside.V, beside.F), sphere - 1, 1e-12);
  EXPECT_NEAR(union_volume(beside.V, beside.F, 0.01), sphere, 0.02);
}

TEST(OverlapVolume, ErrorFallsWithTheSpacing) {
  const TriMesh m =
      shapes::together(shapes::sphere(1, {0, 0, 0}, 4), shapes::sphere(1, {1.1, 0.3, 0.2}, 4));
  const double exact = whole(m, 0.002, 0).volume;
  double coarse = 0;
  double fine = 0;
  for (int axis = 0; axis < 3; ++axis) {
    coarse += std::abs(whole(m, 0.08, axis).volume - exact);
    fine += std::abs(whole(m, 0.01, axis).volume - exact);
  }
  // The depth of the lens falls to 0 at its rim, so the error is about h^2: 1/64; demand 1/16.
  EXPECT_LT(fine, coarse / 16);
}

TEST(OverlapVolume, ColumnsThroughVerticesAndEdgesStayBalanced) {
  // A box whose corners and diagonals lie on the grid of columns: moved by the irrational offsets
  // that the columns have, so that columns hit edges and vertices exactly.
  const double h = 0.125;
  const Eigen::Vector3d shift(0, (std::numbers::sqrt2 - 1) * h, (std::numbers::phi - 1) * h);
  TriMesh m =
      shapes::together(shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({0, 0, 0}, {1, 1, 1}));
  m.V.rowwise() += shift.transpose();
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(2, 2, 2));
  const OverlapVolume o = overlap_volume(m.V, m.F, box, h, 0);
  EXPECT_EQ(o.unbalanced_columns, 0);
  // Each column owns one cell and edges belong to one side: 8 or 9 columns across the unit side.
  EXPECT_GE(o.volume, 64 * h * h - 1e-12);
  EXPECT_LE(o.volume, 81 * h * h + 1e-12);
}

TEST(OverlapVolume, OpenMeshLosesOnlyTheColumnsThroughTheHole) {
  TriMesh m = shapes::box({0, 0, 0}, {1, 1, 1});
  m.F.conservativeResize(11, 3);
  EXPECT_GT(whole(m, 0.05, 0).unbalanced_columns, 0);
}

TEST(OverlapVolume, SameForAnyNumberOfThreads) {
  const TriMesh m =
      shapes::together(shapes::sphere(1, {0, 0, 0}, 4), shapes::sphere(1, {1.1, 0.3, 0.2}, 4));
  double one = 0;
  double two = 0;
  with_threads(1, [&] { one = whole(m, 0.013, 1).volume; });
  with_threads(2, [&] { two = whole(m, 0.013, 1).volume; });
  EXPECT_EQ(one, two);  // bitwise: strips are summed in order
}

TEST(OverlapVolume, RefusesSpacingsThatMakeNoSense) {
  const TriMesh m = shapes::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(whole(m, 0, 0), Error);
  EXPECT_THROW(whole(m, std::nan(""), 0), Error);
  EXPECT_THROW(whole(m, 1e-5, 0), Error);
}

TEST(OverlapStudy, NoiseFloorBoundsTheError) {
  for (const double gap : {0.7, 1.2, 1.6, 1.9}) {
    const TriMesh m =
        shapes::together(shapes::sphere(1, {0, 0, 0}, 5), shapes::sphere(1, {gap, 0.1, 0.05}, 5));
    const double exact = whole(m, 0.003, 2).volume;
    const OverlapStudy study = overlap_study(m.V, m.F, shapes::bounds(m.V), 1.0 / 24, 1);
    EXPECT_LE(std::abs(study.volume - exact), study.noise_floor) << "gap " << gap;
    EXPECT_LT(study.noise_floor, 2e-3);
  }
}

TEST(OverlapStudy, FloorOfAnEmbeddedSurfaceIsTheDetectionLimit) {
  const TriMesh m = shapes::sphere(1, {0, 0, 0}, 3);
  const OverlapStudy study = overlap_study(m.V, m.F, shapes::bounds(m.V), 0.1, 0.5);
  EXPECT_EQ(study.volume, 0);
  EXPECT_DOUBLE_EQ(study.noise_floor, 0.05 * 0.05 * 0.5);
}

TEST(JointBox, HoldsTheBallsAboutThePosedJoints) {
  JointRegion region;
  region.extent = 2;
  region.hinges.resize(1);
  region.hinges[0].joint = 1;
  region.hinges[0].head = {1, 0, 0};
  region.hinges[0].radius = 0.1;
  Pose pose = rest_pose(2);
  pose[1].translation() << 0, 5, 0;
  const Eigen::AlignedBox3d box = joint_box(region, pose);
  EXPECT_TRUE(box.min().isApprox(Eigen::Vector3d(0.7, 4.7, -0.3), 1e-12));
  EXPECT_TRUE(box.max().isApprox(Eigen::Vector3d(1.3, 5.3, 0.3), 1e-12));
}

TEST(OverlapStudy, AboveRestTakesDifferencesAndAddsFloors) {
  const OverlapStudy rest{2, 0.5, 0.25, 4, 0}, posed{5, 1, 1, 3, 0};
  const OverlapStudy above = overlap_above_rest(posed, rest);
  EXPECT_EQ(above.volume, 3);
  EXPECT_EQ(above.noise_floor, 1.5);
  EXPECT_EQ(above.inside_out, 0.75);
  EXPECT_EQ(above.cut_area, 0);
  EXPECT_EQ(above.above_floor(), 3);
  EXPECT_EQ((OverlapStudy{1, 1, 0, 0, 0}).above_floor(), 0);
}

TEST(OverlapStudy, RatioDividesByNoLessThanTheFloor) {
  const OverlapStudy much{6, 1, 0, 0, 0}, little{2, 0.5, 0, 0, 0}, none{0, 0.5, 0, 0, 0};
  EXPECT_EQ(much.ratio_to(little), 3);
  EXPECT_EQ(much.ratio_to(none), 6);  // over the floor of the larger of the two, 1
  EXPECT_EQ(none.ratio_to(much), 0);
}

TEST(UnionVolume, ChangesByWhatComesToOverlap) {
  // Two unit spheres move into each other until their centres are 1.2 apart: the signed volume
  // stays, the union loses the lens.
  const TriMesh sphere = shapes::sphere(1, {0, 0, 0}, 5);
  const TriMesh rest = shapes::together(sphere, shapes::sphere(1, {2.5, 0, 0}, 5)),
                posed = shapes::together(sphere, shapes::sphere(1, {1.2, 0, 0}, 5));
  const double spacing = body_column_spacing(rest.V);
  const OverlapStudy above = overlap_above_rest(body_overlap_study(posed.V, posed.F, spacing),
                                                body_overlap_study(rest.V, rest.F, spacing));
  const double whole = union_volume(rest.V, rest.F, spacing);
  EXPECT_NEAR(union_volume_change(rest.V, posed.V, rest.F, above, whole),
              -lens(1, 1.2) / (8 * pi / 3), 1e-3);
}

}  // namespace
}  // namespace geoprior
