#include "models/sketch/flatten/flatten.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "metrics/spacing/pattern_mesh.h"
#include "models/sketch/flatten/conformal_energy.h"
#include "models/sketch/flatten/convex_layout.h"
#include "models/sketch/flatten/flat_overlap.h"
#include "models/sketch/flatten/flat_triangles.h"
#include "models/sketch/flatten/rigid_layout.h"
#include "models/sketch/flatten/symmetric_dirichlet.h"
#include "models/sketch/pattern/make_pattern.h"
#include "models/sketch/pattern/piece_borders.h"
#include "tests/core/geometry/shapes.h"
#include "tests/sketch/pattern/flat_surfaces.h"

namespace geoprior::sketch {
namespace {

using ::geoprior::shapes::sphere;
using ::geoprior::shapes::square;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::SizeIs;

constexpr double kIsometric = 1e-6;

double distance(const Eigen::MatrixX2d& points, int a, int b) {
  return (points.row(a) - points.row(b)).norm();
}

/// A surface that is far from flat in both directions.
TriMesh spike(int n, double height) {
  return flats::grid(n, n, [&](int i, int j) {
    const double x = static_cast<double>(i) / n - 0.5, y = static_cast<double>(j) / n - 0.5;
    return Eigen::Vector3d(x, y, height * std::exp(-60 * (x * x + y * y)));
  });
}

Eigen::VectorXcd conformal_start(const TriMesh& mesh) {
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  Eigen::VectorXcd z =
      spectral_conformal_map(mesh, conformal_energy(mesh.F, triangles, mesh.vertex_count()));
  scale_to_area(triangles, mesh.F, z);
  return z;
}

// A frustum of slant s and radii r0 > r1 unrolls to the sector of radii r0 s / (r0 - r1) and
// r1 s / (r0 - r1). Over a regular polygon of n sides: s the length of a column's edge, and the
// angle n times the apex angle of a facet.
TEST(Flatten, ConeFrustumIsASectorOfAnAnnulus) {
  constexpr int kSegments = 48, kRows = 12;
  const double r0 = 1, r1 = 0.6, h = 1.5, s = std::hypot(h, r0 - r1);
  const TriMesh cone = flats::tube(r0, r1, h, kSegments, kRows);
  const CutPiece piece = cut_surface(cone, flats::tube_seam(kSegments, kRows)).at(0);
  const Flattening flat = flatten(piece.mesh);
  EXPECT_LT(flats::worst_edge(piece.mesh, flat.points), kIsometric);
  EXPECT_THAT(flat.report.flipped, IsEmpty());
  EXPECT_THAT(flat.report.overlaps, IsEmpty());
  const double large = r0 * s / (r0 - r1);
  const double chord = 2 * r0 * std::sin(std::numbers::pi / kSegments);
  const double sector = kSegments * 2 * std::asin(chord / (2 * large));
  // Ends of the outer arc: the two copies of vertex 0, a chord of the sector apart.
  std::vector<int> ends;
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
    if (piece.surface_vertex[v] == 0) ends.push_back(v);
  }
  ASSERT_THAT(ends, SizeIs(2));
  EXPECT_NEAR(distance(flat.points, ends[0], ends[1]), 2 * large * std::sin(sector / 2), 1e-6);
}

TEST(Flatten, CylinderIsARectangle) {
  constexpr int kSegments = 40, kRows = 10;
  const TriMesh tube = flats::tube(0.5, 0.5, 2, kSegments, kRows);
  const CutPiece piece = cut_surface(tube, flats::tube_seam(kSegments, kRows)).at(0);
  const Flattening flat = flatten(piece.mesh);
  EXPECT_LT(flats::worst_edge(piece.mesh, flat.points), kIsometric);
  const auto copies = [&](int vertex) {
    std::vector<int> found;
    for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
      if (piece.surface_vertex[v] == vertex) found.push_back(v);
    }
    return found;
  };
  const std::vector<int> low = copies(0), high = copies(kRows * kSegments);
  const double width = kSegments * 2 * 0.5 * std::sin(std::numbers::pi / kSegments);
  EXPECT_NEAR(distance(flat.points, low[0], low[1]), width, 1e-6);
  EXPECT_NEAR(distance(flat.points, high[0], high[1]), width, 1e-6);
  const double diagonal =
      std::max(distance(flat.points, low[0], high[0]), distance(flat.points, low[0], high[1]));
  EXPECT_NEAR(diagonal, std::hypot(width, 2), 1e-6);
}

// A sheet with one sharp fold between two rectangles of 1 x 1: flat it is 2 x 1.
TEST(Flatten, TentOpensAlongItsRidge) {
  const TriMesh tent = flats::grid(8, 4, [](int i, int j) {
    const double s = i / 4.0 - 1, angle = kDegree * 65;
    return Eigen::Vector3d(s * std::cos(angle), j / 4.0, -std::abs(s) * std::sin(angle));
  });
  const Flattening flat = flatten(tent);
  EXPECT_LT(flats::worst_edge(tent, flat.points), kIsometric);
  EXPECT_NEAR(distance(flat.points, 0, 8), 2, 1e-9);
  EXPECT_NEAR(distance(flat.points, 0, 44), std::sqrt(5), 1e-9);
}

// Needles and coplanar triangles of wide angles: the weights are clamped, the isometry is kept.
TEST(Flatten, BadTrianglesOfADevelopableSurfaceKeepTheirLengths) {
  RandomStream random(3, "needles");
  const TriMesh sheet = flats::grid(12, 12, [&](int i, int j) {
    const double x = std::pow(i / 12.0, 3) + 1e-4 * random.uniform() * (i % 12 != 0), y = j / 12.0;
    return Eigen::Vector3d(std::cos(2 * x), y, std::sin(2 * x));
  });
  // The facets of a curved cylinder whose columns are not straight are no isometry: only almost.
  EXPECT_LT(flatten(sheet).report.strain, 1e-3);
  TriMesh plane = sheet;
  for (Eigen::Index v = 0; v < plane.V.rows(); ++v)
    plane.V.row(v) << std::atan2(sheet.V(v, 2), sheet.V(v, 0)), sheet.V(v, 1), 0;
  EXPECT_LT(flats::worst_edge(plane, flatten(plane).points), kIsometric);
}

// Gauss: no map of a piece of the sphere keeps all lengths. By symmetry the octahedral mesh of the
// hemisphere has a fourfold layout; its border is too long for its radius.
TEST(Flatten, HemisphereIsSymmetricAndCannotBeIsometric) {
  const TriMesh half = flats::hemisphere(4);
  const Flattening flat = flatten(half);
  EXPECT_THAT(flat.report.flipped, IsEmpty());
  EXPECT_EQ(flat.report.unflip_iterations, 0);
  EXPECT_GT(flat.report.strain, 0.1);
  int pole = 0;
  half.V.col(2).maxCoeff(&pole);
  // A turn of the sphere by 90 degrees is one of the layout about the pole.
  double worst = 0;
  for (int v = 0; v < half.vertex_count(); ++v) {
    const Eigen::RowVector3d turned(-half.V(v, 1), half.V(v, 0), half.V(v, 2));
    int image = 0;
    const double off = (half.V.rowwise() - turned).rowwise().norm().minCoeff(&image);
    ASSERT_LT(off, 1e-12);
    const Eigen::RowVector2d p = flat.points.row(v) - flat.points.row(pole);
    const Eigen::RowVector2d q = flat.points.row(image) - flat.points.row(pole);
    worst = std::max(worst, (q - Eigen::RowVector2d(-p.y(), p.x())).norm());
  }
  EXPECT_LT(worst, 1e-4);
}

// A spike much higher than wide: neither the conformal nor the rigid layout keeps its triangles up.
TEST(Flatten, MendsTurnedTrianglesAndSaysSo) {
  const TriMesh mesh = spike(24, 2);
  FlattenOptions options;
  const Flattening mended = flatten(mesh, options);
  EXPECT_GT(mended.report.flipped_when_rigid, 0);
  EXPECT_GT(mended.report.unflip_iterations, 0);
  EXPECT_THAT(mended.report.flipped, IsEmpty());
  EXPECT_GT(pattern_mesh(mended.points, mesh.F).min_area, 0);
  options.unflip = false;
  const Flattening left = flatten(mesh, options);
  EXPECT_EQ(static_cast<int>(left.report.flipped.size()), left.report.flipped_when_rigid);
  EXPECT_EQ(pattern_mesh(left.points, mesh.F).inverted, left.report.flipped_when_rigid);
  EXPECT_THAT(left.report.overlaps, Not(IsEmpty())) << "what is turned over covers its neighbours";
}

// A flat strip that winds by one turn and a half: isometric, and its ends must cover each other.
TEST(Flatten, ReportsFarPartsThatComeToLieOverEachOther) {
  const TriMesh spiral = flats::grid(90, 3, [](int i, int j) {
    const double angle = kDegree * 6 * i, r = 1 - 0.1 * j;
    return Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), 0.01 * angle);
  });
  const Flattening flat = flatten(spiral);
  EXPECT_THAT(flat.report.flipped, IsEmpty());
  EXPECT_LT(flat.report.strain, 1e-3);
  ASSERT_THAT(flat.report.overlaps, Not(IsEmpty()));
  for (const auto& [a, b] : flat.report.overlaps) {
    const int columns_apart = std::abs(a % 180 / 2 - b % 180 / 2);
    EXPECT_THAT(columns_apart, AllOf(Ge(55), Le(65))) << "one turn is 60 columns";
  }
}

// Both sides of a slit in a plane sheet coincide: they touch and do not overlap.
TEST(Flatten, ClosedDartInAPlaneSheetIsNoOverlap) {
  const CutPiece piece = cut_surface(square(6), flats::seam_along({3, 10, 17, 24}, 0)).at(0);
  const Flattening flat = flatten(piece.mesh);
  EXPECT_LT(flats::worst_edge(piece.mesh, flat.points), kIsometric);
  EXPECT_THAT(flat.report.overlaps, IsEmpty());
}

// A hole in something flat stays open: a square frame is a square frame.
TEST(Flatten, FrameKeepsItsHole) {
  const std::vector<CutPiece> pieces =
      cut_surface(square(4), flats::seam_along({6, 7, 8, 13, 18, 17, 16, 11, 6}, 0));
  const Flattening flat = flatten(pieces[0].mesh);
  EXPECT_LT(flats::worst_edge(pieces[0].mesh, flat.points), kIsometric);
}

TEST(Flatten, RefusesWhatHasNoFlatLayout) {
  const auto refusal = [](const TriMesh& mesh) -> std::string {
    try {
      flatten(mesh);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_THAT(refusal(sphere(1)), HasSubstr("no border"));
  EXPECT_THAT(refusal(TriMesh{}), HasSubstr("no triangles"));
  TriMesh two = square(1);
  two.V.conservativeResize(8, 3);
  two.V.bottomRows(4) = two.V.topRows(4).array() + 5;
  two.F.conservativeResize(4, 3);
  two.F.bottomRows(2) = two.F.topRows(2).array() + 4;
  EXPECT_THAT(refusal(two), HasSubstr("2 parts"));
  TriMesh loose = square(1);
  loose.V.conservativeResize(5, 3);
  loose.V.row(4).setZero();
  EXPECT_THAT(refusal(loose), HasSubstr("in no triangle"));
  TriMesh point = square(1);
  point.V.row(3) = point.V.row(1) = point.V.row(0);
  EXPECT_THAT(refusal(point), HasSubstr("corners coincide"));
}

// Local and global steps never raise the energy, and the accelerated ones end where they do.
TEST(RigidLayout, AccelerationChangesTheWayNotTheEnd) {
  const TriMesh half = flats::hemisphere(3);
  const std::vector<FlatTriangle> triangles = flat_triangles(half);
  const RigidLayout rigid(triangles, half.F, half.vertex_count());
  const Eigen::VectorXcd start = conformal_start(half);
  double last = rigid.energy(start);
  for (int steps = 1; steps < 12; ++steps) {
    Eigen::VectorXcd z = start;
    const double energy = rigid.improve(z, {.iterations = steps, .mixing = 0}).energy;
    EXPECT_LE(energy, last);
    EXPECT_NEAR(energy, rigid.energy(z), 1e-12);
    last = energy;
  }
  Eigen::VectorXcd plain = start, mixed = start;
  const RigidLayoutReport slow =
      rigid.improve(plain, {.iterations = 1000, .tolerance = 1e-13, .mixing = 0});
  const RigidLayoutReport fast =
      rigid.improve(mixed, {.iterations = 1000, .tolerance = 1e-13, .mixing = 6});
  EXPECT_NEAR(slow.energy, fast.energy, 1e-10 * slow.energy);
  EXPECT_LT(fast.iterations, slow.iterations);
}

// A dome's border is longer when it is laid flat freely than on the dome. Held at a tenth less it
// costs energy and turns nothing over.
TEST(RigidLayout, HoldsTheLengthOfABorder) {
  const TriMesh half = flats::hemisphere(3);
  const std::vector<FlatTriangle> triangles = flat_triangles(half);
  const RigidLayout rigid(triangles, half.F, half.vertex_count());
  KeptLength border{piece_borders(half, "test").front(), 0};
  border.vertices.push_back(border.vertices.front());
  const auto length = [&](const auto& places) {
    double sum = 0;
    for (std::size_t i = 1; i < border.vertices.size(); ++i)
      sum += (places.row(border.vertices[i]) - places.row(border.vertices[i - 1])).norm();
    return sum;
  };
  Eigen::VectorXcd loose = conformal_start(half), held = loose;
  const double free_energy = rigid.improve(loose, {}).energy;
  border.length = 0.9 * length(to_points(loose));
  ASSERT_GT(border.length, length(half.V));
  rigid.improve(held, {});
  const RigidLayoutReport report = rigid.hold(held, std::span(&border, 1), {});
  EXPECT_LT(report.length_error, 1e-4);
  EXPECT_NEAR(length(to_points(held)), border.length, 1e-4 * border.length);
  EXPECT_GT(report.energy, free_energy);
  EXPECT_THAT(flipped_triangles(triangles, half.F, held), IsEmpty());
}

// A chain that is asked to be shorter must not crumple: its edges stay as even as they were.
TEST(RigidLayout, AShorterChainStaysEven) {
  const TriMesh mesh = square(20);
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  const RigidLayout rigid(triangles, mesh.F, mesh.vertex_count());
  KeptLength side;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.V(v, 1) == 0) side.vertices.push_back(v);
  }
  std::sort(side.vertices.begin(), side.vertices.end(),
            [&](int a, int b) { return mesh.V(a, 0) < mesh.V(b, 0); });
  side.length = 0.95;
  Eigen::VectorXcd z = to_complex(mesh.V.leftCols(2));
  EXPECT_LT(rigid.hold(z, std::span(&side, 1), {}).length_error, 1e-4);
  for (std::size_t i = 2; i < side.vertices.size(); ++i) {
    const Complex a = z(side.vertices[i - 1]) - z(side.vertices[i - 2]);
    const Complex b = z(side.vertices[i]) - z(side.vertices[i - 1]);
    EXPECT_LT(std::abs(std::arg(b / a)), 0.1);
    EXPECT_NEAR(std::abs(b), 0.95 / 20, 0.1 * 0.95 / 20);
  }
}

// Half of the squared Frobenius distance of diag(2, 1/2) from the nearest turn: (1 + 1/4) / 2.
TEST(RigidLayout, EnergyOfAStretchedSquare) {
  const TriMesh mesh = square(5);
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  const RigidLayout rigid(triangles, mesh.F, mesh.vertex_count());
  Eigen::MatrixX2d points = mesh.V.leftCols(2);
  points.col(0) *= 2;
  points.col(1) /= 2;
  const Complex turn = std::polar(1.0, 0.7);
  EXPECT_NEAR(rigid.energy(turn * to_complex(points)), 0.625, 1e-12);
}

// Of a unit square stretched by 2 and 1/2 the symmetric Dirichlet energy is 4 1/4 at first, twice
// (4 + 1/4) / 2, and the least, 2, is reached by an isometry.
TEST(SymmetricDirichlet, FindsTheIsometryOfAPlaneSheet) {
  const TriMesh mesh = square(6);
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  Eigen::MatrixX2d points = mesh.V.leftCols(2);
  points.col(0) *= 2;
  points.col(1) /= 2;
  Eigen::VectorXcd z = to_complex(points);
  EXPECT_NEAR(lower_symmetric_dirichlet(triangles, mesh.F, z, {.iterations = 0}).energy, 4.25,
              1e-12);
  const SymmetricDirichletReport report = lower_symmetric_dirichlet(triangles, mesh.F, z, {});
  EXPECT_NEAR(report.energy, 2, 1e-9);
  EXPECT_LT(report.iterations, 15);
  EXPECT_LT(flats::worst_edge(mesh, to_points(z)), 1e-4);
  std::swap(z(0), z(8));
  EXPECT_THROW(lower_symmetric_dirichlet(triangles, mesh.F, z, {}), Error);
}

TEST(ConvexLayout, TurnsNothingOverWhereTheConformalMapDoes) {
  const TriMesh mesh = spike(24, 2);
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  EXPECT_THAT(flipped_triangles(triangles, mesh.F, conformal_start(mesh)), Not(IsEmpty()));
  const CutPiece piece = cut_surface(mesh, {}).at(0);
  std::vector<int> border;
  for (const int v : piece.borders[0]) border.push_back(piece.surface_vertex[v]);
  const Eigen::VectorXcd z = convex_layout(mesh, triangles, border);
  EXPECT_THAT(flipped_triangles(triangles, mesh.F, z), IsEmpty());
  EXPECT_NEAR(std::abs(z(border[0])), std::abs(z(border[20])), 1e-12) << "on one circle";
}

// Holes too: a sphere without its six faces' middles.
TEST(ConvexLayout, TurnsNothingOverAroundHoles) {
  const TriMesh mesh = flats::part(
      sphere(3), [](const Eigen::Vector3d& c) { return c.cwiseAbs().maxCoeff() < 0.9; });
  const std::vector<FlatTriangle> triangles = flat_triangles(mesh);
  const CutPiece piece = cut_surface(mesh, {}).at(0);
  ASSERT_EQ(piece.border_count(), 6);
  std::vector<int> border;
  for (const int v : piece.borders[0]) border.push_back(piece.surface_vertex[v]);
  EXPECT_THAT(flipped_triangles(triangles, mesh.F, convex_layout(mesh, triangles, border)),
              IsEmpty());
}

// z' A z is |d z / d conj(z)|^2 summed over the area, times two: 0 for z, 2 for its mirror image.
TEST(ConformalEnergy, VanishesForSimilaritiesAndCountsMirrorImages) {
  const TriMesh mesh = square(4);
  const auto energy = conformal_energy(mesh.F, flat_triangles(mesh), mesh.vertex_count());
  const Eigen::VectorXcd z =
      std::polar(3.0, 0.4) * to_complex(mesh.V.leftCols(2)).array() + Complex(5, 1);
  const auto of = [&](const Eigen::VectorXcd& map) {
    return std::real(map.dot(energy.selfadjointView<Eigen::Lower>() * map));
  };
  EXPECT_NEAR(of(z), 0, 1e-11);
  EXPECT_NEAR(of(z.conjugate()), 2 * 9, 1e-11) << "scaled by 3";
}

TEST(FlatOverlap, CountsPairsWithACommonArea) {
  Eigen::MatrixX2d points(9, 2);
  points << 0, 0, 1, 0, 0, 1, 1, 1, 0.9, 0.2, 2, 0, 2, 1, 5, 5, 5, 6;
  Eigen::MatrixX3i triangles(4, 3);
  triangles << 0, 1, 2, 1, 3, 2, 4, 5, 6, 6, 7, 8;
  // Triangles 0 and 1 share an edge; 2 reaches into 1 alone; 3 touches 2 in a corner.
  EXPECT_THAT(overlapping_triangles(points, triangles, 1e-9), ElementsAre(std::array{1, 2}));
  EXPECT_THAT(overlapping_triangles(points, triangles, 0.2), IsEmpty());
}

TEST(MakePattern, LaysSphereOutAndReportsItsSeams) {
  const TriMesh ball = sphere(3);
  std::vector<SeamEdge> seams;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<SeamEdge> circle = flats::great_circle(ball, axis, axis);
    seams.insert(seams.end(), circle.begin(), circle.end());
  }
  const MadePattern made = make_pattern(ball, seams);
  ASSERT_THAT(made.pattern.pieces, SizeIs(8));
  EXPECT_THAT(made.added_seams, IsEmpty());
  const std::vector<SeamMismatch> mismatches = seam_mismatches(made.pattern);
  ASSERT_THAT(mismatches, SizeIs(12)) << "quarters of three circles";
  for (const SeamMismatch& m : mismatches)
    EXPECT_LT(m.relative, 1e-3) << "eight equal pieces, by symmetry";
  // Boxes keep their distance.
  for (std::size_t p = 0; p < 8; ++p) {
    EXPECT_GE(made.pattern.pieces[p].points.minCoeff(), 0);
    for (std::size_t q = p + 1; q < 8; ++q) {
      const auto& a = made.pattern.pieces[p].points;
      const auto& b = made.pattern.pieces[q].points;
      const Eigen::RowVector2d apart =
          (a.colwise().minCoeff() - b.colwise().maxCoeff())
              .cwiseMax(b.colwise().minCoeff() - a.colwise().maxCoeff());
      EXPECT_GE(apart.maxCoeff(), 0.02 - 1e-12);
    }
  }
}

// The two sides of a seam between a cap of a sphere and a belt have one length in space; laid flat
// freely, the cap's is shorter or longer by what the strain allows, and that is what is reported.
TEST(MakePattern, ReportsTheMismatchOfASeam) {
  const TriMesh half = flats::hemisphere(4);
  std::vector<SeamEdge> seams;
  const EdgeConnectivity edges(half.F);
  const auto band = [&](int t) {
    return half.V(half.F(t, 0), 2) + half.V(half.F(t, 1), 2) + half.V(half.F(t, 2), 2) > 1.5;
  };
  for (int e = 0; e < edges.edge_count(); ++e) {
    if (edges.left(e) >= 0 && edges.right(e) >= 0 && band(edges.left(e)) != band(edges.right(e)))
      seams.push_back({edges.edge(e), 0});
  }
  PatternOptions freely;
  freely.equal_seams = false;
  const MadePattern made = make_pattern(half, seams, freely);
  ASSERT_THAT(made.pattern.pieces, SizeIs(2));
  ASSERT_FALSE(made.added_seams.empty()) << "the belt is cut open";
  EXPECT_THAT(made.added_seams, Each(testing::Field(&SeamEdge::seam, 1)));
  double expected = 0;
  for (const SeamMismatch& m : seam_mismatches(made.pattern)) {
    const PatternPiece& piece = made.pattern.pieces[m.piece];
    const PieceEdge& edge = piece.edges[m.edge];
    const PatternPiece& other = made.pattern.pieces[edge.partner_piece];
    const PieceEdge& partner = other.edges[edge.partner_edge];
    double in_space = 0, in_space_other = 0, flat = 0, flat_other = 0;
    const auto add = [&](const PatternPiece& p, const PieceEdge& e, double& space, double& plane) {
      for (std::size_t i = 1; i < e.vertices.size(); ++i) {
        const int a = e.vertices[i - 1], b = e.vertices[i];
        space += (half.V.row(p.surface_vertex[a]) - half.V.row(p.surface_vertex[b])).norm();
        plane += (p.points.row(a) - p.points.row(b)).norm();
      }
    };
    add(piece, edge, in_space, flat);
    add(other, partner, in_space_other, flat_other);
    EXPECT_NEAR(in_space, in_space_other, 1e-12);
    EXPECT_NEAR(m.relative, std::abs(flat - flat_other) / ((flat + flat_other) / 2), 1e-12);
    expected = std::max(expected, m.relative);
  }
  EXPECT_GT(expected, 1e-3);
  const PatternOptions alike;
  ASSERT_GT(expected, alike.seam_mismatch);
  for (const SeamMismatch& m : seam_mismatches(make_pattern(half, seams, alike).pattern))
    EXPECT_LT(m.relative, alike.seam_mismatch + 2e-4) << "both sides are held";
}

// A tube is cut along a column; its surface's up is the pattern's.
TEST(MakePattern, TurnsPiecesUpAndCutsTubesOpen) {
  const TriMesh tube = flats::tube(0.5, 0.5, 0.4, 24, 6);
  const MadePattern made = make_pattern(tube, {});
  ASSERT_THAT(made.pattern.pieces, SizeIs(1));
  EXPECT_THAT(made.added_seams, SizeIs(6));
  const PatternPiece& piece = made.pattern.pieces[0];
  for (Eigen::Index v = 0; v < piece.points.rows(); ++v)
    EXPECT_NEAR(piece.points(v, 1), tube.V(piece.surface_vertex[v], 1), 1e-6);
  PatternOptions options;
  options.grain = GrainRule::longest;
  const PatternPiece upright = make_pattern(tube, {}, options).pattern.pieces[0];
  EXPECT_NEAR(upright.points.col(1).maxCoeff(), 24 * std::sin(std::numbers::pi / 24), 1e-6);
}

// A frame keeps its hole: no further cut, and the outer border comes first.
TEST(MakePattern, LeavesHolesInFlatPieces) {
  const MadePattern made =
      make_pattern(square(4), flats::seam_along({6, 7, 8, 13, 18, 17, 16, 11, 6}, 0));
  EXPECT_THAT(made.added_seams, IsEmpty());
  ASSERT_THAT(made.pattern.pieces, SizeIs(2));
  EXPECT_THAT(made.pattern.pieces[0].borders, SizeIs(2));
  EXPECT_THAT(made.pattern.pieces[0].borders[0], SizeIs(16));
}

TEST(MakePattern, IsTheSameAtAnyNumberOfThreads) {
  const TriMesh ball = sphere(4);
  const std::vector<SeamEdge> seams = flats::great_circle(ball, 1, 0);
  std::vector<Eigen::MatrixX2d> one, many;
  for (const auto& [threads, result] : {std::pair(1, &one), std::pair(4, &many)}) {
    with_threads(threads, [&, into = result] {
      for (const PatternPiece& piece : make_pattern(ball, seams).pattern.pieces)
        into->push_back(piece.points);
    });
  }
  EXPECT_EQ(one, many);
}

}  // namespace
}  // namespace geoprior::sketch
