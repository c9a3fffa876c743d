#include "solvers/sketch/layers/articulated_layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/angles.h"
#include "core/geometry/topology.h"
#include "core/mesh.h"
#include "core/parallel.h"
#include "core/random.h"
#include "experiments/sketch/truth/synthetic_layers.h"
#include "metrics/contact/self_contact.h"
#include "metrics/isometry/circular_arc.h"
#include "models/sketch/drawing/ellipse_fit.h"
#include "solvers/sketch/layers/arc_circle.h"
#include "solvers/sketch/layers/frustum_band.h"
#include "solvers/sketch/layers/joint_range.h"
#include "solvers/sketch/layers/pattern.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::sketch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::vector<Eigen::Vector2d> on_ellipse(const Ellipse& ellipse, double from_deg, double to_deg,
                                        int count) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i)
    points.push_back(ellipse.point(kDegree * (from_deg + (to_deg - from_deg) * i / (count - 1))));
  return points;
}

Ellipse tilted_ellipse() { return {{0.3, -0.2}, 0.05, 0.02, {std::cos(0.4), std::sin(0.4)}}; }

// Points of an ellipse lie on it: both fits give the ellipse they were taken from.
TEST(EllipseFit, RecoversAnEllipseFromAThirdOfIt) {
  const Ellipse truth = tilted_ellipse();
  const auto points = on_ellipse(truth, 20, 140, 25);
  for (const Ellipse& e : {direct_ellipse(points, "arc"), fit_ellipse(points, "arc").ellipse}) {
    EXPECT_NEAR((e.centre - truth.centre).norm(), 0, 1e-9);
    EXPECT_NEAR(e.major, truth.major, 1e-9);
    EXPECT_NEAR(e.minor, truth.minor, 1e-9);
    EXPECT_NEAR(std::abs(e.direction.dot(truth.direction)), 1, 1e-9);
  }
}

// The sum of squared distances has its minimum at the geometric fit: the direct one, which measures
// something else, is no better.
TEST(EllipseFit, GeometricFitIsNoFartherFromNoisyPointsThanTheDirectOne) {
  RandomStream random(5, "noisy ellipse");
  auto points = on_ellipse(tilted_ellipse(), 0, 150, 40);
  for (Eigen::Vector2d& p : points) p += 4e-4 * Eigen::Vector2d(random.normal(), random.normal());
  const EllipseFit fit = fit_ellipse(points, "arc");
  const Ellipse direct = direct_ellipse(points, "arc");
  double sum = 0;
  for (const Eigen::Vector2d& p : points) {
    double nearest = 1;
    for (int i = 0; i < 20000; ++i)
      nearest = std::min(nearest, (p - direct.point(kFullTurn * i / 20000)).squaredNorm());
    sum += nearest;
  }
  EXPECT_LT(fit.rms, std::sqrt(sum / 40));
  EXPECT_LT(fit.rms, 5e-4);
}

TEST(EllipseFit, RefusesWhatIsNoPieceOfAnEllipse) {
  const Ellipse e = tilted_ellipse();
  std::vector<Eigen::Vector2d> hyperbola, line;
  for (int i = 0; i < 20; ++i) {
    const double x = -1 + 0.1 * i;
    hyperbola.emplace_back(0.01 * x, 0.01 * std::sqrt(0.05 + x * x));
    line.emplace_back(0.01 * x, 0.02 * x);
  }
  const auto refusal = [](const std::vector<Eigen::Vector2d>& points) {
    return test::error_of([&] { fit_ellipse(points, "stroke 'edge-2'"); });
  };
  EXPECT_THAT(refusal(on_ellipse(e, 0, 90, 4)),
              AllOf(HasSubstr("edge-2"), HasSubstr("4 distinct points")));
  EXPECT_THAT(refusal(on_ellipse(e, 80, 100, 30)),
              AllOf(HasSubstr("edge-2"), HasSubstr("not determined"), HasSubstr("condition")));
  EXPECT_THAT(refusal(hyperbola), AllOf(HasSubstr("edge-2"), HasSubstr("hyperbola")));
  EXPECT_THAT(refusal(line), AllOf(HasSubstr("edge-2"), HasSubstr("straight")));
}

// A circle of radius r that is tilted by phi is seen as an ellipse with half axes r and r cos phi.
TEST(ArcCircle, AxesOfAnEllipseAreThoseOfTheTwoCirclesItShows) {
  const double phi = 0.7;
  const Ellipse e{{0, 0}, 2, 2 * std::cos(phi), {1, 0}};
  const auto axes = axes_of_ellipse(e);
  EXPECT_NEAR((axes[0] - Eigen::Vector3d(0, std::sin(phi), std::cos(phi))).norm(), 0, 1e-12);
  EXPECT_NEAR((axes[1] - Eigen::Vector3d(0, -std::sin(phi), std::cos(phi))).norm(), 0, 1e-12);
}

// The body is known: its circles come back, and the reading that was not kept is the wrong one.
TEST(ArcCircle, RecoversTheCirclesOfAKnownBody) {
  const SyntheticView body = synthetic_layers({});
  const MirrorPlanes planes = drawn_mirror_planes(body.view);
  EXPECT_NEAR(std::abs(planes.chosen.normal.dot(body.mirror_normal)), 1, 1e-12);
  const auto circles = fit_arc_circles(body.view, planes.chosen);
  ASSERT_EQ(circles.size(), 8U);
  for (std::size_t k = 0; k < circles.size(); ++k) {
    Eigen::MatrixX3d real(body.truth[k].size(), 3);
    for (std::size_t i = 0; i < body.truth[k].size(); ++i)
      real.row(i) = body.truth[k][i].transpose();
    const CircularArc truth = circular_arc(real);
    EXPECT_NEAR(circles[k].radius, truth.radius, 1e-9);
    EXPECT_NEAR((circles[k].centre - truth.centre).norm(), 0, 1e-9);
    EXPECT_NEAR(std::abs(circles[k].axis.dot(truth.axis)), 1, 1e-12);
    EXPECT_NEAR(circles[k].half_angle, 105 * kDegree, 1e-9);
    EXPECT_LT(circles[k].kept_sine, 1e-9);
    EXPECT_GT(circles[k].other_sine, 0.3);
  }
}

// The other reading of the plane is the body mirrored in depth: same radii, depths of other sign.
TEST(ArcCircle, NeckersOtherReadingHasTheMirroredCircles) {
  const SyntheticView body = synthetic_layers({});
  const MirrorPlanes planes = drawn_mirror_planes(body.view);
  const auto chosen = fit_arc_circles(body.view, planes.chosen);
  const auto other = fit_arc_circles(body.view, planes.other);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    EXPECT_NEAR(chosen[k].radius, other[k].radius, 1e-9);
    EXPECT_NEAR(chosen[k].centre.z(), -other[k].centre.z(), 1e-9);
  }
}

TEST(ArcCircle, RefusesTooFewArcsAndLayersOutOfOrder) {
  SyntheticView body = synthetic_layers({});
  const MirrorPlane plane = drawn_mirror_planes(body.view).chosen;
  View one = body.view;
  one.strokes.erase(one.strokes.begin() + 1, one.strokes.begin() + 8);
  EXPECT_THAT(test::error_of([&] { fit_arc_circles(one, plane); }), HasSubstr("has 1 arcs"));
  std::swap(body.view.strokes[3], body.view.strokes[5]);
  EXPECT_THAT(test::error_of([&] { fit_arc_circles(body.view, plane); }),
              AllOf(HasSubstr("out of order"), HasSubstr("arc-")));
}

// A first edge that is tilted by 12 degrees keeps its radius and its tilt; forced onto the axis of
// the second, as one may still ask for, it is another circle.
TEST(ArcCircle, FirstEdgeIsMetWhereItIsDrawn) {
  SyntheticLayerOptions tilted;
  tilted.first_tilt_deg = 12;
  const SyntheticView body = synthetic_layers(tilted);
  const MirrorPlane plane = drawn_mirror_planes(body.view).chosen;
  const auto met = fit_arc_circles(body.view, plane);
  EXPECT_NEAR(met[0].radius, 0.6, 1e-9);
  EXPECT_NEAR(std::acos(met[0].axis.dot(met[1].axis)), 12 * kDegree, 1e-9);
  const auto forced = fit_arc_circles(body.view, plane, true, false);
  EXPECT_EQ(forced[0].axis, forced[1].axis);
  EXPECT_GT(forced[0].rms, 0.02 * 0.6);
}

FrustumBand cone_band(double front, double rear) {
  FrustumBand band;
  band.length = 0.3;
  band.front_radius = front;
  band.rear_radius = rear;
  band.half_angle = 1.8;
  return band;
}

// s = sqrt(h^2 + (r1 - r2)^2), rho = r s / |r1 - r2|, sector angle = 2 half_angle |r1 - r2| / s.
TEST(FrustumBand, UnrollsToTheSectorOfTheClosedForm) {
  for (const auto& [front, rear] : {std::pair{1.0, 0.7}, {0.7, 1.0}}) {
    const FrustumBand band = cone_band(front, rear);
    const double slant = std::sqrt(0.3 * 0.3 + 0.3 * 0.3);
    Eigen::MatrixX3d rim(41, 3);
    for (int i = 0; i <= 40; ++i)
      rim.row(i) << band.unrolled(0, 1.8 * (i - 20) / 20).transpose(), 0;
    const CircularArc arc = circular_arc(rim);
    EXPECT_NEAR(arc.radius, rear * slant / 0.3, 1e-12);
    EXPECT_NEAR(arc.angle, 3.6 * 0.3 / slant, 1e-12);
    EXPECT_NEAR(arc.length, 3.6 * rear, 1e-12);
    EXPECT_NEAR(arc.off, 0, 1e-13);
    EXPECT_NEAR((band.unrolled(0, 1.8) - band.unrolled(-0.3, 1.8)).norm(), slant, 1e-13);
  }
}

TEST(FrustumBand, CylinderUnrollsToARectangleAndNearlyCylindersTowardsIt) {
  for (const double taper : {0.0, 1e-15, 1e-12, 1e-9}) {
    const FrustumBand band = cone_band(1 + taper, 1);
    EXPECT_NEAR((band.unrolled(0, 1.8) - Eigen::Vector2d(-1.8, 0)).norm(), 0, 20 * taper + 1e-14);
    EXPECT_NEAR((band.unrolled(-0.3, -1.8) - Eigen::Vector2d(1.8, 0.3)).norm(), 0,
                20 * taper + 1e-14);
  }
}

// The limit of a tilt that vanishes is the frustum, whose pieces have a closed form.
TEST(FrustumBand, ObliqueBandTendsToTheFrustum) {
  const FrustumBand cone = cone_band(0.7, 1.0);
  FrustumBand oblique = cone;
  oblique.front_rise = 1e-9;
  for (const double s : {-1.8, -0.6, 0.0, 0.9, 1.8}) {
    for (const double x : {-0.3, -0.1, 0.0}) {
      EXPECT_NEAR((oblique.point(x, s) - cone.point(x, s)).norm(), 0, 1e-8);
      EXPECT_NEAR((oblique.unrolled(x, s) - cone.unrolled(x, s)).norm(), 0, 1e-7);
    }
    EXPECT_NEAR((oblique.normal(s) - cone.normal(s)).norm(), 0, 1e-7);
  }
}

FrustumBand oblique_band() {
  FrustumBand band = cone_band(0.8, 1.0);
  band.length = 0.6;
  band.front_tilt = 0.2;
  band.front_rise = 0.05;
  band.half_angle = 1.5;
  return band;
}

// Both rims are circles as given; along a generator the tangent plane touches both of them.
TEST(FrustumBand, ObliqueBandHasBothCirclesAndOneTangentPlaneAlongAGenerator) {
  const FrustumBand band = oblique_band();
  ASSERT_TRUE(band.rims_are_apart());
  const Eigen::Vector3d front_axis = std::cos(0.2) * band.axis - std::sin(0.2) * band.up;
  const Eigen::Vector3d centre = band.rear - 0.6 * band.axis + 0.05 * band.up;
  for (const double s : {-1.5, -0.7, 0.0, 0.4, 1.1, 1.5}) {
    const Eigen::Vector3d front = band.point(-0.6, s) - centre, rear = band.point(0, s) - band.rear;
    EXPECT_NEAR(front.norm(), 0.8, 1e-12);
    EXPECT_NEAR(front.dot(front_axis), 0, 1e-12);
    EXPECT_NEAR(rear.norm(), 1, 1e-12);
    const Eigen::Vector3d n = band.normal(s);
    EXPECT_NEAR(n.dot(front_axis.cross(front)), 0, 1e-12) << "tangent of the front circle";
    EXPECT_NEAR(n.dot(band.axis.cross(rear)), 0, 1e-12) << "tangent of the rear circle";
    EXPECT_NEAR(n.dot(band.point(0, s) - band.point(-0.6, s)), 0, 1e-12);
    EXPECT_GT(n.dot(rear), 0);
  }
}

// An isometry keeps the lengths of curves: of generators, of rims by fine chords, and of the
// curve half way along all generators.
TEST(FrustumBand, ObliqueBandIsUnrolledWithoutStretch) {
  const FrustumBand band = oblique_band();
  constexpr int kSteps = 400;
  for (const double x : {-0.6, -0.3, 0.0}) {
    double flat = 0, space = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double a = -1.5 + 3.0 * i / kSteps, b = a + 3.0 / kSteps;
      flat += (band.unrolled(x, b) - band.unrolled(x, a)).norm();
      space += (band.point(x, b) - band.point(x, a)).norm();
    }
    // Chords of 1/400 of the rim are shorter in space, where it is bent more, by 3^2 / (24 *
    // 400^2).
    EXPECT_NEAR(flat / space, 1, 3e-6) << x;
  }
  for (const double s : {-1.5, 0.0, 0.8}) {
    const double length = (band.point(-0.6, s) - band.point(0, s)).norm();
    EXPECT_NEAR((band.unrolled(-0.6, s) - band.unrolled(0, s)).norm(), length, 1e-12);
  }
  EXPECT_NEAR((band.unrolled(-0.2, 1.3) + band.unrolled(-0.2, -1.3)).x(), 0, 1e-9) << "symmetric";
}

// A point moved inwards along the normal lies below the band by as much.
TEST(FrustumBand, KnowsWhatLiesBelowIt) {
  for (const FrustumBand& band : {cone_band(0.8, 1.0), oblique_band()}) {
    for (const double s : {0.0, 0.5, -1.2}) {
      const Eigen::Vector3d p = band.point(-0.4 * band.length, s) - 0.05 * band.normal(s);
      EXPECT_TRUE(band.has_below(p, 0.0499));
      EXPECT_FALSE(band.has_below(p, 0.0501));
    }
  }
}

// Outward orientation: a closed mesh has the volume between the two cones, thickness times area to
// first order, and not its negative.
TEST(FrustumBand, SolidIsClosedManifoldAndOriented) {
  const FrustumBand band = cone_band(1, 0.7);
  const TriMesh solid = band_solid(band, 0.001, {48, 2});
  EXPECT_TRUE(boundary_edges(solid.F).empty());
  EXPECT_TRUE(non_manifold_edges(solid.F).empty());
  const double area = 1.8 * (1 + 0.7) * band.slant();
  EXPECT_NEAR(signed_volume(solid.V, solid.F) / (0.001 * area), 1, 2e-3);
}

ArticulatedLayers known_layers(const LayerOptions& options, SyntheticLayerOptions body = {}) {
  ArticulatedLayers layers = build_layers(synthetic_layers(body).view, options);
  set_joint_limits(layers, options);
  return layers;
}

/// Pairs of triangles of different layers that intersect when every joint is at a share of its
/// limit.
int contacts(const ArticulatedLayers& layers, const LayerOptions& options, double share) {
  std::vector<double> angles;
  for (const LayerHinge& hinge : layers.hinges)
    angles.push_back(share * (share > 0 ? hinge.curl : hinge.stretch));
  const auto poses = layer_poses(layers, angles);
  TriMesh all;
  std::vector<int> layer;
  for (int j = 0; j < std::ssize(layers.bands); ++j) {
    const TriMesh solid =
        band_solid(layers.bands[j], options.thickness * layers.unit, options.grid);
    const Eigen::Index n = all.V.rows(), m = all.F.rows();
    all.V.conservativeResize(n + solid.V.rows(), 3);
    all.F.conservativeResize(m + solid.F.rows(), 3);
    for (Eigen::Index v = 0; v < solid.V.rows(); ++v)
      all.V.row(n + v) = (poses[j] * Eigen::Vector3d(solid.V.row(v).transpose())).transpose();
    all.F.bottomRows(solid.F.rows()) = solid.F.array() + static_cast<int>(n);
    layer.insert(layer.end(), solid.F.rows(), j);
  }
  int count = 0;
  for (const auto& pair : intersecting_triangles(all.V, all.F)) {
    count += layer[pair[0]] != layer[pair[1]];
  }
  return count;
}

// Exact predicates on the solids find what the rounded ones of the joints' search kept apart; a
// degree farther, a joint that collision stopped does touch.
TEST(JointRange, LayersDoNotTouchUpToTheirLimits) {
  LayerOptions options;
  options.keep_covered = false;
  const ArticulatedLayers layers = known_layers(options);
  for (const double share : {-1.0, -0.5, 0.0, 0.5, 1.0})
    EXPECT_EQ(contacts(layers, options, share), 0) << share;
  int stopped = 0;
  for (std::size_t j = 0; j < layers.hinges.size(); ++j) {
    if (layers.hinges[j].stretch >= options.max_angle_deg * kDegree) continue;
    ArticulatedLayers two = layers;
    two.bands = {layers.bands[j], layers.bands[j + 1]};
    two.hinges = {layers.hinges[j]};
    two.hinges[0].stretch += kDegree;
    EXPECT_GT(contacts(two, options, -1), 0) << j;
    ++stopped;
  }
  EXPECT_GT(stopped, 0);
}

// A joint that a gap stops: the crown moves by (r - y) sin angle along the overlap, of which nine
// tenths may be used up. Of a cylinder with parallel circles both are known.
TEST(JointRange, GapStopsAJointOfACylinderWhereTheOverlapIsUsedUp) {
  SyntheticLayerOptions body;
  body.arcs = 3;
  body.radius = body.end_radius = 1;
  body.length = 1;
  body.bend_deg = 0;
  LayerOptions options;
  options.overlap = 0.3;
  options.clearance = 0.05;
  const ArticulatedLayers layers = known_layers(options, body);
  ASSERT_EQ(layers.hinges.size(), 1U);
  const LayerHinge& hinge = layers.hinges[0];
  const FrustumBand& front = layers.bands[0];
  const Eigen::Vector3d h = front.own(hinge.point);
  // Crown of the rear rim, from the hinge: turned back, its x is that of the band behind.
  const double x = -h.x(), y = 1 - h.y(), overlap = 0.15;
  const double a = hinge.curl + 0.01 * kDegree;
  const double moved = x * std::cos(a) - y * std::sin(a) + h.x();
  EXPECT_NEAR(moved, -0.9 * overlap, 2e-3);
}

TEST(ArticulatedLayers, HolesLieOnBothLayersOnOneLine) {
  const ArticulatedLayers layers = known_layers({});
  for (std::size_t j = 0; j < layers.hinges.size(); ++j) {
    const LayerHinge& hinge = layers.hinges[j];
    const Eigen::Vector3d a = layers.bands[j].point(hinge.front_hole_at, hinge.front_hole);
    const Eigen::Vector3d b = layers.bands[j + 1].point(hinge.rear_hole_at, hinge.rear_hole);
    for (const Eigen::Vector3d& p : {a, b})
      EXPECT_NEAR((p - hinge.point).cross(hinge.axis).norm(), 0, 1e-9);
    EXPECT_LT(hinge.front_hole, layers.bands[j].half_angle);
    EXPECT_LT(hinge.rear_hole, layers.bands[j + 1].half_angle);
  }
}

/// A shell that grows towards the tail by three times its radius within little more than that.
SyntheticLayerOptions widening_shell() {
  SyntheticLayerOptions body;
  body.arcs = 5;
  body.end_radius = 0.3;
  body.radius = 0.6;
  body.rear_radius = 0.9;
  body.length = 0.5;
  body.bend_deg = 0;
  return body;
}

// A given overlap is refused with what to do about it, where a chosen one fits; what is chosen
// turns by the angle that is recorded, without contact.
TEST(ArticulatedLayers, ChooseAnOverlapWhereAGivenOneDoesNotFit) {
  const SyntheticLayerOptions body = widening_shell();
  LayerOptions given;
  given.overlap = 0.95;
  given.free_deg = 20;
  EXPECT_THAT(test::error_of([&] { known_layers(given, body); }),
              AllOf(HasSubstr("arc-3"), HasSubstr("less overlap, or none")));
  const LayerOptions chosen;
  const ArticulatedLayers layers = known_layers(chosen, body);
  ASSERT_EQ(layers.choices.size(), layers.hinges.size());
  for (std::size_t j = 0; j < layers.hinges.size(); ++j) {
    EXPECT_TRUE(layers.choices[j].chosen);
    EXPECT_GT(layers.choices[j].share, 0);
    EXPECT_GE(layers.hinges[j].curl, layers.choices[j].free - 0.05 * kDegree) << j;
    EXPECT_GE(layers.hinges[j].stretch, layers.choices[j].free - 0.05 * kDegree) << j;
  }
  for (const double share : {-1.0, 0.0, 1.0}) EXPECT_EQ(contacts(layers, chosen, share), 0);
}

// Both drawn edges of a first layer whose edges are not parallel, and every rear edge, lie on the
// layers; its joint does not touch either.
TEST(ArticulatedLayers, MeetATiltedFirstEdge) {
  SyntheticLayerOptions body;
  body.first_tilt_deg = -12;
  const LayerOptions options;
  const ArticulatedLayers layers = known_layers(options, body);
  const FrustumBand& first = layers.bands.front();
  ASSERT_TRUE(first.oblique());
  for (const double s : {0.0, 0.6, -1.4}) {
    const Eigen::Vector3d d = first.point(-first.length, s) - layers.circles[0].centre;
    EXPECT_NEAR(d.norm(), 0.6, 1e-9);
    EXPECT_NEAR(d.dot(layers.circles[0].axis), 0, 1e-9);
  }
  EXPECT_GE(first.front_angle(first.half_angle), layers.circles[0].half_angle - 1e-9);
  EXPECT_GE(first.half_angle, layers.circles[1].half_angle - 1e-9);
  for (const double share : {-1.0, 0.0, 1.0}) EXPECT_EQ(contacts(layers, options, share), 0);
}

// A strongly bent body of narrow layers, whose lower corners reach forward of the first layer.
TEST(ArticulatedLayers, ChooseAnOverlapWhereCornersLookOut) {
  SyntheticLayerOptions body;
  body.arcs = 11;
  body.radius = 0.676;
  body.end_radius = 0.381;
  body.rear_radius = 0.48;
  body.length = 1.34;
  body.bend_deg = 88;
  body.first_tilt_deg = -8.7;
  body.half_angle_deg = 111;
  const LayerOptions options;
  const ArticulatedLayers layers = known_layers(options, body);
  EXPECT_EQ(layers.hinges.size(), 9U);
  for (const double share : {-1.0, 0.0, 1.0}) EXPECT_EQ(contacts(layers, options, share), 0);
}

TEST(ArticulatedLayers, RefuseEdgesOfTheFirstLayerThatCross) {
  SyntheticLayerOptions body;
  body.first_tilt_deg = 45;
  EXPECT_THAT(test::error_of([&] { known_layers({}, body); }),
              AllOf(HasSubstr("arc-1"), HasSubstr("arc-2"), HasSubstr("cross")));
}

// Scale is free: lengths are shares of the mean radius.
TEST(ArticulatedLayers, ASmallBodyIsTheSameBody) {
  SyntheticLayerOptions small;
  small.radius *= 0.01;
  small.end_radius *= 0.01;
  small.length *= 0.01;
  const ArticulatedLayers a = known_layers({}), b = known_layers({}, small);
  for (std::size_t j = 0; j < a.hinges.size(); ++j) {
    EXPECT_NEAR(a.hinges[j].curl, b.hinges[j].curl, 1e-4);
    EXPECT_NEAR(a.bands[j].front_radius, 100 * b.bands[j].front_radius, 1e-6);
  }
}

TEST(ArticulatedLayers, GiveTheSameBytesAtAnyThreadCount) {
  std::vector<double> limits[2];
  for (const int threads : {1, 3}) {
    with_threads(threads, [&] {
      for (const LayerHinge& hinge : known_layers({}).hinges) {
        limits[threads > 1].push_back(hinge.curl);
        limits[threads > 1].push_back(hinge.stretch);
      }
    });
  }
  EXPECT_EQ(limits[0], limits[1]);
}

// Arcs of rims and straight sides keep their lengths, and rivet holes lie where they are on the
// cone.
TEST(LayerPattern, EdgesHaveTheLengthsOfTheBandsAndHolesTheirPlaces) {
  const LayerOptions options;
  const ArticulatedLayers layers = known_layers(options);
  const Pattern pattern = layer_pattern(layers, options, 0.02);
  ASSERT_EQ(pattern.pieces.size(), layers.bands.size());
  for (std::size_t j = 0; j < pattern.pieces.size(); ++j) {
    const PatternPiece& piece = pattern.pieces[j];
    const FrustumBand& band = layers.bands[j];
    const double lengths[4] = {2 * band.half_angle * band.rear_radius, band.slant(),
                               2 * band.half_angle * band.front_radius, band.slant()};
    for (std::size_t e = 0; e < 4; ++e) {
      const std::vector<int>& chain = piece.edges[e].vertices;
      Eigen::MatrixX3d points = Eigen::MatrixX3d::Zero(chain.size(), 3);
      for (std::size_t i = 0; i < chain.size(); ++i)
        points.row(i).head<2>() = piece.points.row(chain[i]);
      EXPECT_NEAR(circular_arc(points).length, lengths[e], 1e-9);
    }
    const bool end = j == 0 || j + 1 == pattern.pieces.size();
    ASSERT_EQ(piece.holes.size(), end ? 2U : 4U);
    EXPECT_EQ(piece.placements.size(), j == 0 ? 0U : 1U);
    // Holes of a joint are symmetric about the piece's middle line.
    const double middle = (piece.points.col(0).minCoeff() + piece.points.col(0).maxCoeff()) / 2;
    EXPECT_NEAR(piece.holes[0].centre.x() + piece.holes[1].centre.x(), 2 * middle, 1e-9);
    EXPECT_NEAR(piece.holes[0].centre.y(), piece.holes[1].centre.y(), 1e-9);
  }
}

}  // namespace
}  // namespace geoprior::sketch
